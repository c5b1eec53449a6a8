#include "core/navigate/drive/likelihood.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kCap = 9.0;
constexpr double kBegins = 10.0;  ///< [s] after the start

}  // namespace

double LogLikelihood::over(const std::array<bool, kFolds>& used) const {
  return (used[0] ? sum[0] : 0.0) + (used[1] ? sum[1] : 0.0);
}

double LogLikelihood::mean_square(const std::array<bool, kFolds>& used) const {
  const double squared = (used[0] ? squares[0] : 0.0) + (used[1] ? squares[1] : 0.0);
  const double many = (used[0] ? count[0] : 0.0) + (used[1] ? count[1] : 0.0);
  return many > 0.0 ? squared / many : 1.0;
}

std::size_t fold_at(double time_s) {
  return static_cast<std::size_t>(std::max(std::floor(time_s / kFoldLength), 0.0)) % LogLikelihood::kFolds;
}

std::optional<std::size_t> fold_of(const Outage& outage) {
  const bool whole = std::floor(outage.start_s / kFoldLength) == std::floor(outage.end_s() / kFoldLength);
  return whole ? std::optional(fold_at(outage.start_s)) : std::nullopt;
}

Result<LogLikelihood> log_likelihood(const Drive& drive, const FilterOptions& options) {
  auto prepared = PreparedDrive::make(drive, options);
  if (!prepared) {
    return fail(prepared.error());
  }
  LogLikelihood result;
  for (std::size_t part = 0; part < prepared->parts(); ++part) {
    FilterTask task;
    task.keep_innovations = true;
    const FilterRun run = prepared->run(part, task);
    for (const Innovation& innovation : run.innovations) {
      if (!innovation.accepted || innovation.time_s < prepared->start(part).time_s + kBegins) {
        continue;
      }
      const std::size_t fold = fold_at(innovation.time_s);
      for (int k = 0; k < innovation.count; ++k) {
        const ScalarInnovation& scalar = innovation.scalar[static_cast<std::size_t>(k)];
        const double square = std::min(scalar.value * scalar.value / scalar.variance, kCap);
        result.sum[fold] -= 0.5 * (std::log(scalar.variance) + square);
        result.squares[fold] += square;
        result.count[fold] += 1.0;
      }
    }
  }
  return result;
}

std::optional<FixDelay> delay_from_fixes(const std::vector<Fix>& fixes) {
  struct StepOfFixes {
    double change_along, change_across, gap_along, gap_across, wide_along, wide_across;  // wide: the instrument
  };
  std::vector<StepOfFixes> steps;
  for (std::size_t i = 2; i + 1 < fixes.size(); ++i) {
    const Fix& before = fixes[i - 2];
    const Fix& a = fixes[i - 1];
    const Fix& b = fixes[i];
    const Fix& after = fixes[i + 1];
    const double step = b.time_s - a.time_s;
    if (!before.velocity_ned_m_s || !a.velocity_ned_m_s || !b.velocity_ned_m_s || !after.velocity_ned_m_s ||
        after.time_s - before.time_s > 4.8) {
      continue;
    }
    const Vector3 moved = ned_axes(a.position_ecef_m).transpose() * (b.position_ecef_m - a.position_ecef_m);
    const Vector3 gap = moved - 0.5 * step * (*a.velocity_ned_m_s + *b.velocity_ned_m_s);
    const Vector3 change = *b.velocity_ned_m_s - *a.velocity_ned_m_s;
    const Vector3 wide = *after.velocity_ned_m_s - *before.velocity_ned_m_s;
    const Vector3 way = *a.velocity_ned_m_s + *b.velocity_ned_m_s;
    const double length = way.head<2>().norm();
    if (length < 2.0) {
      continue;
    }
    const double x = way.x() / length;
    const double y = way.y() / length;
    const auto along = [&](const Vector3& v) { return x * v.x() + y * v.y(); };
    const auto across = [&](const Vector3& v) { return x * v.y() - y * v.x(); };
    steps.push_back({along(change), across(change), along(gap), across(gap), along(wide), across(wide)});
  }
  if (steps.size() < 50) {
    return std::nullopt;
  }
  // Wild steps are left out of the second pass.
  FixDelay delay;
  double limit = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 3; ++pass) {
    double lw = 0.0;
    double gw = 0.0;
    double lw_across = 0.0;
    double gw_across = 0.0;
    double ww = 0.0;
    double count = 0.0;
    for (const StepOfFixes& s : steps) {
      if (std::abs(s.gap_along - delay.delay_s * s.change_along) > limit ||
          std::abs(s.gap_across - delay.delay_s * s.change_across) > limit) {
        continue;
      }
      lw += s.change_along * s.wide_along;
      gw += s.gap_along * s.wide_along;
      lw_across += s.change_across * s.wide_across;
      gw_across += s.gap_across * s.wide_across;
      ww += s.wide_along * s.wide_along + s.wide_across * s.wide_across;
      count += 2.0;
    }
    if (!(lw > 0.0 && lw_across > 0.0)) {
      return std::nullopt;
    }
    delay.along_s = gw / lw;
    delay.across_s = gw_across / lw_across;
    delay.delay_s = (gw + gw_across) / (lw + lw_across);
    double rest = 0.0;
    for (const StepOfFixes& s : steps) {
      const double of_along = s.gap_along - delay.delay_s * s.change_along;
      const double of_across = s.gap_across - delay.delay_s * s.change_across;
      if (std::max(std::abs(of_along), std::abs(of_across)) <= limit) {
        rest += of_along * of_along + of_across * of_across;
      }
    }
    const double variance = std::max(rest, 1e-12) / count;
    // As innovations: their correlation triples the variance.
    delay.se_s = std::sqrt(3.0 * variance * ww) / (lw + lw_across);
    delay.score = 0.5 * delay.delay_s * delay.delay_s / (delay.se_s * delay.se_s);
    delay.steps = static_cast<std::size_t>(count / 2.0);
    limit = 4.0 * std::sqrt(variance);
  }
  return delay;
}

}  // namespace driftlab::drive
