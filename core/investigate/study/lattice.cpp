#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <utility>
#include <vector>

namespace driftlab::investigate {
namespace {

double decimal_place(std::span<const double> rows) {
  double place = 1.0;
  for (int digits = 0; digits < 9; ++digits, place *= 0.1) {
    const bool fits = std::all_of(rows.begin(), rows.end(), [&](double v) {
      const double q = v / place;
      return std::fabs(q - std::round(q)) < 1e-5 * std::max(1.0, std::fabs(q) * 1e-9) + 1e-6;
    });
    if (fits) {
      return place;
    }
  }
  return 0.0;
}

/// In ascending order; nothing where more than half of the rows are distinct, as in a column without a lattice.
std::vector<double> repeated_values(std::span<const double> rows, const std::stop_token& stop) {
  const std::size_t all = rows.size();
  constexpr std::size_t kPart = std::size_t{1} << 16U;
  std::vector<double> values;
  while (!rows.empty()) {
    // As many as there are already, so that each is merged a few times only; no more than may show that most are
    // distinct.
    const std::size_t wanted = std::min(values.size(), all / 2 + 1 - values.size());
    const std::size_t taken = std::min(rows.size(), std::max(kPart, wanted));
    std::vector<double> part(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(taken));
    rows = rows.subspan(taken);
    std::sort(part.begin(), part.end());
    part.erase(std::unique(part.begin(), part.end()), part.end());
    std::vector<double> known = std::move(values);
    values.clear();
    std::set_union(known.begin(), known.end(), part.begin(), part.end(), std::back_inserter(values));
    if (values.size() * 2 > all || stop.stop_requested()) {
      return {};
    }
  }
  return values;
}

}  // namespace

Lattice find_lattice(std::span<const double> rows, const std::stop_token& stop) {
  Lattice lattice;
  lattice.decimals = decimal_place(rows);
  const std::vector<double> values = repeated_values(rows, stop);
  if (values.size() < 3) {
    return lattice;
  }
  // The step is near the smallest common difference; decimals blur it by one of their units.
  std::vector<double> gaps;
  for (std::size_t i = 1; i < values.size(); ++i) {
    gaps.push_back(values[i] - values[i - 1]);
  }
  std::vector<double> sorted = gaps;
  std::sort(sorted.begin(), sorted.end());
  double step = sorted[sorted.size() / 3];
  const double blur = std::max(lattice.decimals, 1e-9 * std::fabs(values.back()));
  if (step < 4.5 * blur) {  // five times, but for rounding
    const bool few = values.size() < 200 && lattice.decimals > 0.0 && std::fabs(step - lattice.decimals) < 0.1 * step;
    lattice.step = few ? lattice.decimals : 0.0;
    return lattice;
  }
  // Index by whole steps from one value to the next, then refine on ever longer spans.
  std::vector<double> index(values.size(), 0.0);
  for (int round = 0; round < 3; ++round) {
    double sum_ii = 0.0;
    double sum_iv = 0.0;
    double mean_i = 0.0;
    double mean_v = 0.0;
    for (std::size_t i = 1; i < values.size(); ++i) {
      index[i] = index[i - 1] + std::round(gaps[i - 1] / step);
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      mean_i += index[i] / static_cast<double>(values.size());
      mean_v += values[i] / static_cast<double>(values.size());
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      sum_ii += (index[i] - mean_i) * (index[i] - mean_i);
      sum_iv += (index[i] - mean_i) * (values[i] - mean_v);
    }
    step = sum_iv / sum_ii;
    double worst = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      worst = std::max(worst, std::fabs(values[i] - mean_v - step * (index[i] - mean_i)));
    }
    lattice.step_sd = blur / std::sqrt(12.0 * sum_ii);
    if (round == 2 && worst > std::max(1.6 * blur, 0.02 * step)) {
      return {0.0, 0.0, lattice.decimals};
    }
  }
  lattice.step = step;
  return lattice;
}

