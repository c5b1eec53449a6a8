/// wheel_slip: the wheel of the odometer slips or locks, in bursts. Its readings there are used by no filter.
#include "core/navigate/drive/causes/cause.hpp"
#include "core/navigate/drive/likelihood.hpp"
#include "core/signal/median.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kMoving = 3.0;          ///< [m/s]
constexpr double kWidestStep = 1.6;      ///< [s] between two fixes
constexpr double kRobustSd = 5.0;        ///< beyond so many a reading is no noise
constexpr double kLeastSlip = 0.5;       ///< [m/s]
constexpr double kShortestSlip = 0.3;    ///< [s]
constexpr double kJoined = 0.5;          ///< [s] between two parts of one slip
constexpr double kNormalOfMad = 1.4826;  ///< standard deviations in one median absolute deviation
constexpr std::size_t kLeastReadings = 50;

struct Compared {
  double time_s, odometer_m_s, speed_m_s;
};

/// Readings of the odometer beside the speed over ground, linear between fixes.
std::vector<Compared> compared(const Drive& drive, double velocity_latency_s) {
  std::vector<Compared> list;
  std::size_t fix = 1;
  for (const OdometerReading& reading : drive.odometer) {
    const double at = reading.time_s + velocity_latency_s;  // the stamp of a velocity that describes this moment
    while (fix + 1 < drive.fixes.size() && drive.fixes[fix].time_s < at) {
      ++fix;
    }
    const Fix& a = drive.fixes[fix - 1];
    const Fix& b = drive.fixes[fix];
    const double step = b.time_s - a.time_s;
    if (at < a.time_s || at > b.time_s || step > kWidestStep || !a.velocity_ned_m_s || !b.velocity_ned_m_s) {
      continue;
    }
    const double u = (at - a.time_s) / step;
    const Vector3 velocity = (1.0 - u) * *a.velocity_ned_m_s + u * *b.velocity_ned_m_s;
    list.push_back({reading.time_s, std::abs(reading.speed_m_s), velocity.head<2>().norm()});
  }
  return list;
}

}  // namespace

double WheelSlips::seconds() const {
  double sum = 0.0;
  for (const auto& slip : slips) {
    sum += slip[1] - slip[0];
  }
  return sum;
}

std::optional<WheelSlips> slips_of(const Drive& drive, double velocity_latency_s) {
  if (drive.fixes.size() < 2) {
    return std::nullopt;
  }
  const std::vector<Compared> all = compared(drive, velocity_latency_s);
  std::vector<double> ratios;
  for (const Compared& one : all) {
    if (one.speed_m_s > kMoving) {
      ratios.push_back(one.odometer_m_s / one.speed_m_s);
    }
  }
  if (ratios.size() < kLeastReadings) {
    return std::nullopt;
  }
  WheelSlips found;
  found.scale = take_median(ratios) - 1.0;
  std::vector<double> off;
  for (const Compared& one : all) {
    off.push_back(std::abs(one.odometer_m_s - (1.0 + found.scale) * one.speed_m_s));
  }
  std::vector<double> by_size = off;
  found.sd_m_s = kNormalOfMad * take_median(by_size);
  const double limit = std::max(kRobustSd * found.sd_m_s, kLeastSlip);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (off[i] <= limit) {
      continue;
    }
    if (!found.slips.empty() && all[i].time_s - found.slips.back()[1] <= kJoined) {
      found.slips.back()[1] = all[i].time_s;
    } else {
      found.slips.push_back({all[i].time_s, all[i].time_s});
    }
  }
  std::erase_if(found.slips, [](const auto& slip) { return slip[1] - slip[0] < kShortestSlip; });
  for (auto& slip : found.slips) {  // a slip begins and ends between two readings
    slip = {slip[0] - kShortestSlip, slip[1] + kShortestSlip};
  }
  return found;
}

namespace {

std::optional<FromFiles> slips_in_files(const Drive& drive, const FilterOptions& options) {
  const auto found = slips_of(drive, options.velocity_latency_s);
  if (!found || found->slips.empty()) {
    return std::nullopt;
  }
  DriveFinding finding;
  finding.parameter = "seconds";
  finding.title = "the wheel of the odometer slips or locks, " + how_often(found->slips.size()) + ", in all";
  finding.unit = "s";
  finding.value = found->seconds();
  // Each reading of a slip is five standard deviations off and more: 12 nats in half of its square.
  finding.score = 12.5 * static_cast<double>(found->slips.size());
  finding.evidence = "odometer and fixes";
  finding.told_apart = "bursts; a scale factor of the odometer is the same everywhere";
  return FromFiles{std::move(finding), [slips = found->slips](FilterOptions& told) { told.slips = slips; }, true};
}

}  // namespace

Cause wheel_slip() {
  return {.name = "wheel_slip", .words = "slips of the odometer's wheel", .from_files = slips_in_files};
}

}  // namespace driftlab::drive
