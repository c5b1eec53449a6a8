/// A channel looked at before any model: its spectrum, its values, its spectrum over time.
#include "core/analysis/channel_look.hpp"

#include "core/process/random.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kRateHz = 100.0;
constexpr std::size_t kRows = 8192;

RecordingSpec gyroscope_z() {
  RecordingSpec spec;
  spec.id = "bench";
  spec.rate_hz = kRateHz;
  spec.columns["gz"] = {Quantity::AngularRate, "z", *parse_unit("deg/s")};
  return spec;
}

template <class Value>
std::string csv(const Value& value) {
  Random random(2214);
  std::string text = "gz\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    text += std::to_string(value(i, random.normal())) + "\n";
  }
  return text;
}

TEST(ChannelLook, WhiteNoiseHasItsDensityAndALineStandsAtItsFrequency) {
  // Standard deviation 2 deg/s at 100 Hz: two-sided density 4/100; the line of 3 deg/s at 12.5 Hz lies in one bin.
  FileSource source;
  source.add(gyroscope_z(), csv([](std::size_t i, double noise) {
               return 2.0 * noise + 3.0 * std::sin(2.0 * std::numbers::pi * 12.5 * static_cast<double>(i) / kRateHz);
             }));
  const auto look = ChannelLook::open(source, "gz");
  ASSERT_TRUE(look) << look.error().message;
  EXPECT_EQ(look->samples(), kRows);
  EXPECT_EQ(look->unit().symbol, "deg/s");
  const auto found = look->spectrum(FrequencyScale::Linear, 50);
  ASSERT_TRUE(found);
  const auto top = std::max_element(found->greatest.begin(), found->greatest.end()) - found->greatest.begin();
  EXPECT_NEAR(found->frequency_hz[static_cast<std::size_t>(top)], 12.5, 0.5) << "bins are 1 Hz wide";
  std::vector<double> density = found->density;
  std::nth_element(density.begin(), density.begin() + 25, density.end());
  EXPECT_NEAR(density[25], 0.04, 0.003) << "a bin holds 80 ordinates of ten degrees of freedom: 5 %, its median less";
}

TEST(ChannelLook, TheRatioToTheModelIsOneWhereItHoldsAndRisesWhereTheNoiseDoes) {
  // The noise doubles in the second half: density over that of the first half's model is 1, then 4.
  FileSource source;
  source.add(gyroscope_z(), csv([](std::size_t i, double noise) { return (i < kRows / 2 ? 1.0 : 2.0) * noise; }));
  const auto look = ChannelLook::open(source, "gz");
  ASSERT_TRUE(look) << look.error().message;
  const double degree = std::numbers::pi / 180.0;
  const Model model{*make_process("white_noise", {degree / std::sqrt(kRateHz)})};
  const auto ratio = look->ratio(&model, 8, 6);
  ASSERT_TRUE(ratio) << ratio.error().message;
  EXPECT_TRUE(ratio->of_model);
  const std::size_t bands = ratio->spectrogram.frequency_hz.size();
  const auto mean_over = [&](std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from * bands; i < to * bands; ++i) {
      sum += ratio->spectrogram.density[i];
    }
    return sum / static_cast<double>((to - from) * bands);
  };
  const std::size_t cells = ratio->spectrogram.time_s.size();
  ASSERT_EQ(cells, 8);
  EXPECT_NEAR(mean_over(0, cells / 2), 1.0, 0.3);
  EXPECT_NEAR(mean_over(cells / 2, cells), 4.0, 1.2);
}

TEST(ChannelLook, LooksAtTheLongestRunAndBeginsAfterWhatIsMissing) {
  // A second is missing after the first 3000 rows: the longer run begins at 31 s, not at 30.
  RecordingSpec spec = gyroscope_z();
  spec.rate_hz.reset();
  spec.columns["t"] = {Quantity::Time, "", *parse_unit("s")};
  Random random(2215);
  std::string text = "t,gz\n";
  for (std::size_t i = 0; i < kRows; ++i) {
    const double time = static_cast<double>(i) / kRateHz + (i < 3000 ? 0.0 : 1.0);
    text += std::to_string(time) + "," + std::to_string(random.normal()) + "\n";
  }
  FileSource source;
  source.add(spec, text);
  const auto look = ChannelLook::open(source, "gz");
  ASSERT_TRUE(look) << look.error().message;
  EXPECT_EQ(look->samples(), kRows - 3000);
  EXPECT_NEAR(look->first_s(), 31.0, 1e-6);
}

TEST(ChannelLook, GrossErrorsDoNotWidenTheHistogram) {
  FileSource source;
  source.add(gyroscope_z(), csv([](std::size_t i, double noise) { return i % 500 == 7 ? 50.0 : noise; }));
  const auto look = ChannelLook::open(source, "gz");
  ASSERT_TRUE(look) << look.error().message;
  const auto histogram = look->histogram(40);
  ASSERT_TRUE(histogram);
  EXPECT_NEAR(histogram->sigma, 1.0, 0.05);
  EXPECT_EQ(histogram->above, (kRows + 492) / 500);
}

TEST(ChannelLook, RefusesAColumnThatIsNoSensor) {
  FileSource source;
  source.add(gyroscope_z(), csv([](std::size_t /*row*/, double noise) { return noise; }));
  const auto look = ChannelLook::open(source, "temperature");
  ASSERT_FALSE(look);
  EXPECT_EQ(look.error().code, ErrorCode::UnknownColumn);
}

}  // namespace
}  // namespace driftlab
