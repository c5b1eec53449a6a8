#include "core/analysis/channel_look.hpp"

#include "core/analysis/implied_curves.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace driftlab {
namespace {

constexpr std::size_t kFewest = 64;

tl::unexpected<Error> too_few(std::size_t samples) {
  return fail(ErrorCode::TooFewSamples,
              "A spectrum needs 64 samples without a gap; the channel has " + std::to_string(samples) + ".");
}

/// The rows of the longest run among `values`, which `gaps` cut: its first value and how many.
std::pair<std::size_t, std::size_t> longest_run(std::size_t count, std::span<const Gap> gaps) {
  std::pair<std::size_t, std::size_t> best{0, 0};
  std::size_t first = 0;
  const auto consider = [&](std::size_t end) {
    if (end - first > best.second) {
      best = {first, end - first};
    }
    first = end;
  };
  for (const Gap& gap : gaps) {
    consider(gap.row);
  }
  consider(count);
  return best;
}

/// The time of a channel's value since the first row of the file: by its row, and by what is missing before that.
double time_of(const Window& window, const ChannelView& channel, std::size_t value) {
  std::size_t row = window.first;
  for (const RowRun& run : channel.stretch.runs) {
    row = run.first + std::min(value, run.count);
    if (value < run.count) {
      break;
    }
    value -= run.count;
  }
  std::size_t missing = 0;
  for (const Gap& gap : window.gaps) {
    missing += gap.row <= row ? gap.missing : 0;
  }
  return window.time.first_s + static_cast<double>(row - window.first + missing) * window.time.dt_s;
}

/// Divides every band by its median over time, in place.
void divide_by_medians(Spectrogram& found) {
  const std::size_t bands = found.frequency_hz.size();
  std::vector<double> course(found.time_s.size());
  for (std::size_t b = 0; b < bands; ++b) {
    for (std::size_t c = 0; c < course.size(); ++c) {
      course[c] = found.density[c * bands + b];
    }
    const auto middle = course.begin() + static_cast<std::ptrdiff_t>(course.size() / 2);
    std::nth_element(course.begin(), middle, course.end());
    for (std::size_t c = 0; c < course.size(); ++c) {
      found.density[c * bands + b] /= *middle;
    }
  }
}

}  // namespace

Result<ChannelLook> ChannelLook::open(RecordingSource& source, std::string_view column) {
  auto recording = source.open(0, {});
  if (!recording) {
    return fail(recording.error());
  }
  auto view = view_of(*recording);
  if (!view) {
    return fail(view.error());
  }
  auto calibration = source.calibration(0);
  if (!calibration) {
    return fail(calibration.error());
  }
  if (auto applied = apply_calibration(*calibration, *view); !applied) {
    return fail(applied.error());
  }
  ChannelLook look(std::move(recording->columns), std::move(*view));
  const auto channel = std::find_if(look.view_.channels.begin(), look.view_.channels.end(),
                                    [&](const ChannelView& each) { return each.column == column; });
  if (channel == look.view_.channels.end()) {
    return fail(ErrorCode::UnknownColumn,
                "The recording has no sensor column '" + std::string(column) + "'; name one: ?channel=…",
                {{"parameter", "channel"}});
  }
  const auto [first, count] = longest_run(channel->values.size(), channel->gaps);
  look.run_ = channel->values.subspan(first, count);
  look.unit_ = channel->role.unit.value_or(Unit{});
  look.dt_s_ = look.view_.window.time.dt_s;
  look.first_s_ = time_of(look.view_.window, *channel, first);
  look.mean_ = count == 0 ? 0.0 : std::accumulate(look.run_.begin(), look.run_.end(), 0.0) / static_cast<double>(count);
  return look;
}

Result<BinnedSpectrum> ChannelLook::spectrum(FrequencyScale scale, std::size_t bins) const {
  if (run_.size() < kFewest) {
    return too_few(run_.size());
  }
  return binned_spectrum(run_, mean_, dt_s_, scale, bins);
}

std::optional<RobustHistogram> ChannelLook::histogram(std::size_t bins) const { return robust_histogram(run_, bins); }

std::vector<double> ChannelLook::Ratio::log10() const {
  std::vector<double> logs;
  logs.reserve(spectrogram.density.size());
  for (const double ratio : spectrogram.density) {
    logs.push_back(std::log10(ratio));
  }
  return logs;
}

Result<ChannelLook::Ratio> ChannelLook::ratio(const Model* model, std::size_t cells, std::size_t bands) const {
  if (run_.size() < kFewest) {
    return too_few(run_.size());
  }
  Ratio result{spectrogram(run_, mean_, dt_s_, cells, bands), model != nullptr};
  Spectrogram& found = result.spectrogram;
  if (model == nullptr) {
    divide_by_medians(found);
    return result;
  }
  const ImpliedCurves expected = implied_curves(*model, dt_s_, {}, found.frequency_hz);
  for (std::size_t i = 0; i < found.density.size(); ++i) {
    const std::optional<double>& density = expected.density[i % found.frequency_hz.size()];
    if (!density || *density <= 0.0) {
      return fail(ErrorCode::InvalidArgument, "A process of this fit has no spectral density to compare with.",
                  {{"parameter", "fit"}});
    }
    found.density[i] *= unit_.factor * unit_.factor / *density;
  }
  return result;
}

}  // namespace driftlab
