#include "core/investigate/search/take_switching.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace driftlab::investigate {
namespace {

void leave_out_changes(const std::vector<double>& course, const StudyRecording& recording,
                       std::vector<unsigned char>& mask) {
  // Of the greatest expected level: nearer to zero the side is not sure. Chosen, not measured.
  constexpr double kSure = 0.9;
  constexpr double kAbout = 0.5;  // [s]
  const auto about = static_cast<std::size_t>(kAbout / recording.dt_s) + 1;
  double top = 0.0;
  for (const double v : course) {
    top = std::max(top, std::fabs(v));
  }
  mask.resize(recording.length, 0);
  for (std::size_t i = 1; i < course.size(); ++i) {
    const bool changes = course[i] * course[i - 1] < 0.0;
    const bool unsure = std::fabs(course[i]) < kSure * top;
    const std::size_t reach = changes ? about : unsure ? 1 : 0;
    for (std::size_t k = i > reach ? i - reach : 0; reach > 0 && k < std::min(course.size(), i + reach); ++k) {
      mask[recording.begin + k] = 1;
    }
  }
}

}  // namespace

void take_switching(const FullRate& data, std::vector<Series>& error, std::vector<std::vector<unsigned char>>& mask,
                    std::vector<Evidence>& found) {
  for (const Cause& cause : cause_registry()) {
    const SwitchingNoise* const noise = cause.as<SwitchingNoise>();
    std::optional<Evidence> evidence = noise != nullptr ? noise->find(data) : std::nullopt;
    if (!evidence) {
      continue;
    }
    evidence->cause = &cause;
    for (const std::size_t r : evidence->members) {
      const StudyRecording& recording = *data.group->members[r].recording;
      const std::vector<double> course = noise->values(data, r, *evidence);
      std::vector<double> rest = error[r].values();
      for (std::size_t i = 0; i < course.size(); ++i) {
        rest[recording.begin + i] -= course[i];
      }
      error[r] = std::move(rest);
      leave_out_changes(course, recording, mask[r]);
    }
    found.push_back(*std::move(evidence));
    return;  // what is left is to be searched anew first
  }
}

}  // namespace driftlab::investigate
