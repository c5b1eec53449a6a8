#include "core/campaign/regression/time_base.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace driftlab::regression {
namespace {

constexpr std::size_t kFewestAxes = 3;
constexpr double kLeastShift = 0.03;  // [ln deviation]
constexpr double kAlike = 1.0 / 3.0;  // of the mean shift

/// Mean difference of each unit's scales to `through_s` [ln deviation].
std::vector<double> shifts_of(const std::vector<UnitReport>& units, double through_s) {
  std::vector<double> shifts;
  for (const UnitReport& unit : units) {
    double sum = 0.0;
    double count = 0.0;
    for (const ScaleReport& test : unit.tests) {
      if (test.name.empty() && test.test.tau_s <= through_s) {
        sum += test.theta;
        ++count;
      }
    }
    if (count > 0.0) {
      shifts.push_back(sum / count);
    }
  }
  return shifts;
}

}  // namespace

EventCheck check_time_base(const std::vector<UnitReport>& units, double through_s) {
  EventCheck check{"time_base", CheckVerdict::Ok, "", {}, std::nullopt};
  const std::vector<double> shifts = shifts_of(units, through_s);
  if (shifts.size() < kFewestAxes) {
    return check;
  }
  const double mean = std::accumulate(shifts.begin(), shifts.end(), 0.0) / static_cast<double>(shifts.size());
  const bool alike = std::all_of(shifts.begin(), shifts.end(),
                                 [&](double shift) { return std::abs(shift - mean) < kAlike * std::abs(mean); });
  if (alike && std::abs(mean) > kLeastShift) {
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
