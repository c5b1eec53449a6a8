#include "core/signal/missing.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>

namespace driftlab {
namespace {

using ::testing::Contains;
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
  EXPECT_EQ(located(decode_bytes("gx,gy\n1,2\n\n3,4\n")), "no error") << "an empty line is passed over, and counted";
  EXPECT_EQ(located(decode_bytes("gx,gx\n1,2\n")), "duplicate_column@1:gx");
}

TEST(Csv, RefusesATableWithoutAnyNumberByItsFirstCell) {
  EXPECT_EQ(located(decode_bytes("gx,gy\na,b\nc,d\n")), "not_a_number@2:gx");
  EXPECT_EQ(located(decode_bytes("gx,gy\n,\n")), "not_a_number@2:gx");
  EXPECT_EQ(located(decode_bytes("gx\nnan\n")), "non_finite@2:gx");
  EXPECT_EQ(located(decode_bytes("gx\n1e999\n")), "out_of_range@2:gx");
}

TEST(Csv, SaysInOneSentenceWhatATableWithoutNumbersLacks) {
  EXPECT_EQ(decode_bytes("gx;gy\na;b\nc;d\n").message,
            "Line 2, column 'gx': 'a' is not a number, and no other cell is; wanted are numbers between commas, "
            "semicolons, tabs, bars or blanks.");
  EXPECT_THAT(decode_bytes("gx,gy\n1,2\n3,4,5\n").message, HasSubstr("; correct or delete that line."));
  EXPECT_EQ(
      decode_bytes("# two sensors\nx,y,x,y\n1,2,3,4\n").message,
      "Two columns are called 'x'; give each its own name, or leave the line of names out with --skip-lines 2 and "
      "call columns by their numbers, from 0.");
}

/// What the NaN in a cell says, as `kind@line`.
std::string hole(const Outcome& outcome, std::size_t column, std::size_t row) {
  const double value = std::bit_cast<double>(outcome.bits.at(column).at(row));
  const MissingSample missing = why_missing(value);
  constexpr std::array kKinds{"unknown", "empty", "nan", "infinite", "text", "out of range", "ended"};
  return std::isnan(value)
             ? std::string(kKinds.at(static_cast<std::size_t>(missing.why))) + "@" + std::to_string(missing.row)
             : "a number";
}

TEST(Csv, KeepsWhatACellThatIsNoNumberHeldAndItsLine) {
  EXPECT_EQ(hole(decode_bytes("# c\ngx,gy\n1,2\n1,abc\n"), 1, 1), "text@4");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,2\n,4\n"), 0, 1), "empty@3");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,2\n4,\n"), 1, 1), "empty@3");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,2x\n"), 1, 0), "text@2");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,0x10\n"), 1, 0), "text@2");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,1 2\n"), 1, 0), "text@2");
  EXPECT_EQ(hole(decode_bytes(std::string("gx,gy\n1,2\n1,\0\n", 14)), 1, 1), "text@3");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,NaN\n"), 1, 0), "nan@2");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n-Inf,2\n"), 0, 0), "infinite@2");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,2\n1,2\n-Infinity,2\n"), 0, 2), "infinite@4");
  EXPECT_EQ(hole(decode_bytes("gx,gy\n1,1e999\n"), 1, 0), "out of range@2");
  EXPECT_EQ(hole(decode_bytes("1.5,abc\n1,2\n"), 1, 0), "text@1");
}

TEST(Csv, SaysWhichColumnsHoldText) {
  EXPECT_THAT(decode_bytes("state,gx\nS,1\nS,2\n").decoded.notes,
              ElementsAre("Column 'state' holds text in 2 of 2 rows, first 'S'."));
}

TEST(Csv, ReadsTheRowsOfALogThatTalksInBetweenAndSaysSo) {
  // Serial logs: a restart in the middle, blank lines, and a file that stops within its last row were refused whole.
  const std::string rows = "1,2\n3,4\n";
  const auto log =
      decode_bytes("gx,gy\n" + rows + "\n\n" + rows + "[WARN] buffer full\n" + rows + "gx,gy\n" + rows + "5");
  ASSERT_FALSE(log.error) << log.message;
  EXPECT_THAT(column(log, 0), ElementsAre(1, 3, 1, 3, 1, 3, 1, 3));
  EXPECT_THAT(
      log.decoded.notes,
      ElementsAre("2 blank lines between the rows were skipped (the first is line 4).",
                  "2 lines between the rows hold words alone and were skipped (the first is line 8: \"[WARN] buffer "
                  "full\").",
                  "The file ends within a row (line 14); that row is left out."));
  // A row that is torn anywhere else, or has too many cells, is still a fault: samples are lost there.
  EXPECT_EQ(decode_bytes("gx,gy\n1,2\n3\n4,5\n").error, ErrorCode::RaggedRow);
  EXPECT_EQ(decode_bytes("gx,gy\n1,2\n3,4,5").error, ErrorCode::RaggedRow);
  EXPECT_EQ(decode_bytes("gx,gy\n1,2\nreset x\nreset x\nreset x\nreset x\n3,4\n").error, ErrorCode::RaggedRow);
  EXPECT_TRUE(decode_bytes("gx,gy\n1,2\n3,4\n\n\n").decoded.notes.empty());
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
  EXPECT_THAT(decode_bytes("Dear lab\nplease find enclosed\n").message, HasSubstr("not a table"));
  EXPECT_THAT(decode_bytes("I have 2 apples\nyou have 3 pears\n").message, HasSubstr("not a table"));
}

