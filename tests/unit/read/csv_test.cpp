#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using testing::decode_bytes;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Outcome;

std::vector<double> column(const Outcome& outcome, std::size_t i) {
  std::vector<double> values;
  for (const std::uint64_t word : outcome.bits.at(i)) {
    values.push_back(std::bit_cast<double>(word));
  }
  return values;
}

/// The code, the line and the column an error names.
std::string located(const Outcome& outcome) {
  return outcome.error
             ? std::string(name_of(*outcome.error)) + "@" + outcome.field("row") + ":" + outcome.field("column")
             : "no error";
}

TEST(Csv, ReadsNamesAndNumbers) {
  const Outcome outcome = decode_bytes("t,gx,gy\n0.00,1.5,-2\n0.01,1e-3,+4\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "csv");
  EXPECT_TRUE(outcome.decoded.has_header);
  EXPECT_EQ(outcome.decoded.rows, 2U);
  EXPECT_THAT(outcome.decoded.names, ElementsAre("t", "gx", "gy"));
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.01));
  EXPECT_THAT(column(outcome, 1), ElementsAre(1.5, 1e-3));
  EXPECT_THAT(column(outcome, 2), ElementsAre(-2.0, 4.0));
}

TEST(Csv, NumbersTheColumnsOfAFileWithoutHeader) {
  const Outcome outcome = decode_bytes("1,2\n3,4");
  EXPECT_FALSE(outcome.decoded.has_header);
  EXPECT_THAT(outcome.decoded.names, ElementsAre("0", "1"));
  EXPECT_THAT(column(outcome, 1), ElementsAre(2.0, 4.0));
}

TEST(Csv, TakesColumnNumbersAboveTheColumnsAsNames) {
  const Outcome outcome = decode_bytes("0,1,2\n7,8,9\n");
  EXPECT_TRUE(outcome.decoded.has_header);
  EXPECT_EQ(outcome.decoded.rows, 1U);
}

TEST(Csv, AcceptsQuotesBlanksCommentsByteOrderMarkAndCarriageReturns) {
  const Outcome outcome = decode_bytes(
      "\xEF\xBB\xBF# made by a logger\r\n\r\n \"time (s)\" , \"gz, \"\"raw\"\"\"\r\n0, 1\r\n 0.5\t,\"2\" \r\n\r\n\r\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "gz, \"raw\""));
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.5));
  EXPECT_THAT(column(outcome, 1), ElementsAre(1.0, 2.0));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("1 comment line")));
}

TEST(Csv, NamesAColumnWithoutNameByItsNumberAndSaysSo) {
  const Outcome outcome = decode_bytes(",gx\n0,1\n");
  EXPECT_THAT(outcome.decoded.names, ElementsAre("0", "gx"));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("no name")));
}

TEST(Csv, TurnsALatinOneHeaderIntoUtf8) {
  EXPECT_THAT(decode_bytes("t,gx (\xB0/s)\n0,1\n").decoded.names, ElementsAre("t", "gx (\xC2\xB0/s)"));
  EXPECT_THAT(decode_bytes("t,gx (\xC2\xB0/s)\n0,1\n").decoded.names, ElementsAre("t", "gx (\xC2\xB0/s)"));
}

TEST(Csv, NamesLineAndColumnOfEveryFault) {
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n3\n")), "ragged_row@3:");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n3,4,5\n")), "ragged_row@3:");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n\n3,4\n")), "ragged_row@3:");
  EXPECT_EQ(located(decode_bytes("# c\ngx,gy\n1,abc\n")), "not_a_number@3:gy");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n,4\n")), "not_a_number@3:gx");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2x\n")), "not_a_number@2:gy");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,0x10\n")), "not_a_number@2:gy");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,1 2\n")), "not_a_number@2:gy");
  EXPECT_EQ(located(decode_bytes(std::string("gx,gy\n1,2\n1,\0\n", 14))), "not_a_number@3:gy");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,nan\n")), "non_finite@2:gy");
  EXPECT_EQ(located(decode_bytes("gx,gy\n-Inf,2\n")), "non_finite@2:gx");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n1,2\n-Infinity,2\n")), "non_finite@4:gx");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,1e999\n")), "out_of_range@2:gy");
  EXPECT_EQ(located(decode_bytes("gx,gx\n1,2\n")), "duplicate_column@1:gx");
  EXPECT_EQ(located(decode_bytes("1.5,abc\n1,2\n")), "not_a_number@1:1");
}

