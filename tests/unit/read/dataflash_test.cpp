#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(Dataflash, ReadsTheSameAsAnotherFlightLogOfTheSameData) {
  const Outcome outcome = decode_bytes(dataflash(inertial_rows(30)));
  ASSERT_FALSE(outcome.error) << outcome.message;
  const Outcome other = decode_bytes(ulog(inertial_rows(30)));
  EXPECT_EQ(outcome.bits, other.bits);
  EXPECT_EQ(outcome.decoded.names, other.decoded.names);
  EXPECT_THAT(outcome.decoded.notes, IsEmpty());
}

TEST(Dataflash, HoldsEachInstanceApartAndTakesTheFullest) {
  std::string file = dataflash_front();
  for (const InertialRow& row : inertial_rows(3)) {
    file += dataflash_sample(row, 0) + dataflash_sample(row, 1);
  }
  const Outcome outcome = decode_bytes(file + dataflash_sample(inertial_rows()[3], 1));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 4U);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("'IMU 1' is read")));
}

TEST(Dataflash, ReadsTheLayoutsOfOlderFirmwareWithTemperatureAndMilliseconds) {
  const std::string file = dataflash_format(9, 32, "IMU2", "Ifffffff", "TimeMS,GyrX,GyrY,GyrZ,AccX,AccY,AccZ,Temp") +
                           dataflash_message(9, word(5000, 4) + triad_bytes<float>({1, 2, 3}) +
                                                    triad_bytes<float>({4, 5, 6}) + bytes_of(31.5F)) +
                           dataflash_message(9, word(5020, 4) + triad_bytes<float>({1, 2, 3}) +
                                                    triad_bytes<float>({4, 5, 6}) + bytes_of(31.5F));
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.names.back(), "temperature (degC)");
  EXPECT_EQ(outcome.bits[0][1], std::bit_cast<std::uint64_t>(0.02));
  EXPECT_EQ(outcome.bits[7][1], std::bit_cast<std::uint64_t>(31.5));
}

TEST(Dataflash, TakesAMessageThatIsDeclaredTwiceAsItWasFirstAndOneThatContradictsItselfNotAtAll) {
  const std::string twice = dataflash_front() + dataflash_format(7, 12, "IMU", "Qf", "TimeUS,GyrX");
  EXPECT_FALSE(decode_bytes(twice + dataflash_sample(inertial_rows()[0])).error);
  // Its fields take 33 bytes, not the 40 that it states.
  const std::string longer = dataflash_format(7, 40, "IMU", "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ");
  EXPECT_EQ(decode_bytes(longer + dataflash_sample(inertial_rows()[0]) + "1234567").error, ErrorCode::NoSamples);
}

TEST(Dataflash, SkipsWhatIsNoMessageAndNotesATornTail) {
  std::string file = dataflash_front();
  for (const InertialRow& row : inertial_rows()) {
    file += dataflash_sample(row) + "\xA3\xA3\x95\xFFnothing";
  }
  const Outcome outcome = decode_bytes(file + dataflash_sample(inertial_rows()[0]).substr(0, 20));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 4U);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre("44 bytes of the log are no messages and are skipped.",
                                                 HasSubstr("as after a loss of power")));
}

TEST(Dataflash, NamesTheRawBatchesThatItLeavesOut) {
  const std::string declared = dataflash_format(9, 12, "ISBD", "QHH", "TimeUS,N,seqno");
  const std::string batch = dataflash_message(9, word(1000, 8) + word(1, 2) + word(0, 2));
  const Outcome outcome = decode_bytes(dataflash(inertial_rows()) + declared + batch + batch);
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("2 messages of raw batches (ISBH, ISBD)")));
  const Outcome alone = decode_bytes(dataflash_front() + declared + batch);
  EXPECT_EQ(alone.error, ErrorCode::NoSamples);
  EXPECT_THAT(alone.message, HasSubstr("raw batches (ISBH, ISBD) alone"));
}

TEST(Dataflash, RefusesALogWithoutInertialSamples) {
  EXPECT_EQ(decode_bytes(dataflash_front()).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes(dataflash_front().substr(0, 50)).error, ErrorCode::Truncated);
}

}  // namespace
}  // namespace driftlab
