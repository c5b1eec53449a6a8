#include "core/read/decimal.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace driftlab {
namespace {

/// The bits std::from_chars gives, which the standard library rounds correctly.
std::uint64_t reference_bits(const std::string& text) {
  double value = 0.0;
  const char* const first = text.data() + (text.front() == '+' ? 1 : 0);
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  EXPECT_EQ(error, std::errc{}) << text;
  EXPECT_EQ(end, text.data() + text.size()) << text;
  return std::bit_cast<std::uint64_t>(value);
}

void expect_same(const std::string& text) {
  double value = 0.0;
  const char* const end = decimal::parse(text.c_str(), value);
  ASSERT_EQ(end, text.c_str() + text.size()) << text;
  ASSERT_EQ(std::bit_cast<std::uint64_t>(value), reference_bits(text)) << text;
}

std::string random_digits(std::mt19937_64& random, std::size_t count) {
  std::string digits;
  for (std::size_t i = 0; i < count; ++i) {
    digits += static_cast<char>('0' + random() % 10);
  }
  return digits;
}

/// A decimal of any length, with point and exponent anywhere, whose value a double can hold.
std::string random_decimal(std::mt19937_64& random) {
  constexpr std::array<const char*, 4> kSigns{"", "", "-", "+"};
  std::string text = kSigns[random() % kSigns.size()];
  const std::size_t before = random() % 12;
  text += random_digits(random, before);
  if (random() % 4 != 0 || before == 0) {
    text += '.';
    text += random_digits(random, random() % 14 + (before == 0 ? 1 : 0));
  }
  if (random() % 3 == 0) {
    const int span = random() % 4 == 0 ? 280 : 25;
    const int exponent = static_cast<int>(random() % static_cast<unsigned>(2 * span)) - span;
    text += random() % 2 == 0 ? 'e' : 'E';
    text += exponent >= 0 && random() % 2 == 0 ? "+" : "";
    text += std::to_string(exponent);
  }
  return text;
}

TEST(Decimal, AgreesBitForBitOverThreeMillionRandomDecimals) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 3'000'000 && !HasFatalFailure(); ++i) {
    expect_same(random_decimal(random));
  }
}

TEST(Decimal, ReadsBackEveryDoubleThatItsShortestTextNames) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1'000'000 && !HasFatalFailure(); ++i) {
    const auto value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) {
      continue;
    }
    char buffer[64];
    const auto shortest = std::to_chars(buffer, buffer + sizeof buffer, value);
    expect_same(std::string(buffer, shortest.ptr));
    const auto long_form = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, 18);
    expect_same(std::string(buffer, long_form.ptr));
  }
}

TEST(Decimal, AgreesAtTheEdgesOfTheFastPath) {
  // 2^53 and its neighbours, powers at and beyond 10^22, 19 and 20 digits, ties to even, denormals.
  for (const char* const text : {"9007199254740991",
                                 "9007199254740992",
                                 "9007199254740993",
                                 "9007199254740995",
                                 "9007199254740992e22",
                                 "9007199254740992e23",
                                 "9007199254740992e-22",
                                 "9007199254740993e-22",
                                 "1e22",
                                 "1e23",
                                 "1e-22",
                                 "1e-23",
                                 "9999999999999999999",
                                 "10000000000000000000",
                                 "18446744073709551615",
                                 "18446744073709551616",
                                 "18446744073709551617e-3",
                                 "0.00000000000000000000000001234",
                                 "00000000000000000000000001.5",
                                 "123456789012345678901234567890",
                                 "0.1234567890123456789012345",
                                 "4.9e-324",
                                 "2.2250738585072014e-308",
                                 "1.7976931348623157e308",
                                 "0",
                                 "-0",
                                 "-0.0",
                                 "0e400",
                                 "0.000e-400",
                                 ".5",
                                 "5.",
                                 "-.5e1",
                                 "1E5"}) {
    expect_same(text);
  }
}

TEST(Decimal, RoundsBeyondTheRangeToInfinityAndZeroWithTheSign) {
  const auto value_of = [](const char* text) {
    double value = 1.0;
    EXPECT_NE(decimal::parse(text, value), nullptr);
    return value;
  };
  EXPECT_EQ(value_of("1e999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(value_of("-1e309"), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(value_of("0.001e99999999999999999999"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(value_of("1e-999"), 0.0);
  EXPECT_TRUE(std::signbit(value_of("-1e-999")));
  const std::string nines(400, '9');
  EXPECT_EQ(value_of(nines.c_str()), std::numeric_limits<double>::infinity());
  std::string tiny(400, '0');
  tiny[1] = '.';
  tiny += '1';
  EXPECT_EQ(value_of(tiny.c_str()), 0.0);
}

TEST(Decimal, StopsBehindTheNumberAndRefusesWhatIsNone) {
  double value = 0.0;
  const auto taken = [&value](const char* text) {
    const char* const end = decimal::parse(text, value);
    return end == nullptr ? -1 : end - text;
  };
  EXPECT_EQ(taken("1.5,2"), 3);
  EXPECT_EQ(taken("1e"), 1);
  EXPECT_EQ(taken("1e+"), 1);
  EXPECT_EQ(taken("1.2.3"), 3);
  EXPECT_EQ(taken("0x10"), 1);
  for (const char* const text : {"", "-", "+", ".", "-.", "e5", "nan", "inf", "+-1", "--1", " 1", ","}) {
    EXPECT_EQ(taken(text), -1) << text;
  }
}

}  // namespace
}  // namespace driftlab