TEST(Csv, RoundsANumberTooSmallForADoubleToZero) {
  EXPECT_THAT(column(decode_bytes("gx\n1e-999\n"), 0), ElementsAre(0.0));
}

TEST(Csv, TellsNothingFromAHeaderAlone) {
  EXPECT_EQ(decode_bytes("").error, ErrorCode::EmptyInput);
  EXPECT_EQ(decode_bytes("gx,gy\n").error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes("gx,gy").error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes("gx\n\n\n").error, ErrorCode::NoSamples);
}

TEST(Csv, StopsAtLinesAndColumnsBeyondTheLimits) {
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n1," + std::string((std::size_t{1} << 20) + 1, '1') + "\n")),
            "limit_exceeded@3:");
  EXPECT_EQ(located(decode_bytes("gx,gy\n1," + std::string(std::size_t{3} << 20, ' '))), "limit_exceeded@2:");
  std::string wide = "c0";
  for (int i = 1; i <= 1024; ++i) {
    wide += ",c" + std::to_string(i);
  }
  EXPECT_EQ(decode_bytes(wide + "\n1\n").error, ErrorCode::LimitExceeded);
  EXPECT_EQ(decode_bytes("gx," + std::string(257, 'n') + "\n1,2\n").error, ErrorCode::LimitExceeded);
}

TEST(Csv, ReadsALineJustWithinTheLimit) {
  const std::string blanks((std::size_t{1} << 20) - 3, ' ');
  EXPECT_FALSE(decode_bytes("gx,gy\n1," + blanks + "2\n").error);
}

TEST(Csv, SaysWhatOtherTextLooksLike) {
  EXPECT_THAT(decode_bytes("t;gx\n0;1\n").message, HasSubstr("semicolon-separated"));
  EXPECT_THAT(decode_bytes("t;gx\n0,5;1,25\n").message, HasSubstr("semicolon-separated"));
  EXPECT_THAT(decode_bytes("0,5;1,25\n").message, HasSubstr("semicolon-separated"));
  EXPECT_THAT(decode_bytes("t\tgx\n0\t1\n").message, HasSubstr("tab-separated"));
  EXPECT_THAT(decode_bytes("0.5 1.25 3\n0.6 1.25 3\n").message, HasSubstr("space-separated"));
  EXPECT_THAT(decode_bytes("Dear lab\nplease find enclosed\n").message, HasSubstr("not a table"));
}

TEST(Csv, GivesTheSameForFastAndCarefulRows) {
  // The same numbers, once plain and once quoted so that every row takes the careful path.
  std::string plain = "gx,gy\n";
  std::string quoted = plain;
  for (int i = 0; i < 20000; ++i) {
    const std::string a = std::to_string(i * 7919 % 10007) + "." + std::to_string(i);
    const std::string b = std::to_string(-i) + "e-" + std::to_string(i % 30);
    plain.append(a).append(",").append(b).append("\n");
    quoted.append("\"").append(a).append("\", \"").append(b).append("\"\r\n");
  }
  const Outcome fast = decode_bytes(plain);
  ASSERT_FALSE(fast.error) << fast.message;
  EXPECT_EQ(fast.decoded.rows, 20000U);
  EXPECT_EQ(fast.bits, decode_bytes(quoted).bits);
}

TEST(Csv, CountsLinesAcrossBatchesAndBuffers) {
  std::string text = "gx,gy\n";
  for (int i = 0; i < 100000; ++i) {
    text += "1,2\n";
  }
  EXPECT_EQ(located(decode_bytes(text + "1,x\n")), "not_a_number@100002:gy");
}

}  // namespace
}  // namespace driftlab
