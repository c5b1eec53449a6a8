/// What recordings of one device say together, and that those of several say nothing together.
#include "core/analysis/characterise_campaign.hpp"

#include "core/process/model.hpp"
#include "core/process/random.hpp"
#include "tests/unit/analysis/file_source.hpp"

#include <gtest/gtest.h>

#include <stop_token>

namespace driftlab {
namespace {

/// Twenty seconds at 100 Hz of white noise, 0.02 deg/s/sqrt(Hz), about y and z.
std::string two_axes(std::uint64_t stream) {
  Random random(1408, stream);
  const Model model{*make_process("white_noise", {0.02})};
  const std::vector<double> y = simulate(model, random, 0.01, 2000);
  const std::vector<double> z = simulate(model, random, 0.01, 2000);
  std::string text = "gy,gz\n";
  for (std::size_t i = 0; i < y.size(); ++i) {
    text += std::to_string(y[i]) + "," + std::to_string(z[i]) + "\n";
  }
  return text;
}

RecordingSpec named(const std::string& id) {
  RecordingSpec spec;
  spec.id = id;
  spec.rate_hz = 100.0;
  for (const std::string axis : {"y", "z"}) {
    spec.columns["g" + axis] = {Quantity::AngularRate, axis, *parse_unit("deg/s")};
  }
  return spec;
}

CharacteriseOptions white_noise_only() {
  CharacteriseOptions options;
  options.models = {"WN"};
  return options;
}

TEST(CharacteriseCampaign, PoolsTheAxesOfOneDeviceUnderTheNamesOfTheirResults) {
  FileSource source;
  source.add(named("monday"), two_axes(1));
  source.add(named("tuesday"), two_axes(2));
  std::vector<std::string> asked;
  const auto found =
      characterise_campaign(source, white_noise_only(), {}, [&](const auto& recording, const auto& column) {
        asked.push_back(recording + "/" + column);
        return "chr_" + asked.back();
      });
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->recordings.size(), 2);
  EXPECT_EQ(asked, (std::vector<std::string>{"monday/gy", "monday/gz", "tuesday/gy", "tuesday/gz"}))
      << "in the order of the recordings, as rows are stored";
  ASSERT_EQ(found->together.replicates.size(), 2);
  ASSERT_FALSE(found->together.trends.empty());
  EXPECT_EQ(found->together.trends.front().device, "imu-07");
}

TEST(CharacteriseCampaign, RecordingsOfTwoDevicesSayNothingTogether) {
  FileSource source;
  source.add(named("monday"), two_axes(1), "imu-07");
  source.add(named("tuesday"), two_axes(2), "imu-08");
  const auto found = characterise_campaign(source, white_noise_only(), {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->recordings.size(), 2);
  EXPECT_TRUE(found->together.replicates.empty());
  EXPECT_TRUE(found->together.trends.empty());
}

TEST(CharacteriseCampaign, ProgressNeverFallsAndAStopIsCancelled) {
  FileSource source;
  source.add(named("monday"), two_axes(1));
  source.add(named("tuesday"), two_axes(2));
  double last = 0.0;
  bool fell = false;
  std::stop_source stop;
  const RunControl watched{stop.get_token(), [&](std::string_view, double fraction) {
                             fell = fell || fraction < last;
                             last = fraction;
                           }};
  ASSERT_TRUE(characterise_campaign(source, white_noise_only(), watched));
  EXPECT_FALSE(fell);
  EXPECT_GE(last, 0.9);
  stop.request_stop();
  const auto stopped = characterise_campaign(source, white_noise_only(), watched);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::Cancelled);
}

}  // namespace
}  // namespace driftlab
