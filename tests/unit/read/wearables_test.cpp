#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <gmock/gmock.h>

#include <bit>

namespace driftlab {
namespace {

using namespace driftlab::testing;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pointwise;

std::vector<double> column(const Outcome& outcome, std::size_t index) {
  std::vector<double> values;
  for (const std::uint64_t bits : outcome.bits.at(index)) {
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

constexpr double kTimeTolerance = 1e-12;  // seconds of a few minutes, in doubles

TEST(Cwa, ReadsGyroscopeAccelerometerAndTemperatureInTheUnitsOfTheDevice) {
  const Outcome outcome = decode_bytes(cwa());
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names, ElementsAre("time (s)", "gyro_x (deg/s)", "gyro_y (deg/s)", "gyro_z (deg/s)",
                                                 "acc_x (g)", "acc_y (g)", "acc_z (g)", "temperature (degC)"));
  EXPECT_THAT(column(outcome, 1), ElementsAre(250.0 / 32768, 250.0 / 32768, 4 * 250.0 / 32768));
  EXPECT_THAT(column(outcome, 4), ElementsAre(0.0, 0.5, 0.0));
  EXPECT_THAT(column(outcome, 6), ElementsAre(1.0, -1.0, 1.0));
  EXPECT_THAT(column(outcome, 7), ElementsAre(25.0, 25.0, 25.0));
}

TEST(Cwa, UnpacksTenBitsWithAnExponent) {
  // x = 1, y = -1, z = 128 steps of 1/256 g, shifted by one.
  const std::uint32_t sample = 1U << 30U | 128U << 20U | 1023U << 10U | 1U;
  const Outcome outcome = decode_bytes(cwa_header() + cwa_block({0, 7, 0, 0, 0x30, 0}, 1, word(sample, 4)));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names,
              ElementsAre("time (s)", "acc_x (g)", "acc_y (g)", "acc_z (g)", "temperature (degC)"));
  EXPECT_EQ(column(outcome, 1)[0], 2.0 / 256);
  EXPECT_EQ(column(outcome, 2)[0], -2.0 / 256);
  EXPECT_EQ(column(outcome, 3)[0], 1.0);
}

TEST(Cwa, DeliversTheRateBetweenTheStampsAndLeavesAGapAGap) {
  const std::string data = words_of(std::vector<int>(60, 0));
  // Ten samples nominally take 0.1 s; the stamps, with their fractions, say 0.102 s; then a block is lost.
  const auto fraction = [](double seconds) {
    return static_cast<std::uint16_t>(0x8000 | std::lround(seconds * 32768));
  };
  const std::string file = cwa_header() + cwa_block({0, 7, fraction(0.25)}, 10, data) +
                           cwa_block({1, 7, fraction(0.352), -10}, 10, data) + cwa_block({3, 9}, 10, data);
  const Outcome outcome = decode_bytes(file);
  ASSERT_FALSE(outcome.error) << outcome.message;
  const std::vector<double> time = column(outcome, 0);
  // Of the first block 7.25 s - 25 samples, of the second 7.352 s - (35 - 10) samples: as if fractions were cut off.
  const double second = 0.102;
  constexpr double kFraction = 1.0 / 32768;
  EXPECT_NEAR(time[10], second, kFraction);
  EXPECT_NEAR(time[1], second / 10, kFraction);
  EXPECT_NEAR(time[11] - time[10], 0.01, kTimeTolerance) << "behind a gap of 1.9 s the stated rate holds";
  EXPECT_NEAR(time[20], 2.0, kFraction);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre("The numbers of the blocks show that 1 is missing."));
}

TEST(Cwa, LeavesOutADamagedBlockAndATornOne) {
  const std::string data = words_of({1, 2, 3, 0, 0, 2048});
  std::string damaged = cwa_block({1, 8}, 1, data);
  damaged[40] = '!';
  const Outcome outcome =
      decode_bytes(cwa_header() + cwa_block({0, 7}, 1, data) + damaged + cwa_block({2, 9}, 1, data) + "AX torn");
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 2U);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("1 of 3 blocks is left out: its checksum is wrong"),
                                                 HasSubstr("1 is missing"), HasSubstr("7 bytes into a block")));
}