/// Three rows of 0.5, -1.25, 1e-3 in some dialect.
void expect_the_same_table(const std::string& text, const std::vector<std::string>& names) {
  const Outcome outcome = decode_bytes(text);
  ASSERT_FALSE(outcome.error) << text << outcome.message;
  EXPECT_EQ(outcome.decoded.names, names) << text;
  ASSERT_EQ(outcome.decoded.rows, 3U) << text;
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.5, 0.5, 0.5)) << text;
  EXPECT_THAT(column(outcome, 1), ElementsAre(-1.25, -1.25, -1.25)) << text;
  EXPECT_THAT(column(outcome, 2), ElementsAre(1e-3, 1e-3, 1e-3)) << text;
}

std::string thrice(const std::string& header, const std::string& row) { return header + row + row + row; }

TEST(Csv, ReadsEveryDialect) {
  const std::vector<std::string> names{"t", "gx", "gy"};
  expect_the_same_table(thrice("t,gx,gy\n", "0.5,-1.25,1e-3\n"), names);
  expect_the_same_table(thrice("t;gx;gy\n", "0.5;-1.25;1e-3\n"), names);
  expect_the_same_table(thrice("t;gx;gy\r\n", "0,5;-1,25;1,0E-3\r\n"), names);
  expect_the_same_table(thrice("\"t\";\"gx\";\"gy\"\n", "5,0E-1;-1,25E0;1,0E-3\n"), names);
  expect_the_same_table(thrice("t\tgx\tgy\n", "0.5\t-1.25\t1e-3\n"), names);
  expect_the_same_table(thrice("t\tgx\tgy\n", "0,5\t-1,25\t1e-3\n"), names);
  expect_the_same_table(thrice("t gx  gy\n", "  0.5   -1.25 1e-3 \n"), names);
  expect_the_same_table(thrice("t|gx|gy\n", "0.5|-1.25|1e-3\n"), names);
  expect_the_same_table(thrice("t | gx | gy\n", "0,5 | -1,25 | 1,0E-3\n"), names);
  expect_the_same_table(thrice("t [s] gx [deg/s] gy\n", "0.5 -1.25 1e-3\n"), {"t [s]", "gx [deg/s]", "gy"});
  expect_the_same_table(thrice("// Counter below\n// Firmware 2\nt\tgx\tgy\n", " 0.5\t-1.25\t1e-3\t\n"), names);
  expect_the_same_table(thrice("t,gx,gy,\n", "0.5,-1.25,1e-3,\n"), names);
  expect_the_same_table(thrice("Fs,100\nLogging Type,0\nt,gx,gy\n", "0.5,-1.25,1e-3\n"), names);
  expect_the_same_table(thrice("# t, gx, gy\n", "0.5,-1.25,1e-3\n"), names);
  expect_the_same_table(thrice("t,gx,gy\ns,deg/s,\n", "0.5,-1.25,1e-3\n"), {"t (s)", "gx (deg/s)", "gy"});
  expect_the_same_table(thrice("t;gx;gy\n[s];[deg/s];[deg/s]\n", "0,5;-1,25;1e-3\n"),
                        {"t (s)", "gx (deg/s)", "gy (deg/s)"});
  expect_the_same_table(thrice("% made by a logger\n", "0.5 -1.25 1e-3\n"), {"0", "1", "2"});
  expect_the_same_table("t,gx,gy\n0.5,-1.25,1e-3\n# paused\n0.5,-1.25,1e-3\n0.5,-1.25,1e-3\n", names);
}

