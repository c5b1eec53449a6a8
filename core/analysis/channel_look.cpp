#include "core/analysis/channel_look.hpp"

#include "core/analysis/implied_curves.hpp"
#include "core/signal/row_times.hpp"

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
  const RowRun run = channel->stretch.longest();
  look.run_ = channel->rows(run.first, run.count);
  look.unit_ = channel->role.unit.value_or(Unit{});
  look.dt_s_ = look.view_.window.time.dt_s;
  look.first_s_ = RowTimes(look.view_.window).at(run.first);
  look.mean_ =
      run.count == 0 ? 0.0 : std::accumulate(look.run_.begin(), look.run_.end(), 0.0) / static_cast<double>(run.count);
  return look;
}

Result<BinnedSpectrum> ChannelLook::spectrum(FrequencyScale scale, std::size_t bins) const {
  if (run_.size() < kFewest) {
    return too_few(run_.size());
  }
  return binned_spectrum(run_, mean_, dt_s_, scale, bins);
}

std::optional<RobustHistogram> ChannelLook::histogram(std::size_t bins) const { return robust_histogram(run_, bins); }

std::vector<ApartPlace> ChannelLook::apart() const { return apart_places(run_, first_s_, dt_s_); }

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
