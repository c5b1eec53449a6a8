#pragma once
/// Innovations and residuals made by hand, as look_at_full_rate would give them: what the suites of the full-rate part
/// start from, so that each tests one file.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/process/random.hpp"

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// A group of static recordings "r0", "r1", ... of one gyroscope axis "gz", and what is known of them at full rate. Not
/// to be copied or moved: the parts point at each other.
struct NoiseAtFullRate {
  explicit NoiseAtFullRate(std::vector<std::vector<double>> values, double dt_s = 0.02) {
    for (std::size_t r = 0; r < values.size(); ++r) {
      StudyRecording& recording = recordings.emplace_back();
      recording.id = "r" + std::to_string(r);
      recording.condition.kind = ConditionKind::Static;
      recording.dt_s = dt_s;
      recording.length = values[r].size();
      recording.end = values[r].size();
      channels.emplace_back().column = "gz";
    }
    group.column = "gz";
    group.role = {Quantity::AngularRate, "z", parse_unit("rad/s").value()};
    group.unit = parse_unit("rad/s").value();
    data.group = &group;
    data.dt_s = dt_s;
    for (std::size_t r = 0; r < values.size(); ++r) {
      group.members.push_back({&recordings[r], &channels[r]});
      data.used.emplace_back(values[r].size(), static_cast<unsigned char>(1));
      data.spectrum.push_back(estimate_spectrum(values[r], dt_s, 0.3));
    }
    data.residual.assign(values.begin(), values.end());
    data.innovation = data.residual;
  }
  NoiseAtFullRate(const NoiseAtFullRate&) = delete;
  NoiseAtFullRate& operator=(const NoiseAtFullRate&) = delete;
  ~NoiseAtFullRate() = default;

  std::deque<StudyRecording> recordings;
  std::deque<Channel> channels;
  ChannelGroup group;
  FullRate data;
};

/// Standard normal numbers.
[[nodiscard]] inline std::vector<double> white(std::size_t count, std::uint64_t seed, std::uint64_t stream = 0) {
  Random random(seed, stream);
  std::vector<double> values(count);
  for (double& value : values) {
    value = random.normal();
  }
  return values;
}

}  // namespace driftlab::investigate
