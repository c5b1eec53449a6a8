#include "core/signal/missing.hpp"
#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <limits>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<double> column(const Outcome& outcome, std::size_t index) {
  std::vector<double> values;
  for (const std::uint64_t bits : outcome.bits.at(index)) {
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

/// A log of sensor_combined with `between` put behind its second sample.
std::string interrupted(const std::string& between) {
  std::string file = ulog_front() + ulog_topic(kSensorCombined);
  for (std::size_t i = 0; i < 4; ++i) {
    file += ulog_sample(inertial_rows()[i]) + (i == 1 ? between : "");
  }
  return file;
}

TEST(Ulog, ReadsSensorCombinedInSiFromItsFirstSampleOn) {
  const Outcome outcome = decode_bytes(ulog(inertial_rows()));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "gyro_x (rad/s)", "gyro_y (rad/s)", "gyro_z (rad/s)",
                                                 "acc_x (m/s^2)", "acc_y (m/s^2)", "acc_z (m/s^2)"));
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.005, 0.01, 0.02));
  EXPECT_THAT(column(outcome, 1), ElementsAre(0.0, 0.125, 0.25, 0.375));
  EXPECT_THAT(column(outcome, 6), ElementsAre(9.8125, 9.8125, 9.8125, 9.8125));
  EXPECT_THAT(outcome.decoded.notes, ElementsAre("The logger dropped messages once, for 30 ms together."));
}

TEST(Ulog, NamesTheBurstsThatItLeavesOut) {
  const std::string topic =
      ulog_topic("sensor_gyro_fifo:uint64_t timestamp;uint64_t timestamp_sample;float dt;float scale;uint8_t samples;");
  const std::string burst = ulog_message('D', word(3, 2) + word(9, 8) + word(5000, 8) + word(0, 9));
  const Outcome alone = decode_bytes(ulog_front() + topic + burst + burst);
  EXPECT_EQ(alone.error, ErrorCode::NoSamples);
  EXPECT_THAT(alone.message, HasSubstr("in bursts (sensor_gyro_fifo) alone"));
  const std::string combined = ulog(inertial_rows());  // message 3 is sensor_combined there
  std::string subscribed = ulog_message(
      'F', "sensor_accel_fifo:uint64_t timestamp;uint64_t timestamp_sample;float dt;float scale;uint8_t samples;");
  subscribed += ulog_message('A', word(0, 1) + word(9, 2) + "sensor_accel_fifo");
  const Outcome both =
      decode_bytes(combined + subscribed + ulog_message('D', word(9, 2) + word(9, 8) + word(5000, 8) + word(0, 9)));
  ASSERT_FALSE(both.error) << both.message;
  EXPECT_EQ(both.bits, decode_bytes(combined).bits);
  EXPECT_THAT(both.decoded.notes, Contains(HasSubstr("1 burst of sensor_accel_fifo")));
}

TEST(Ulog, ReadsIncrementsAsMeanRatesOverTheirOwnInterval) {
  const std::string file = ulog_front() +
                           ulog_topic(
                               "vehicle_imu:uint64_t timestamp;uint64_t timestamp_sample;float[3] delta_angle;"
                               "float[3] delta_velocity;uint16_t delta_angle_dt;uint16_t delta_velocity_dt;") +
                           ulog_message('D', word(3, 2) + word(9, 8) + word(5000, 8) + triad_bytes<float>({0.5, 0, 0}) +
                                                 triad_bytes<float>({0, 0, 2}) + word(4000, 2) + word(8000, 2)) +
                           ulog_message('D', word(3, 2) + word(9, 8) + word(9000, 8) + triad_bytes<float>({0.5, 0, 0}) +
                                                 triad_bytes<float>({0, 0, 2}) + word(0, 2) + word(8000, 2));
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.004));
  EXPECT_EQ(column(outcome, 1)[0], 125.0);
  EXPECT_EQ(column(outcome, 6)[0], 250.0);
  EXPECT_EQ(why_missing(column(outcome, 1)[1]).why, Missing::Nan) << "an interval of nothing has no rate";
}

TEST(Ulog, TakesTheFastestStreamWithBothSensorsAndNamesTheOthers) {
  std::string file = ulog_front() + ulog_topic(kSensorCombined, 3, 0) + ulog_topic(kSensorCombined, 4, 1) +
                     ulog_topic("sensor_gyro:uint64_t timestamp;float x;float y;float z;float temperature;", 5);
  for (const InertialRow& row : inertial_rows(3)) {
    file += ulog_sample(row, 3) + ulog_sample(row, 4) + ulog_sample(row, 4);
    for (int i = 0; i < 4; ++i) {
      file += ulog_message('D', word(5, 2) + word(row.time_us, 8) + std::string(16, '\0'));
    }
  }
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 6U);
  EXPECT_THAT(outcome.decoded.notes,
              ElementsAre("Of several inertial streams 'sensor_combined 1' is read (gyroscope and accelerometer, 6 "
                          "samples). State another one as `stream` to have it read: imu2 is 'sensor_combined 0' "
                          "(gyroscope and accelerometer, 3 samples), imu3 is 'sensor_gyro 0' (gyroscope alone, 12 "
                          "samples).",
                          "Of 'sensor_gyro 0' the last 6 rows are left out. It is longer than the inertial stream that "
                          "it stands beside."));
}