TEST(Csv, IgnoresTheSeparatorBehindEachRowBelowLinesAboutTheSensor) {
  // A phone wrote two lines about its sensor above the names; the first line, not the names, was asked whether it ends
  // as the rows do, and the file was refused for a row of one cell too many.
  const Outcome outcome = decode_bytes(
      "Sensor: LSM6DSL\nVendor: STM\nTime [ns]; GyroX [rad/s]; GyroY "
      "[rad/s]\n47;-0.0251;0.0010;\n48;-0.0116;0.0034;\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("Time [ns]", "GyroX [rad/s]", "GyroY [rad/s]"));
  EXPECT_EQ(outcome.decoded.rows, 2U);
}

TEST(Csv, SkipsTheBannerOfABoardAboveRowsWithoutNamesAndSaysSo) {
  // `MPU6050 ready` became the header of one or two names, and the first row was refused for its six values.
  for (const std::string separator : {",", "\t", " ", ";", ", "}) {
    std::string text = "MPU6050 ready\n";
    for (int row = 0; row < 3; ++row) {
      text.append("0.5").append(separator).append("-1.25").append(separator).append("1e-3").append(separator).append(
          "4\n");
    }
    const Outcome outcome = decode_bytes(text);
    ASSERT_FALSE(outcome.error) << separator << outcome.message;
    EXPECT_FALSE(outcome.decoded.has_header);
    EXPECT_THAT(outcome.decoded.names, ElementsAre("0", "1", "2", "3")) << separator;
    EXPECT_THAT(column(outcome, 1), ElementsAre(-1.25, -1.25, -1.25)) << separator;
    EXPECT_THAT(outcome.decoded.notes,
                ElementsAre("1 line above the rows is no sample and was skipped (line 1: \"MPU6050 ready\")."));
  }
  const Outcome several = decode_bytes("# log\nAdafruit MPU6050 test!\nFound a chip 2\n\n1 2 3 4 5 6\n2 3 4 5 6 7\n");
  ASSERT_FALSE(several.error) << several.message;
  EXPECT_EQ(several.decoded.rows, 2U);
  EXPECT_THAT(several.decoded.notes, Contains("2 lines above the rows are no samples and were skipped (the first is "
                                              "line 2: \"Adafruit MPU6050 test!\")."));
  EXPECT_EQ(decode_bytes("Fs,100\n7,2,3\n4,5,6\n").decoded.names.size(), 4U) << "its rate gives the time";
}

TEST(Csv, NamesTheOptionWhereANarrowFirstLineMayBeNames) {
  const std::string sentence =
      "Line 2 has 3 values; the header in line 1 has 2; correct it, or if that line is no "
      "header, leave it out with --skip-lines 1.";
  EXPECT_EQ(decode_bytes("gx,gy\n1,2,3\n4,5,6\n").message, sentence) << "names that are too few are not dropped";
  EXPECT_EQ(decode_bytes("a b\n1 2 3\n2 5 6\n").message, sentence) << "R numbers the rows and not their names";
  EXPECT_EQ(decode_bytes("value\n0,5\n1,5\n").error, ErrorCode::RaggedRow) << "a decimal comma, or two columns";
  EXPECT_EQ(decode_bytes("5\n1,2,3\n4,5,6\n").error, ErrorCode::RaggedRow) << "a row that is torn";
}

TEST(Csv, KeepsAnEmptyFirstNameBeforeATab) {
  EXPECT_THAT(decode_bytes("\tgx\tgy\n0\t1\t2\n1\t3\t4\n").decoded.names, ElementsAre("0", "gx", "gy"));
}

TEST(Csv, ReadsDatesAsSeconds) {
  const Outcome outcome =
      decode_bytes("time,gx\n2025-06-14 21:17:02+00:00,1\n2025-06-14T23:17:03.5+02:00,2\n2024-02-29 00:00:00,3\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(1749935822.0, 1749935823.5, 1709164800.0));
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "gx"));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("seconds since 1970")));
  EXPECT_EQ(hole(decode_bytes("time,gx\n2025-13-14 21:17:02,1\n"), 0, 0), "text@2");
}

TEST(Csv, ReadsDatesWithSlashesOrWithoutMarks) {
  const Outcome outcome =
      decode_bytes("time,gx\n2025/06/14 21:17:02,1\n2025/06/14T21:17:03.5Z,2\n20250614T211704.250,3\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(1749935822.0, 1749935823.5, 1749935824.25));
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "gx"));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("seconds since 1970")));
  for (const char* const text : {"2025/06-14 21:17:02", "14.06.2025 21:17:02", "06/14/2025 09:17:02 PM",
                                 "20250614T2117", "20251314T211704", "2025/06/14"}) {
    EXPECT_EQ(hole(decode_bytes("time,gx\n" + std::string(text) + ",1\n"), 0, 0), "text@2") << text;
  }
}

