#include "core/signal/spacing.hpp"

#include "core/signal/gap_sizes.hpp"
#include "core/signal/sample_grid.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

/// Samples that share one stamp.
struct Group {
  std::size_t first = 0;
  std::size_t count = 1;
};

/// The element below which a fraction `p` of `values` lies, 0 of none; reorders them. O(n).
double quantile(std::vector<double>& values, double p) {
  if (values.empty()) {
    return 0.0;
  }
  const auto index = static_cast<std::ptrdiff_t>(p * static_cast<double>(values.size()));
  const auto at = values.begin() + std::min(index, static_cast<std::ptrdiff_t>(values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

std::vector<Group> group_by_stamp(std::span<const double> stamps) {
  std::vector<Group> groups{{0, 1}};
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] == stamps[i - 1]) {
      ++groups.back().count;
    } else {
      groups.push_back({i, 1});
    }
  }
  return groups;
}

/// Median over the advancing steps of step per sample, 0 if none advances. Between groups of a and b samples lie
/// (a + b)/2 sample intervals on average, so repeated stamps (coarse clocks, FIFOs stamped at once) do not bias it.
double median_interval(std::span<const double> stamps, const std::vector<Group>& groups) {
  std::vector<double> intervals;
  intervals.reserve(groups.size());
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const double step = stamps[groups[g].first] - stamps[groups[g - 1].first];
    if (step > 0.0) {
      intervals.push_back(step / (0.5 * static_cast<double>(groups[g - 1].count + groups[g].count)));
    }
  }
  return quantile(intervals, 0.5);
}

/// The rows before which samples are missing: a step is a gap if it exceeds what the samples of both its groups can
/// span, a + b - 1 intervals, by more than half an interval. Without repeated stamps that is 1.5 intervals.
std::vector<std::size_t> find_long_steps(std::span<const double> stamps, const std::vector<Group>& groups,
                                         double interval_s) {
  std::vector<std::size_t> gaps;
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const double step = stamps[groups[g].first] - stamps[groups[g - 1].first];
    if (step > (static_cast<double>(groups[g - 1].count + groups[g].count) - 0.5) * interval_s) {
      gaps.push_back(groups[g].first);
    }
  }
  return gaps;
}

/// Every step forward of the stamps.
std::vector<double> forward_steps(std::span<const double> stamps) {
  std::vector<double> steps;
  steps.reserve(stamps.size());
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] >= stamps[i - 1]) {
      steps.push_back(stamps[i] - stamps[i - 1]);
    }
  }
  return steps;
}

/// Mean step a sample over the groups that are not behind a gap (rows, rising).
double mean_interval(std::span<const double> stamps, const std::vector<Group>& groups,
                     const std::vector<std::size_t>& gaps) {
  double sum = 0.0;
  double samples = 0.0;
  auto gap = gaps.begin();
  for (std::size_t g = 1; g < groups.size(); ++g) {
    const double step = stamps[groups[g].first] - stamps[groups[g - 1].first];
    if (gap != gaps.end() && *gap == groups[g].first) {
      ++gap;
    } else if (step > 0.0) {
      sum += step;
      samples += 0.5 * static_cast<double>(groups[g - 1].count + groups[g].count);
    }
  }
  return samples > 0.0 ? sum / samples : 0.0;
}

/// Half the distance of the 5 % and 95 % quantiles; reorders the steps.
double half_spread(std::vector<double>& steps) {
  const double low = quantile(steps, 0.05);
  return 0.5 * (quantile(steps, 0.95) - low);
}

/// Mean of the steps up to `longest`.
double mean_up_to(const std::vector<double>& steps, double longest) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const double step : steps) {
    sum += step <= longest ? step : 0.0;
    count += step <= longest ? 1 : 0;
  }
  return sum / static_cast<double>(count);
}

void read_as_grid(SampleGrid grid, std::span<const double> stamps, const std::vector<Group>& groups, Spacing& spacing) {
  spacing.interval_s = grid.interval_s;
  spacing.long_steps = find_long_steps(stamps, groups, grid.interval_s);
  std::vector<double> steps;
  steps.reserve(stamps.size());
  auto gap = grid.gaps.begin();
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const bool behind_gap = gap != grid.gaps.end() && gap->row == i;
    const double lost = behind_gap ? static_cast<double>(gap->missing) * grid.interval_s : 0.0;
    gap += behind_gap ? 1 : 0;
    if (stamps[i] >= stamps[i - 1]) {
      steps.push_back(stamps[i] - stamps[i - 1] - lost);
    }
  }
  spacing.jitter_s = half_spread(steps);
  spacing.gaps = std::move(grid.gaps);
}

/// Returns the mean step a sample.
double read_as_bursts(std::span<const double> stamps, std::vector<double> steps, Spacing& spacing) {
  const double largest_common = quantile(steps, 0.99);
  spacing.interval_s = mean_up_to(steps, largest_common);
  const double longest = std::max(20.0 * spacing.interval_s, 5.0 * largest_common);
  spacing.long_steps.clear();
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] - stamps[i - 1] > longest) {
      spacing.long_steps.push_back(i);
    }
  }
  return mean_up_to(steps, longest);
}

}  // namespace

Spacing find_spacing(std::span<const double> stamps, std::span<const std::size_t> backward, double stated_s) {
  constexpr double kManyGaps = 0.005;  // more of the steps than this look like gaps: they are seen together
  constexpr double kBurstGaps = 0.02;  // more than this, on no grid
  const std::vector<Group> groups = group_by_stamp(stamps);
  Spacing spacing;
  spacing.repeated_stamps = stamps.size() - groups.size();
  spacing.interval_s = median_interval(stamps, groups);
  if (spacing.interval_s <= 0.0) {
    return spacing;
  }
  spacing.long_steps = find_long_steps(stamps, groups, spacing.interval_s);
  std::vector<double> steps = forward_steps(stamps);
  if (auto grid = find_stated_grid(stamps, backward, steps, spacing.interval_s, stated_s)) {
    read_as_grid(std::move(*grid), stamps, groups, spacing);
    return spacing;
  }
  const double long_share = static_cast<double>(spacing.long_steps.size()) / static_cast<double>(stamps.size());
  if (long_share > kManyGaps) {
    if (auto grid = find_sample_grid(stamps, backward, steps, spacing.interval_s, stated_s)) {
      read_as_grid(std::move(*grid), stamps, groups, spacing);
      return spacing;
    }
  }
  spacing.jitter_s = half_spread(steps);
  spacing.bursts = long_share > kBurstGaps && stamps.size() >= 100;
  const double mean_s = spacing.bursts ? read_as_bursts(stamps, std::move(steps), spacing)
                                       : mean_interval(stamps, groups, spacing.long_steps);
  spacing.gaps = gap_sizes(stamps, spacing.long_steps, backward, mean_s);
  return spacing;
}

}  // namespace driftlab
