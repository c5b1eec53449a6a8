/// timestamp_jitter: the stamps scatter around the uniform grid by more than 0.2 % of the interval and their own
/// resolution.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"
#include "core/investigate/study/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Of the sample interval; or 0.3 of the resolution of the stamps, whose rounding scatters by 0.29 of it. Chosen, not
/// measured.
constexpr double kNoticed = 0.002;

std::vector<Evidence> find(const ChannelGroup& group, const std::stop_token& /*stop*/) {
  Evidence evidence;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const StudyRecording& recording = *group.members[r].recording;
    const Stamps& stamps = recording.stamps;
    const double noticed = std::max(kNoticed * recording.dt_s, 0.3 * stamps.resolution_s);
    if (stamps.present && stamps.scatter_s > noticed) {
      const auto rows = static_cast<double>(recording.length - stamps.missing);
      evidence.members.push_back(r);
      square += stamps.scatter_s * stamps.scatter_s * rows;
      count += rows;
    }
  }
  if (evidence.members.empty()) {
    return {};
  }
  const double sigma = std::sqrt(square / count);
  const double sd = sigma / std::sqrt(2.0 * count);
  evidence.gain = evidence.score = 1000.0 + count;
  evidence.parameters = {{"sigma_s", {sigma, {sigma - 1.96 * sd, sigma + 1.96 * sd}}, units::seconds(group.unit)}};
  return {evidence};
}

void inject_effect(Draft& draft, std::span<const double> values, Random& random) {
  draft.stamp_error_s.resize(draft.white.size());
  for (double& v : draft.stamp_error_s) {
    v = values[0] * random.normal();
  }
}

std::vector<double> shown_values(const Stage& stage, Random& /*random*/) { return {0.003 * stage.z * stage.dt_s()}; }

}  // namespace

Cause timestamp_jitter() {
  return {.name = "timestamp_jitter",
          .title = "time stamps that scatter around the uniform grid",
          .equation = "t(k) = t(0) + k Δt + ε(k), ε independent with standard deviation σ",
          .family = FileFact{.find = find},
          .rivals = {"acceleration_dependent_noise"},
          .needs = "a time column",
          .separates = "stamps from the sensor's own data-ready line",
          .parameters = {{"sigma_s", units::seconds}},
          .lacks = lacks_stamps,
          .inject = inject_effect,
          .showing = {.values = shown_values}};
}

}  // namespace driftlab::investigate