TEST(Ulog, ReadsAGyroscopeAloneWithItsTemperature) {
  const std::string file =
      ulog_front() + ulog_topic("sensor_gyro:uint64_t timestamp;float x;float y;float z;float temperature;") +
      ulog_message('D', word(3, 2) + word(7, 8) + triad_bytes<float>({1, 2, 3}) + bytes_of(41.5F)) +
      ulog_message('D', word(3, 2) + word(8, 8) + triad_bytes<float>({1, 2, 3}) +
                            bytes_of(std::numeric_limits<float>::quiet_NaN()));
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.names.back(), "temperature (degC)");
  EXPECT_EQ(column(outcome, 4)[0], 41.5);
  EXPECT_EQ(why_missing(column(outcome, 4)[1]).row, 2U);
}

TEST(Ulog, GoesOnBehindDamageAtTheNextSynchronisation) {
  const Outcome whole = decode_bytes(interrupted(""));
  const Outcome damaged = decode_bytes(interrupted("\x07\x07\x07\x07\x07" + ulog_sync()));
  ASSERT_FALSE(damaged.error) << damaged.message;
  EXPECT_EQ(damaged.bits, whole.bits);
  EXPECT_THAT(damaged.decoded.notes, Contains(HasSubstr("5 bytes up to the next synchronisation are skipped")));
}

TEST(Ulog, ReadsWhatIsBeforeATornTailAndSaysSo) {
  const std::string file = interrupted("");
  const Outcome outcome = decode_bytes(std::string_view(file).substr(0, file.size() - 9));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 3U);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("ends within the message at byte")));
}

TEST(Ulog, FindsTheDataThatACrashHandlerAppended) {
  // The message that was being written when the crash came is cut off where the appended data begin.
  const std::string sample = ulog_sample(inertial_rows()[0]);
  const std::string definitions = ulog_topic(kSensorCombined);
  const std::uint64_t border = ulog_front().size() + definitions.size() + sample.size() + 11;
  const std::string file =
      ulog_front('\x01', border) + definitions + sample + sample.substr(0, 11) + ulog_sample(inertial_rows()[1]);
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(column(outcome, 0), ElementsAre(0.0, 0.005));
  EXPECT_THAT(outcome.decoded.notes, IsEmpty());
}

TEST(Ulog, RefusesWhatItCannotRead) {
  const std::string data = ulog_sample(inertial_rows()[0]);
  const std::vector<std::pair<std::string, ErrorCode>> cases{
      {"ULog\x01\x12\x35\x01", ErrorCode::Truncated},
      {ulog_front('\x02'), ErrorCode::UnsupportedType},
      {ulog_front() + ulog_message('I', "x"), ErrorCode::NoSamples},
      {ulog_front() + data.substr(0, 20), ErrorCode::Truncated},
      {ulog_front() + ulog_topic("sensor_combined:uint64_t timestamp;float[3] gyro_rad;"), ErrorCode::UnsupportedType},
      // A type that contains itself has no size; a field of 4 billion elements is more than a message can hold.
      {ulog_front() + ulog_topic("sensor_combined:sensor_combined a;uint64_t timestamp;"), ErrorCode::UnsupportedType},
      {ulog_front() + ulog_topic("sensor_combined:float[4000000000] a;uint64_t timestamp;"),
       ErrorCode::UnsupportedType},
  };
  for (const auto& [bytes, code] : cases) {
    const Outcome outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, code) << outcome.message;
    EXPECT_THAT(outcome.message, HasSubstr("ULog"));
  }
}

TEST(InertialStreams, GoOnWithTheChosenStreamWhenTheChoiceIsMade) {
  // 16 MiB of samples decide; the stream that is slower until then stays out, however many samples it has behind.
  std::string file = ulog_front() + ulog_topic(kSensorCombined, 3, 0) + ulog_topic(kSensorCombined, 4, 1);
  const std::vector<InertialRow> rows = inertial_rows(320'000);
  for (const InertialRow& row : rows) {
    file += ulog_sample(row, 3);
  }
  for (std::size_t i = 0; i < 330'000; ++i) {
    file += ulog_sample(rows[i % rows.size()], 4);
  }
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 320'000U);
  EXPECT_EQ(column(outcome, 1)[319'999], rows[319'999].gyro_rad_s[0]);
  EXPECT_THAT(outcome.decoded.notes, Contains(HasSubstr("'sensor_combined 1' (gyroscope and accelerometer, 330000")));
}

}  // namespace
}  // namespace driftlab
