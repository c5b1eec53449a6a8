#include "core/campaign/regression/time_base.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace driftlab::regression {
namespace {

constexpr std::size_t kFewestAxes = 3;
constexpr double kLeastShift = 0.03;        // [ln deviation]
constexpr double kMostShift = 0.12;         // a clock is wrong by a quarter at most
constexpr double kAlike = 1.0 / 3.0;        // of the mean shift: how far that of an axis may be from it,
constexpr double kScalesAlike = 2.0 / 3.0;  // and that of one scale, which chance moves more

/// The differences of all scales to `through_s` [ln deviation], by unit.
std::vector<std::vector<double>> shifts_of(const std::vector<UnitReport>& units, double through_s) {
  std::vector<std::vector<double>> shifts;
  for (const UnitReport& unit : units) {
    std::vector<double> own;
    for (const ScaleReport& test : unit.tests) {
      if (test.name.empty() && test.test.tau_s <= through_s) {
        own.push_back(test.theta);
      }
    }
    if (!own.empty()) {
      shifts.push_back(std::move(own));
    }
  }
  return shifts;
}

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

EventCheck check_time_base(const std::vector<UnitReport>& units, double through_s, bool stamped) {
  EventCheck check{"time_base", CheckVerdict::Ok, "", {}, std::nullopt};
  const auto shifts = shifts_of(units, through_s);
  if (stamped || shifts.size() < kFewestAxes) {
    return check;
  }
  std::vector<double> means;
  for (const std::vector<double>& own : shifts) {
    means.push_back(mean_of(own));
  }
  const double mean = mean_of(means);
  const auto within = [mean](double part) {
    return [mean, part](double shift) { return std::abs(shift - mean) < part * std::abs(mean); };
  };
  // A clock moves every scale of white noise by one factor; a filter, a line or a new process moves some.
  const bool alike = std::all_of(means.begin(), means.end(), within(kAlike)) &&
                     std::all_of(shifts.begin(), shifts.end(), [&](const std::vector<double>& own) {
                       return std::all_of(own.begin(), own.end(), within(kScalesAlike));
                     });
  if (alike && std::abs(mean) > kLeastShift && std::abs(mean) < kMostShift) {
    std::array<char, 128> sentence{};
    (void)std::snprintf(sentence.data(), sentence.size(),
                        "All axes move by one factor, as a clock %.0f %% %s would; stamp the samples.",
                        std::abs(100.0 * std::expm1(2.0 * mean)), mean > 0.0 ? "fast" : "slow");
    check.verdict = CheckVerdict::Note;
    check.sentence = sentence.data();
  }
  return check;
}

}  // namespace driftlab::regression
