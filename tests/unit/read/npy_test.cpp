#include "core/signal/missing.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace driftlab {
namespace {

using testing::decode_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::npy;
using testing::npy_dictionary;
using testing::number_bytes;
using testing::Outcome;
using testing::ramp;

std::vector<double> column(const Outcome& outcome, std::size_t i) {
  std::vector<double> values;
  for (const std::uint64_t word : outcome.bits.at(i)) {
    values.push_back(std::bit_cast<double>(word));
  }
  return values;
}

Outcome decode_shape(const std::string& shape, std::size_t numbers, bool fortran_order = false) {
  return decode_bytes(npy(npy_dictionary("<f8", fortran_order, shape), number_bytes<double>(ramp(numbers))));
}

TEST(Npy, ReadsEveryElementTypeOrderAndVersion) {
  for (const int version : {1, 2, 3}) {
    for (const bool big_endian : {false, true}) {
      for (const bool fortran_order : {false, true}) {
        const std::string order = big_endian ? ">" : "<";
        const Outcome wide = decode_bytes(npy(npy_dictionary(order + "f8", fortran_order, "(3, 2)"),
                                              number_bytes<double>(ramp(6), big_endian), version));
        const Outcome narrow = decode_bytes(npy(npy_dictionary(order + "f4", fortran_order, "(3, 2)"),
                                                number_bytes<float>(ramp(6), big_endian), version));
        ASSERT_FALSE(wide.error) << wide.message;
        EXPECT_EQ(wide.bits, narrow.bits);  // the ramp is exact in float32
        EXPECT_THAT(wide.decoded.names, ElementsAre("0", "1"));
        EXPECT_FALSE(wide.decoded.has_header);
        EXPECT_EQ(wide.decoded.rows, 3U);
        if (fortran_order) {
          EXPECT_THAT(column(wide, 1), ElementsAre(-2.25, -2.0, -1.75));
        } else {
          EXPECT_THAT(column(wide, 1), ElementsAre(-2.75, -2.25, -1.75));
        }
      }
    }
  }
}

template <class Number>
void expect_whole_numbers(const std::string& descr) {
  const std::vector<double> values{
      static_cast<double>(std::numeric_limits<Number>::min()),
      0.0,
      1.0,
      2.0,
      100.0,
      static_cast<double>(static_cast<Number>(std::numeric_limits<Number>::max() / 2 + 1))};
  for (const bool big_endian : {false, true}) {
    const std::string order = sizeof(Number) == 1 ? "|" : big_endian ? ">" : "<";
    const Outcome read =
        decode_bytes(npy(npy_dictionary(order + descr, false, "(6,)"), number_bytes<Number>(values, big_endian)));
    ASSERT_FALSE(read.error) << descr << ": " << read.message;
    EXPECT_EQ(column(read, 0), values) << descr;
  }
}

TEST(Npy, ReadsWholeNumbersAsARawLoggerWritesThem) {
  expect_whole_numbers<std::int8_t>("i1");
  expect_whole_numbers<std::uint8_t>("u1");
  expect_whole_numbers<std::int16_t>("i2");
  expect_whole_numbers<std::uint16_t>("u2");
  expect_whole_numbers<std::int32_t>("i4");
  expect_whole_numbers<std::uint32_t>("u4");
  expect_whole_numbers<std::int64_t>("i8");
  expect_whole_numbers<std::uint64_t>("u8");
}

TEST(Npy, ReadsOneDimensionAsOneColumn) {
  const Outcome outcome = decode_shape("(4,)", 4);
  EXPECT_EQ(outcome.decoded.rows, 4U);
  EXPECT_THAT(outcome.decoded.names, ElementsAre("0"));
}

TEST(Npy, SpansManyBatchesInBothOrders) {
  const Outcome by_row = decode_shape("(50000, 3)", 150000);
  const Outcome by_column = decode_shape("(50000, 3)", 150000, true);
  ASSERT_FALSE(by_row.error);
  ASSERT_FALSE(by_column.error);
  const std::vector<double> values = ramp(150000);
  EXPECT_EQ(column(by_row, 2).back(), values.back());
  EXPECT_EQ(column(by_row, 1)[40000], values[120001]);
  EXPECT_EQ(column(by_column, 1)[40000], values[90000]);
}

TEST(Npy, CatchesAHeaderThatLiesAboutItsShape) {
  EXPECT_EQ(decode_shape("(4, 3)", 13).error, ErrorCode::ShapeMismatch);  // more than declared
  EXPECT_EQ(decode_shape("(5, 3)", 12).error, ErrorCode::Truncated);      // fewer than declared
  EXPECT_EQ(decode_shape("(5, 3)", 12).field("row"), "5");
  EXPECT_EQ(decode_shape("(1152921504606846976, 1024)", 12).error, ErrorCode::ShapeMismatch);  // (2^60, 2^10)
  EXPECT_EQ(decode_shape("(99999999999999999999999, 1)", 12).error, ErrorCode::ShapeMismatch);
  EXPECT_EQ(decode_shape("(1099511627776, 3)", 12).error, ErrorCode::Truncated);  // 2^40 rows: nothing is allocated
  EXPECT_EQ(decode_shape("(0,)", 0).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_shape("(4, 0)", 0).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_shape("(6, 100000)", 12).error, ErrorCode::LimitExceeded);
  EXPECT_EQ(decode_shape("()", 1).error, ErrorCode::UnsupportedType);
  EXPECT_EQ(decode_shape("(2, 2, 3)", 12).error, ErrorCode::UnsupportedType);
  EXPECT_EQ(decode_shape("(-4, 3)", 12).error, ErrorCode::ShapeMismatch);
}

TEST(Npy, NamesTheElementTypeItRefuses) {
  for (const std::string descr : {"|i4", "<i3", "<f2", "|b1", "<M8", "<c16", "|O", "<f16", "|S8", "f8", ""}) {
    const Outcome outcome = decode_bytes(npy(npy_dictionary(descr, false, "(4,)"), std::string(64, '\0')));
    EXPECT_EQ(outcome.error, ErrorCode::UnsupportedType) << descr;
    EXPECT_THAT(outcome.message, HasSubstr("'" + descr + "'"));
  }
  const Outcome structured =
      decode_bytes(npy("{'descr': [('t', '<f8'), ('g', '<f8', (3,))], 'fortran_order': False, 'shape': (4,), }", ""));
  EXPECT_EQ(structured.error, ErrorCode::UnsupportedType);
}

TEST(Npy, RefusesAHeaderItCannotRead) {
  for (const std::string dictionary :
       {"", "{", "{}", "[]", "{'descr': '<f8'}", "{'descr': '<f8', 'fortran_order': 1, 'shape': (1,)}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': 4}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,), 'extra': 1}",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1,)} + 1",
        "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (1,)}"}) {
    EXPECT_EQ(decode_bytes(npy(dictionary, number_bytes<double>({1.0}))).error, ErrorCode::ShapeMismatch) << dictionary;
  }
  EXPECT_EQ(decode_bytes("\x93NUMPY").error, ErrorCode::Truncated);
  EXPECT_EQ(decode_bytes(npy(npy_dictionary("<f8", false, "(1,)"), number_bytes<double>({1.0}), 4)).error,
            ErrorCode::UnsupportedType);
}

TEST(Npy, KeepsANumberThatIsNotFiniteAsAMissingSampleOfItsRow) {
  std::vector<double> values = ramp(12);
  values[7] = std::numeric_limits<double>::quiet_NaN();
  const Outcome by_row = decode_bytes(npy(npy_dictionary("<f8", false, "(4, 3)"), number_bytes<double>(values)));
  ASSERT_FALSE(by_row.error) << by_row.message;
  const MissingSample nan = why_missing(column(by_row, 1)[2]);
  EXPECT_EQ(nan.why, Missing::Nan);
  EXPECT_EQ(nan.row, 3U);
  values[7] = -std::numeric_limits<double>::infinity();
  const Outcome by_column = decode_bytes(npy(npy_dictionary("<f4", true, "(4, 3)"), number_bytes<float>(values)));
  ASSERT_FALSE(by_column.error) << by_column.message;
  const MissingSample infinite = why_missing(column(by_column, 1)[3]);
  EXPECT_EQ(infinite.why, Missing::Infinite);
  EXPECT_EQ(infinite.row, 4U);
}

}  // namespace
}  // namespace driftlab
