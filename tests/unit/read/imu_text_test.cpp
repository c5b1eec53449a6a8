#include "core/signal/missing.hpp"
#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(ImuText, ReadsTheSameAsAFlightLogOfTheSameData) {
  const Outcome log = decode_bytes(ulog(inertial_rows(30)));
  for (const std::string& text : {euroc(inertial_rows(30)), rostopic(inertial_rows(30))}) {
    const Outcome outcome = decode_bytes(text);
    ASSERT_FALSE(outcome.error) << outcome.message;
    EXPECT_EQ(outcome.bits, log.bits);
    EXPECT_EQ(outcome.decoded.names, log.decoded.names);
    EXPECT_THAT(outcome.decoded.notes, IsEmpty());
  }
}

TEST(ImuText, TakesNanAsAMissingSampleAndRefusesWordsByTheirLine) {
  std::string text = euroc(inertial_rows(1)) + "1700000000000000000,nan,0,0,0,0,9.8\n";
  const Outcome outcome = decode_bytes(text);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(why_missing(std::bit_cast<double>(outcome.bits[1][1])).why, Missing::Nan);
  const std::string echo = rostopic(inertial_rows(1));
  const std::vector<std::tuple<std::string, ErrorCode, std::string>> cases{
      {text + "soon,0,0,0,0,0,9.8\n", ErrorCode::NotANumber, "4"},
      {text + "1,0,0\n", ErrorCode::RaggedRow, "4"},
      {euroc({}), ErrorCode::NoSamples, ""},
      {echo + "1,2,3\n", ErrorCode::RaggedRow, "3"},
      {echo + "1,7,2,imu,x,0,0,0,0,0\n", ErrorCode::NotANumber, "3"},
      {kEchoHeader, ErrorCode::NoSamples, ""},
      {"%time,field.data\n1,2\n", ErrorCode::UnsupportedType, ""},
      {"%time,field.data" + std::string(70'000, 'x') + "\n", ErrorCode::LimitExceeded, "1"},
  };
  for (const auto& [bytes, code, row] : cases) {
    const Outcome refused = decode_bytes(bytes);
    EXPECT_EQ(refused.error, code) << refused.message;
    EXPECT_EQ(refused.field("row"), row) << refused.message;
  }
}

TEST(ImuText, ReadsAFileThatEndsWithinARowUpToThere) {
  const std::string head = "%  GPST latitude(deg) longitude(deg) height(m) Q ns\n";
  std::string solution = head;
  for (int i = 0; i < 10; ++i) {
    solution += "2374 24325" + std::to_string(i) + ".499 48.5 9.25 300.125 1 21\n";
  }
  for (const std::string& text :
       {euroc(inertial_rows(10)), rostopic(inertial_rows(10)), kf_gins(inertial_rows(10)), solution}) {
    const std::size_t last = text.rfind('\n', text.size() - 2) + 1;
    const Outcome before = decode_bytes(text.substr(0, last));
    ASSERT_FALSE(before.error) << before.message;
    const std::string line = std::to_string(std::count(text.begin(), text.end(), '\n'));
    // In the first cell, in the second, and where a cell cut to its sign is the last one of a whole row.
    const std::size_t cell = text.find_last_of(", ");
    for (const std::string& torn :
         {text.substr(0, last + 4), text.substr(0, last + 30), text.substr(0, cell + 1) + "-"}) {
      const Outcome outcome = decode_bytes(torn);
      ASSERT_FALSE(outcome.error) << outcome.message;
      EXPECT_EQ(outcome.bits, before.bits);
      EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("ends within a row (line " + line + ")")));
    }
    EXPECT_TRUE(decode_bytes(text.substr(0, last + 30) + "\n").error) << "a whole line is refused";
  }
}

TEST(Rostopic, TakesTheTimeOfRecordingWhereMessagesHaveNoStamp) {
  const Outcome outcome =
      decode_bytes(kEchoHeader + "1000000000,7,0,imu,1,2,3,4,5,6\n1500000000,7,0,imu,1,2,3,4,5,6\n");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(std::bit_cast<double>(outcome.bits[0][1]), 0.5);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("no stamp")));
}

TEST(KfGins, ReadsIncrementsAsMeanRates) {
  const std::vector<InertialRow> rows = inertial_rows(10);
  const Outcome outcome = decode_bytes(kf_gins(rows));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "kf_gins");
  EXPECT_EQ(outcome.decoded.rows, 9U) << "the first line has no interval";
  EXPECT_EQ(std::bit_cast<double>(outcome.bits[0][0]), 456'000.015625);
  EXPECT_EQ(std::bit_cast<double>(outcome.bits[1][8]), rows[9].gyro_rad_s[0]);
  EXPECT_EQ(std::bit_cast<double>(outcome.bits[6][8]), 9.8125);
}

