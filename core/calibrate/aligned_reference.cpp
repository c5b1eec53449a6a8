#include "core/calibrate/aligned_reference.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostCompared = 100'000;
/// Two noises are most alike at some lag; that is no delay.
constexpr double kLeastCorrelation = 0.5;

/// Where in `values` a run starts.
std::size_t place_of(const ChannelView& channel, const RowRun& run) {
  return static_cast<std::size_t>(channel.rows(run.first, run.count).data() - channel.values.data());
}

/// The part of [first, first + count) of at most kMostCompared in which the series scatters most.
std::pair<std::size_t, std::size_t> most_moving(std::span<const double> series, std::size_t first, std::size_t count) {
  if (count <= kMostCompared) {
    return {first, count};
  }
  std::size_t best = first;
  double most = -1.0;
  for (std::size_t start = first; start + kMostCompared <= first + count; start += kMostCompared / 2) {
    const std::span<const double> part = series.subspan(start, kMostCompared);
    double sum = 0.0;
    double square = 0.0;
    for (const double value : part) {
      const double centred = value - part.front();
      sum += centred;
      square += centred * centred;
    }
    const double scatter = square - sum * sum / static_cast<double>(part.size());
    if (scatter > most) {
      most = scatter;
      best = start;
    }
  }
  return {best, kMostCompared};
}

Result<TimeAlignment> estimate(const ChannelView& channel, double dt_s, AlignmentOptions options) {
  const RowRun longest = channel.stretch.longest();
  const auto [first, count] = most_moving(channel.reference, place_of(channel, longest), longest.count);
  const std::span<const double> reference = std::span(channel.reference).subspan(first, count);
  std::vector<double> measured(count);
  for (std::size_t i = 0; i < count; ++i) {
    measured[i] = channel.values[first + i] + reference[i];
  }
  const double most = 0.25 * static_cast<double>(count) * dt_s;
  options.max_shift_s = std::max(dt_s, std::min(options.max_shift_s, most));
  return align_reference(measured, reference, dt_s, options);
}

bool known(const TimeAlignment& found, double dt_s) {
  const Interval& ci95 = found.delay_s.ci95;
  return found.converged && found.warnings.empty() && found.correlation >= kLeastCorrelation &&
         ci95.half_width() <= dt_s && !ci95.contains(0.0);
}

/// Subtracts the reference as it was `delay_s` earlier.
void shift(ChannelView& channel, double delay_samples) {
  // A place needs one sample before and two behind it to be interpolated.
  const auto margin = static_cast<std::size_t>(std::ceil(std::abs(delay_samples))) + 2;
  Stretch kept;
  std::vector<double> values;
  std::vector<double> reference;
  std::size_t lost = 0;
  for (const RowRun& run : channel.stretch.runs) {
    lost += run.missing;
    if (run.count <= 2 * margin) {
      lost += run.count;
      continue;
    }
    const std::size_t place = place_of(channel, run);
    const std::vector<double> moved = delayed(std::span(channel.reference).subspan(place, run.count), delay_samples);
    for (std::size_t i = margin; i + margin < run.count; ++i) {
      values.push_back(channel.values[place + i] + channel.reference[place + i] - moved[i]);
      reference.push_back(moved[i]);
    }
    kept.runs.push_back({run.first + margin, run.count - 2 * margin, lost + margin});
    lost = margin;
  }
  channel.stretch = std::move(kept);
  channel.gaps = channel.stretch.gaps();
  channel.owned = std::move(values);
  channel.reference = std::move(reference);
  channel.values = channel.owned;
}

}  // namespace

std::vector<ReferenceAlignment> align_references(RecordingView& view, const AlignmentOptions& options) {
  const double dt_s = view.window.time.dt_s;
  std::vector<ReferenceAlignment> alignments;
  for (ChannelView& channel : view.channels) {
    if (channel.reference_column.empty()) {
      continue;
    }
    ReferenceAlignment one{channel.column, channel.reference_column, std::nullopt, "", false};
    auto found = estimate(channel, dt_s, options);
    if (!found) {
      one.reason = found.error().message;
    } else {
      one.applied = known(*found, dt_s);
      if (one.applied) {
        shift(channel, found->delay_s.value / dt_s);
      } else {
        one.reason = "The delay is not told from none; the reference is subtracted as it is.";
      }
      one.estimate = std::move(*found);
    }
    alignments.push_back(std::move(one));
  }
  return alignments;
}

}  // namespace driftlab