TEST(Csv, ReadsTimesOfDayAsSecondsSinceMidnight) {
  const Outcome outcome =
      decode_bytes("Time,gx\n23:59:59.250,1\n23:59:59.75,2\n00:00:00.25,3\n0:00:01,4\n23:59:59,5\n00:00:00,6\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(86399.25, 86399.75, 86400.25, 86401.0, 172799.0, 172800.0));
  EXPECT_THAT(outcome.decoded.names, ElementsAre("Time (s)", "gx"));
  EXPECT_THAT(outcome.decoded.notes,
              ElementsAre("Times of day in column 'Time (s)' are read as seconds since midnight, 2 midnights passed."));
  EXPECT_THAT(decode_bytes("t [hh:mm:ss],gx\n12:00:00,1\n12:00:01,2\n").decoded.names, ElementsAre("t (s)", "gx"));
  EXPECT_THAT(column(decode_bytes("12:00:00.5,1.5\n12:00:01.5,2\n"), 0), ElementsAre(43200.5, 43201.5)) << "no names";
  // Where not every cell is one, none is read as one; nor is what only looks like one.
  EXPECT_EQ(hole(decode_bytes("time,gx\n12:00:00,1\nlate,2\n"), 0, 0), "text@2");
  for (const char* const text : {"24:00:00", "12:60:00", "12:00", "00:01.500", "12:00:00 PM", "12.00.00"}) {
    EXPECT_EQ(hole(decode_bytes("time,gx\n" + std::string(text) + ",1\n"), 0, 0), "text@2") << text;
  }
  // A column that is one in the rows that were looked at has a missing time where it later is none.
  std::string late = "time,gx\n";
  for (int i = 0; i < 100; ++i) {
    late += "12:00:" + std::to_string(10 + i / 10) + "." + std::to_string(i % 10) + ",1\n";
  }
  EXPECT_EQ(hole(decode_bytes(late + "7.5,2\n"), 0, 100), "text@102");
}

TEST(Csv, SaysHowItReadADialect) {
  EXPECT_THAT(decode_bytes("t;gx\n0,5;1,25\n").decoded.notes, ElementsAre(HasSubstr("decimal comma")));
  EXPECT_THAT(decode_bytes("t,gx\ns,deg/s\n1,2\n").decoded.notes, ElementsAre(HasSubstr("units")));
  EXPECT_THAT(decode_bytes("t,gx,\n1,2,\n").decoded.notes, ElementsAre(HasSubstr("separator behind the last cell")));
}

TEST(Csv, MakesTheTimeThatAStatedRateGives) {
  const Outcome plain = decode_bytes("// Sample rate: 50.0Hz\nAcc_X\tAcc_Y\n1\t2\n3\t4\n5\t6\n");
  ASSERT_FALSE(plain.error) << plain.message;
  EXPECT_THAT(plain.decoded.names, ElementsAre("Acc_X", "Acc_Y", "time (s)"));
  EXPECT_THAT(column(plain, 2), ElementsAre(0.0, 0.02, 0.04));
  EXPECT_THAT(plain.decoded.notes, Contains(HasSubstr("states 50 Hz")));
  // A packet counter shows what was lost, and goes on where it starts again.
  const Outcome counted = decode_bytes("// Sample rate: 50.0Hz\nCounter\tAcc_X\n65533\t2\n65535\t4\n1\t6\n");
  EXPECT_THAT(column(counted, 2), ElementsAre(0.0, 0.04, 0.08));
  const Outcome preamble = decode_bytes("Fs,100\nax,ay,az\n1,2,3\n4,5,6\n");
  EXPECT_THAT(column(preamble, 3), ElementsAre(0.0, 0.01));
  // Where there is a time column, it rules.
  EXPECT_THAT(decode_bytes("# Sample rate: 50 Hz\nt,gx\n0,1\n0.02,2\n").decoded.names, ElementsAre("t", "gx"));
}

TEST(Csv, TakesACounterBeyondCountingAsMissingTime) {
  const Outcome outcome = decode_bytes("// Sample rate: 0.5Hz\nCounter\tAcc_X\n-1e308\t2\n1e308\t4\n7\t6\n8\t8\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  const std::vector<double> time = column(outcome, 2);
  EXPECT_EQ(why_missing(time[0]).why, Missing::OutOfRange);
  EXPECT_EQ(why_missing(time[1]).why, Missing::OutOfRange);
  EXPECT_EQ(time[3], 2.0);
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
  EXPECT_EQ(located(decode_bytes(text + "1\n")), "ragged_row@100002:");
}

}  // namespace
}  // namespace driftlab