TEST(KfGins, LeavesATableOfAccelerationsToTheTableOfNumbers) {
  const auto table = [](double step, double gravity) {
    std::string text;
    for (int i = 0; i < 20; ++i) {
      text += std::to_string(100.0 + step * i) + " 0.01 0.02 0.03 0 0 " + std::to_string(gravity) + "\n";
    }
    return decode_bytes(text).decoded.format;
  };
  EXPECT_EQ(table(0.01, 9.81 * 0.01), "kf_gins");
  EXPECT_EQ(table(0.01, 9.81), "csv");  // m/s^2
  EXPECT_EQ(table(0.01, 1.0), "csv");   // g
  EXPECT_EQ(table(0.1, 0.98), "csv");   // g, in which 10 Hz would look like increments
}

TEST(KfGins, MarksARepeatedStampAndRefusesARaggedLine) {
  const std::string text = kf_gins(inertial_rows(10));
  const std::string last = text.substr(text.rfind('\n', text.size() - 2) + 1);
  const Outcome repeated = decode_bytes(text + last);
  ASSERT_FALSE(repeated.error) << repeated.message;
  EXPECT_EQ(why_missing(std::bit_cast<double>(repeated.bits[1][9])).row, 11U);
  const Outcome ragged = decode_bytes(text + "1 2 3\n");
  EXPECT_EQ(ragged.error, ErrorCode::RaggedRow);
  EXPECT_EQ(ragged.field("row"), "11");
}

TEST(RtklibPos, DatesItsPositionsInSecondsSince1970) {
  const Outcome outcome = decode_bytes(rtklib_pos());
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.format, "rtklib_pos");
  EXPECT_EQ(outcome.decoded.names,
            (ColumnNames{"time (s)", "latitude(deg)", "longitude(deg)", "height(m)", "Q", "ns"}));
  EXPECT_NEAR(std::bit_cast<double>(outcome.bits[0].front()), 1752003258.499, 1e-6);
  EXPECT_DOUBLE_EQ(std::bit_cast<double>(outcome.bits[3].back()), 300.5);
}

TEST(RtklibPos, ReadsTheSameBetweenCommas) {
  // The option "field separator" of RTKLIB made a table without a time of the solution.
  const Outcome blanks = decode_bytes(rtklib_pos());
  const std::string head = "%  GPST                  ,latitude(deg),longitude(deg), height(m),  Q, ns\n";
  const Outcome commas = decode_bytes(head + "2025/07/08 19:34:18.499,  48.5,   9.25,  300.125,  1, 21\n");
  ASSERT_FALSE(commas.error) << commas.message;
  EXPECT_EQ(commas.decoded.format, "rtklib_pos");
  EXPECT_EQ(commas.decoded.names, blanks.decoded.names);
  const Outcome spaced = decode_bytes(
      "%  GPST latitude(deg) longitude(deg) height(m) Q ns\n"
      "2025/07/08 19:34:18.499 48.5 9.25 300.125 1 21\n");
  EXPECT_EQ(commas.bits, spaced.bits);
}

TEST(RtklibPos, NamesTheOptionThatWritesPositions) {
  const auto said = [](const std::string& columns, const std::string& row) {
    return decode_bytes("%  GPST                  " + columns + " Q ns\n2025/07/08 19:34:18.499 " + row + " 1 21\n")
        .message;
  };
  EXPECT_THAT(said("latitude(d'\") longitude(d'\")  height(m)", "48 30 0.0 9 15 0.0 300"),
              HasSubstr("out-degform = deg"));
  EXPECT_THAT(said("e-baseline(m)  n-baseline(m)  u-baseline(m)", "1 2 3"), HasSubstr("out-solformat = llh"));
}

TEST(RtklibPos, TakesWeeksAndRefusesARaggedLine) {
  const std::string head = "%  GPST latitude(deg) longitude(deg) height(m) Q ns\n";
  const Outcome week = decode_bytes(head + "2374 243258.499 48.5 9.25 300.125 1 21\n");
  ASSERT_FALSE(week.error) << week.message;
  EXPECT_NEAR(std::bit_cast<double>(week.bits[0].front()), 315964800.0 + 2374.0 * 604800.0 + 243258.499, 1e-6);
  const Outcome ragged = decode_bytes(head + "2374 243258.499 48.5 9.25 300.125 1\n");
  EXPECT_EQ(ragged.error, ErrorCode::RaggedRow);
}

}  // namespace
}  // namespace driftlab
