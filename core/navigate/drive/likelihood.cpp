#include "core/navigate/drive/likelihood.hpp"

#include "core/navigate/drive/profile_parabola.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace driftlab::drive {
namespace {

constexpr double kCap = 9.0;
constexpr double kBegins = 10.0;  ///< [s] after the start

}  // namespace

std::size_t block_at(double time_s) {
  return static_cast<std::size_t>(std::max(std::floor(time_s / kBlockLength), 0.0));
}

std::size_t fold_of_block(std::size_t block) { return block / kFoldBlocks % LogLikelihood::kFolds; }

double LogLikelihood::over(const std::array<bool, kFolds>& used) const {
  double sum = 0.0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    sum += used[fold_of_block(block)] ? blocks[block].log_likelihood : 0.0;
  }
  return sum;
}

double LogLikelihood::mean_square(const std::array<bool, kFolds>& used) const {
  double squared = 0.0;
  double many = 0.0;
  for (std::size_t block = 0; block < blocks.size(); ++block) {
    squared += used[fold_of_block(block)] ? blocks[block].squares : 0.0;
    many += used[fold_of_block(block)] ? blocks[block].count : 0.0;
  }
  return many > 0.0 ? squared / many : 1.0;
}

std::optional<std::size_t> fold_of(const Outage& outage) {
  const std::size_t from = block_at(outage.start_s) / kFoldBlocks;
  const std::size_t to = block_at(outage.end_s()) / kFoldBlocks;
  return from == to ? std::optional(fold_of_block(block_at(outage.start_s))) : std::nullopt;
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
      const std::size_t block = block_at(innovation.time_s);
      result.blocks.resize(std::max(result.blocks.size(), block + 1));
      LogLikelihood::Sums& sums = result.blocks[block];
      for (int k = 0; k < innovation.count; ++k) {
        const ScalarInnovation& scalar = innovation.scalar[static_cast<std::size_t>(k)];
        const double square = std::min(scalar.value * scalar.value / scalar.variance, kCap);
        sums.log_likelihood -= 0.5 * (std::log(scalar.variance) + square);
        sums.squares += square;
        sums.count += 1.0;
      }
    }
  }
  return result;
}

namespace {

/// From one fix to the next: change of velocity, and displacement less integrated velocity.
struct StepOfFixes {
  double time_s;
  double change_along, change_across, gap_along, gap_across;
  /// Sum of squares of what a delay leaves of the gaps.
  [[nodiscard]] double square(double delay_s) const {
    const double along = gap_along - delay_s * change_along;
    const double across = gap_across - delay_s * change_across;
    return along * along + across * across;
  }
};

/// What the scatter of the steps over blocks of time says of the error of the delay that fits them best.
ProfileEstimate error_of_delay(const std::vector<StepOfFixes>& steps, double delay_s, double variance) {
  std::array<ProfilePoint, 3> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ProfilePoint& point = points[i];
    point.at = static_cast<double>(i) - 1.0;  // the likelihood is a parabola: any distance will do
    for (const StepOfFixes& step : steps) {
      point.blocks.resize(std::max(point.blocks.size(), block_at(step.time_s) + 1), 0.0);
      point.blocks[block_at(step.time_s)] -= 0.5 * step.square(delay_s + point.at) / variance;
    }
  }
  return parabola_through(points);
}

}  // namespace

std::optional<FixDelay> delay_from_fixes(const std::vector<Fix>& fixes) {
  std::vector<StepOfFixes> steps;
  for (std::size_t i = 1; i < fixes.size(); ++i) {
    const Fix& a = fixes[i - 1];
    const Fix& b = fixes[i];
    const double step = b.time_s - a.time_s;
    if (!a.velocity_ned_m_s || !b.velocity_ned_m_s || step > 1.6) {
      continue;
    }
    const Vector3 moved = ned_axes(a.position_ecef_m).transpose() * (b.position_ecef_m - a.position_ecef_m);
    const Vector3 gap = moved - 0.5 * step * (*a.velocity_ned_m_s + *b.velocity_ned_m_s);
    const Vector3 change = *b.velocity_ned_m_s - *a.velocity_ned_m_s;
    const Vector3 way = *a.velocity_ned_m_s + *b.velocity_ned_m_s;
    const double length = way.head<2>().norm();
    if (length < 2.0) {
      continue;
    }
    const double x = way.x() / length;
    const double y = way.y() / length;
    steps.push_back({b.time_s, x * change.x() + y * change.y(), x * change.y() - y * change.x(),
                     x * gap.x() + y * gap.y(), x * gap.y() - y * gap.x()});
  }
  if (steps.size() < 50) {
    return std::nullopt;
  }
  // Wild steps are left out of the second pass.
  FixDelay delay;
  double limit = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < 3; ++pass) {
    double ll = 0.0;
    double lg = 0.0;
    double cc = 0.0;
    double cg = 0.0;
    double gg = 0.0;
    std::vector<StepOfFixes> kept;
    for (const StepOfFixes& s : steps) {
      if (std::abs(s.gap_along - delay.delay_s * s.change_along) > limit ||
          std::abs(s.gap_across - delay.delay_s * s.change_across) > limit) {
        continue;
      }
      ll += s.change_along * s.change_along;
      lg += s.change_along * s.gap_along;
      cc += s.change_across * s.change_across;
      cg += s.change_across * s.gap_across;
      gg += s.gap_along * s.gap_along + s.gap_across * s.gap_across;
      kept.push_back(s);
    }
    if (!(ll > 0.0 && cc > 0.0)) {
      return std::nullopt;
    }
    delay.along_s = lg / ll;
    delay.across_s = cg / cc;
    delay.delay_s = (lg + cg) / (ll + cc);
    const double rest = std::max(gg - delay.delay_s * (lg + cg), 1e-12);
    const double variance = rest / static_cast<double>(2 * kept.size());
    delay.se_s = error_of_delay(kept, delay.delay_s, variance).se;
    delay.score = 0.5 * delay.delay_s * delay.delay_s / (delay.se_s * delay.se_s);
    delay.steps = kept.size();
    limit = 4.0 * std::sqrt(variance);
  }
  return delay;
}

}  // namespace driftlab::drive
