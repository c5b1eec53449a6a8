/// square_wave: a square wave of 40 s that begins with the recording. It exists to be added by tests/house/recipes_test.py.
#include "core/investigate/causes/cause.hpp"
#include "core/investigate/causes/draft.hpp"
#include "core/investigate/causes/units.hpp"

#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr double kPeriod_s = 40.0;

bool build(const StudyRecording& recording, const ChannelGroup& /*group*/, double /*shape*/,
           std::vector<std::vector<double>>& columns) {
  columns.assign(1, std::vector<double>(recording.length));
  for (std::size_t i = 0; i < recording.length; ++i) {
    columns[0][i] = std::fmod(recording.time_s(i), kPeriod_s) < 0.5 * kPeriod_s ? 1.0 : -1.0;
  }
  return true;
}

/// Up at 1 s, down at 21 s, up again at 41 s.
std::vector<Figure> law(const Draft& before, const Draft& after, std::span<const double> values) {
  std::vector<Figure> figures;
  for (const auto& [time_s, sign] : {std::pair{1.0, 1.0}, std::pair{21.0, -1.0}, std::pair{41.0, 1.0}}) {
    const auto i = static_cast<std::size_t>(std::lround(time_s / before.recording->dt_s));
    figures.push_back({"at " + std::to_string(time_s) + " s", after.mean[i] - before.mean[i], sign * values[0],
                       1e-9 * std::fabs(values[0])});
  }
  return figures;
}

}  // namespace

Cause square_wave() {
  return {.name = "square_wave",
          .title = "a square wave",
          .equation = "y = amplitude in the first half of every 40 s and y = −amplitude in the second",
          .family = MeanEffect{.build = build},
          .rivals = {"periodic_disturbance"},
          .needs = "a minute",
          .separates = "nothing",
          .parameters = {{"amplitude", units::level}},
          .showing = {.law = law}};
}

}  // namespace driftlab::investigate