TEST(Cwa, RefusesAFileWithoutABlock) {
  EXPECT_EQ(decode_bytes(cwa_header().substr(0, 900)).error, ErrorCode::Truncated);
  EXPECT_EQ(decode_bytes(cwa_header()).error, ErrorCode::NoSamples);
  // 41 samples of six axes do not fit into a block; no packing has four axes.
  EXPECT_EQ(decode_bytes(cwa_header() + cwa_block({0, 7}, 41, "")).error, ErrorCode::NoSamples);
  EXPECT_EQ(decode_bytes(cwa_header() + cwa_block({0, 7, 0, 0, 0x42}, 1, "")).error, ErrorCode::NoSamples);
}

TEST(Geneactiv, CalibratesAsTheFilePrescribesAndKeepsTheClockOfThePages) {
  const Outcome outcome = decode_bytes(geneactiv());
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_THAT(outcome.decoded.names,
              ElementsAre("time (s)", "acc_x (g)", "acc_y (g)", "acc_z (g)", "temperature (degC)"));
  EXPECT_THAT(column(outcome, 0), Pointwise(DoubleNear(1e-6), {0.0, 0.01, 0.02}));  // ulp of a date: 2.4e-7 s
  EXPECT_THAT(column(outcome, 1), ElementsAre(1.0, -1.0, 1.0));                     // 0x100 = 256, 0xF00 = -256 steps
  EXPECT_THAT(column(outcome, 2), ElementsAre(0.0, 0.0, 0.0));                      // 0x080 = 128, offset 128
  EXPECT_THAT(column(outcome, 3), ElementsAre(1.0, -1.0, 1.0));                     // a negative gain
  EXPECT_THAT(column(outcome, 4), ElementsAre(21.5, 21.5, 21.5));
  EXPECT_THAT(outcome.decoded.notes, IsEmpty());
}

TEST(Geneactiv, NotesLostPagesAndATornSample) {
  const Outcome outcome =
      decode_bytes(geneactiv() + geneactiv_page(5, "2023-05-09 10:11:13:500", "100080F00000100080F0"));
  ASSERT_FALSE(outcome.error) << outcome.message;
  EXPECT_EQ(outcome.decoded.rows, 4U);
  EXPECT_THAT(outcome.decoded.notes, ElementsAre(HasSubstr("3 are missing"), HasSubstr("within a sample")));
}

TEST(Geneactiv, RefusesWhatItCannotReadByItsLine) {
  const std::string page = geneactiv_page(0, "2023-05-09 10:11:12:500", "100080F00000");
  const std::vector<std::tuple<std::string, ErrorCode, std::string>> cases{
      {geneactiv_header(), ErrorCode::NoSamples, ""},
      {"Device Identity\n" + page, ErrorCode::ShapeMismatch, "11"},
      {geneactiv_header() + "Recorded Data\n100080F00000\n", ErrorCode::ShapeMismatch, "15"},
      {geneactiv_header() + geneactiv_page(0, "soon", "100080F00000"), ErrorCode::NotANumber, "17"},
      {geneactiv_header() + geneactiv_page(0, "2023-05-09 10:11:12:500", "1000xx000000"), ErrorCode::NotANumber, "23"},
      {"Device Identity\nx gain:0\n", ErrorCode::NotANumber, "2"},
  };
  for (const auto& [bytes, code, row] : cases) {
    const Outcome outcome = decode_bytes(bytes);
    EXPECT_EQ(outcome.error, code) << outcome.message;
    EXPECT_EQ(outcome.field("row"), row) << outcome.message;
  }
}

}  // namespace
}  // namespace driftlab
