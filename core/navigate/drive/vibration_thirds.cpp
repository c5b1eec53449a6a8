#include "core/navigate/drive/vibration_thirds.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace driftlab::drive {
namespace {

constexpr std::size_t kFewestOutages = 9;
constexpr std::size_t kGyroscopes = 3;

/// The vibration of all runs together, so that one may be shaken more than another.
class WholeDrive {
 public:
  explicit WholeDrive(const Drive& drive) : drive_(drive) {
    std::vector<ImuSample> readings;
    for (const UniformRun& run : drive.runs) {
      first_of_run_.push_back(readings.size());
      readings.insert(readings.end(), run.readings.begin(), run.readings.end());
    }
    vibration_ = Vibration(readings, drive.runs.front().dt_s);
  }

  /// Mean power of the gyroscopes in an outage; nothing outside the readings.
  [[nodiscard]] std::optional<double> in(const Outage& outage) const {
    for (std::size_t r = 0; r < drive_.runs.size(); ++r) {
      const UniformRun& run = drive_.runs[r];
      if (outage.start_s < run.start_s || outage.start_s >= run.end_s()) {
        continue;
      }
      const auto reading_at = [&](double time_s) {
        const auto since = static_cast<std::size_t>((time_s - run.start_s) / run.dt_s);
        return first_of_run_[r] + std::min(since, run.readings.size() - 1);
      };
      double sum = 0.0;
      double blocks = 0.0;
      const std::size_t last = reading_at(outage.end_s());
      for (std::size_t i = reading_at(outage.start_s); i <= last; i = vibration_.next_block(i)) {
        for (std::size_t c = 0; c < kGyroscopes; ++c) {
          sum += vibration_.at(i)[c] / static_cast<double>(kGyroscopes);
        }
        blocks += 1.0;
      }
      return sum / blocks;
    }
    return std::nullopt;
  }

 private:
  const Drive& drive_;
  std::vector<std::size_t> first_of_run_;
  Vibration vibration_;
};

}  // namespace

std::optional<VibrationThirds> errors_by_vibration(const Drive& drive, const DurationSummary& outages) {
  const WholeDrive whole(drive);
  std::vector<std::pair<double, double>> power_and_error;
  for (const DriveOutage& outage : outages.outages) {
    if (const auto power = whole.in(outage.outage)) {
      power_and_error.emplace_back(*power, outage.error_m());
    }
  }
  const std::size_t many = power_and_error.size();
  if (many < kFewestOutages) {
    return std::nullopt;
  }
  std::sort(power_and_error.begin(), power_and_error.end());
  VibrationThirds thirds;
  thirds.duration_s = outages.duration_s;
  for (std::size_t third = 0; third < 3; ++third) {
    const std::size_t first = third * many / 3;
    const std::size_t last = (third + 1) * many / 3;
    thirds.count[third] = last - first;
    const auto share = 1.0 / static_cast<double>(last - first);
    for (std::size_t i = first; i < last; ++i) {
      thirds.power[third] += share * power_and_error[i].first;
      thirds.rms_m[third] += share * power_and_error[i].second * power_and_error[i].second;
    }
    thirds.rms_m[third] = std::sqrt(thirds.rms_m[third]);
  }
  return thirds;
}

}  // namespace driftlab::drive