double noise_of_differences(const StudyRecording& recording, const Channel& channel) {
  const Series& e = channel.error.empty() ? channel.measured : channel.error;
  std::vector<double> d;
  d.reserve(recording.count());
  for (std::size_t i = recording.begin + 1; i < recording.end; ++i) {
    if (channel.valid[i] != 0 && channel.valid[i - 1] != 0) {
      d.push_back(std::fabs(e[i] - e[i - 1]));
    }
  }
  if (d.size() < 8) {
    return 0.0;
  }
  double mean = 0.0;
  for (const double v : d) {
    mean += v / static_cast<double>(d.size());
  }
  const double cut = 5.0 * mean * 1.2533;
  double square = 0.0;
  double count = 0.0;
  for (const double v : d) {
    if (v <= cut) {
      square += v * v;
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(0.5 * square / count) : 0.0;
}

double noise_behind_lattice(double seen, double step) {
  return std::sqrt(std::max(seen * seen - step * step / 12.0, 1e-4 * step * step));
}

bool at_limit(double row, double limit) { return std::fabs(row) >= limit * (1.0 - 1e-9); }

namespace {

constexpr double kCoarse = 0.3;  ///< step over noise

/// From differences of the samples as they are: motion changes little from one to the next.
double spread_of_differences(const Channel& channel) {
  std::vector<double> d;
  d.reserve(channel.rows.size());
  for (std::size_t i = 1; i < channel.rows.size(); ++i) {
    d.push_back(std::fabs(channel.rows[i] - channel.rows[i - 1]));
  }
  if (d.empty()) {
    return 0.0;
  }
  double mean = 0.0;
  for (const double v : d) {
    mean += v / static_cast<double>(d.size());
  }
  return mean * std::sqrt(0.25 * std::numbers::pi);  // of Gaussian white noise
}

bool is_coarse(const Channel& channel) {
  return find_lattice(channel.rows).step > kCoarse * spread_of_differences(channel);
}

/// The motion, as the channel reads it where it is slower, goes beyond `top` [SI] by more than rounding and noise do.
bool goes_beyond(const Channel& channel, double top) {
  constexpr std::size_t kEnough = 8;
  // Samples of slower motion from which the median error is taken; kEnough beyond the end of the range count. Chosen,
  // not measured.
  constexpr std::size_t kSlower = 100;
  const double factor = std::fabs(channel.unit.factor);
  const double step = find_lattice(channel.rows).step * factor;
  const double margin = 1.5 * step + 3.0 * noise_behind_lattice(spread_of_differences(channel) * factor, step);
  std::vector<double> slower;
  for (std::size_t i = 0; i < channel.error.size() && i < channel.reference.size(); ++i) {
    if (channel.valid[i] != 0 && std::fabs(channel.reference[i]) < 0.8 * top) {
      slower.push_back(channel.error[i]);
    }
  }
  if (slower.size() < kSlower) {
    return false;
  }
  const auto middle = slower.begin() + static_cast<std::ptrdiff_t>(slower.size() / 2);
  std::nth_element(slower.begin(), middle, slower.end());
  std::size_t beyond = 0;
  for (const double w : channel.reference) {
    beyond += std::fabs(w + *middle) > top + margin ? 1 : 0;
  }
  return beyond >= kEnough;
}

}  // namespace

double clipped_at(const Channel& channel) {
  constexpr std::ptrdiff_t kEnough = 8;
  // Of the greatest reading: the motion must have come so near to it. Chosen, not measured.
  constexpr double kNear = 0.98;
  double top = 0.0;
  for (const double v : channel.rows) {
    top = std::max(top, std::fabs(v));
  }
  const double si = std::fabs(channel.unit.to_si(top) - channel.unit.to_si(0.0));
  const bool reached = std::any_of(channel.reference.begin(), channel.reference.end(),
                                   [&](double w) { return std::fabs(w) > kNear * si; });
  const auto count =
      std::count_if(channel.rows.begin(), channel.rows.end(), [&](double v) { return at_limit(v, top); });
  if (reached && count >= kEnough && is_coarse(channel) && !goes_beyond(channel, si)) {
    return 0.0;
  }
  return reached && count >= kEnough ? top : 0.0;
}

}  // namespace driftlab::investigate
