#include "core/investigate/consistency/noisy_reference.hpp"

#include "core/investigate/fullrate/spectrum.hpp"
#include "core/process/distributions.hpp"
#include "core/signal/turns.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <set>

namespace driftlab::investigate {
namespace {

/// Samples of a segment, whose bins lie in bands of four; so many segments at least. Chosen, not measured.
constexpr std::size_t kSegment = 256;
constexpr std::size_t kBandBins = 4;
constexpr std::size_t kBands = kSegment / 2 / kBandBins;
constexpr std::size_t kFewestSegments = 16;
constexpr std::size_t kFewestBands = 4;  ///< an eighth of the spectrum
constexpr double kFromMinusOne = 0.4;
constexpr double kClearBand = 3.0;      ///< standard deviations of the coherence in one band
constexpr double kClear = 10.0;         ///< in all bands together
constexpr double kLeastShare = 0.02;    ///< of the error's power
constexpr double kNothingThere = 1e-3;  ///< reference against error: it has no power in that band
constexpr double kHannOrdinates =
    0.53;  ///< independent ordinates per bin and half-overlapping Hann segment (Welch 1967)

struct Band {
  double reference = 0.0;  ///< sums of squares
  double error = 0.0;
  double cross = 0.0;  ///< of their products, real part
};

struct Bands {
  std::vector<Band> bands{kBands};
  double ordinates = 0.0;  ///< independent ones in a band
};

/// Second differences of a segment under a Hann window, transformed.
std::vector<std::complex<double>> segment_of(const Series& values, std::size_t from) {
  std::vector<double> tapered(kSegment);
  for (std::size_t i = 0; i < kSegment; ++i) {
    const std::size_t at = from + i;
    const double window = 0.5 - 0.5 * std::cos(kTurn * (static_cast<double>(i) + 0.5) / static_cast<double>(kSegment));
    tapered[i] = window * (values[at + 2] - 2.0 * values[at + 1] + values[at]);
  }
  return half_spectrum_of(Series(std::move(tapered)), kSegment);
}

Bands bands_of(const StudyRecording& recording, const Channel& channel, const std::stop_token& stop) {
  Bands result;
  double segments = 0.0;
  for (std::size_t from = recording.begin; from + kSegment + 2 <= recording.end && !stop.stop_requested();
       from += kSegment / 2) {
    bool whole = true;
    for (std::size_t i = from; i < from + kSegment + 2 && whole; ++i) {
      whole = channel.valid[i] != 0;
    }
    if (!whole) {
      continue;
    }
    const auto r = segment_of(channel.reference, from);
    const auto e = segment_of(channel.error, from);
    for (std::size_t b = 0; b < kBands; ++b) {
      for (std::size_t k = 1 + b * kBandBins; k <= (b + 1) * kBandBins; ++k) {
        result.bands[b].reference += std::norm(r[k]);
        result.bands[b].error += std::norm(e[k]);
        result.bands[b].cross += std::real(std::conj(r[k]) * e[k]);
      }
    }
    segments += 1.0;
  }
  result.ordinates = segments < static_cast<double>(kFewestSegments) ? 0.0 : segments * kHannOrdinates * kBandBins;
  return result;
}

/// The error goes with minus the reference, beyond doubt.
bool is_noise_of_reference(const Band& band, double ordinates) {
  const double gain = band.cross / std::max(1e-300, band.reference);
  const double coherence = band.cross / std::sqrt(std::max(1e-300, band.reference * band.error));
  return std::fabs(gain + 1.0) < kFromMinusOne && -coherence * std::sqrt(2.0 * ordinates) > kClearBand;
}

bool is_empty(const Band& band) { return band.reference < kNothingThere * band.error; }

/// |1 - exp(-iw)|^4 in the middle of a band: what second differences make of a density.
double differenced(std::size_t band) {
  const double middle = (static_cast<double>(band) + 0.5) * static_cast<double>(kBandBins) + 0.5;
  return std::pow(2.0 * std::sin(0.5 * kTurn * middle / static_cast<double>(kSegment)), 4.0);
}

std::optional<NoisyReference> judge(const StudyRecording& recording, const Channel& channel,
                                    const std::stop_token& stop) {
  const Bands found = bands_of(recording, channel, stop);
  if (found.ordinates == 0.0) {
    return std::nullopt;
  }
  std::size_t first = kBands;
  std::size_t noisy = 0;
  for (; first > 0; --first) {
    const Band& band = found.bands[first - 1];
    const bool noise = is_noise_of_reference(band, found.ordinates);
    if (!noise && !is_empty(band)) {
      break;
    }
    noisy += noise ? 1 : 0;
  }
  if (noisy < kFewestBands || first == 0) {
    return std::nullopt;  // first == 0: they share no motion
  }
  double cross = 0.0;
  double error = 0.0;
  double square = 0.0;
  for (std::size_t b = first; b < kBands; ++b) {
    const Band& band = found.bands[b];
    if (!is_noise_of_reference(band, found.ordinates)) {
      continue;
    }
    square += 2.0 * found.ordinates * band.cross * band.cross / (band.reference * band.error);
    cross -= band.cross / differenced(b);
    error += band.error / differenced(b);
  }
  NoisyReference result;
  result.share = cross / error;
  if (std::sqrt(square) < kClear || result.share < kLeastShare) {
    return std::nullopt;
  }
  // Mean square of one tapered segment's ordinate per unit of density is 3/8 n / dt.
  const double ordinates = found.ordinates * static_cast<double>(noisy);
  const double segments = found.ordinates / (kHannOrdinates * static_cast<double>(kBandBins));
  const double per_density =
      segments * static_cast<double>(noisy * kBandBins) * 0.375 * static_cast<double>(kSegment) / recording.dt_s;
  const double value = std::sqrt(cross / per_density);
  const double relative = 0.5 * std::sqrt((1.0 + 0.5 / result.share) / ordinates);
  result.density = {value, {value * std::max(0.0, 1.0 - kNormal975 * relative), value * (1.0 + kNormal975 * relative)}};
  result.cut_hz = (static_cast<double>(first * kBandBins) + 0.5) / static_cast<double>(kSegment) / recording.dt_s;
  return result;
}

/// The step of a coarse column: few distinct values for its length, and all steps between them multiples of the
/// smallest. 0: it is not coarse.
double coarse_step(const StudyRecording& recording, const Series& reference) {
  // Chosen, not measured: a column of more distinct values than 12 bits give is not called coarse.
  constexpr std::size_t kMost = 4096;
  std::set<double> distinct;
  for (std::size_t i = recording.begin; i < recording.end; ++i) {
    distinct.insert(reference[i]);
    if (distinct.size() > kMost || 4 * distinct.size() > recording.count() + 64) {
      return 0.0;
    }
  }
  double least = 0.0;
  for (auto it = distinct.begin(); std::next(it) != distinct.end() && !distinct.empty(); ++it) {
    const double step = *std::next(it) - *it;
    least = least == 0.0 || step < least ? step : least;
  }
  const double base = distinct.empty() ? 0.0 : *distinct.begin();
  const bool lattice = least > 0.0 && std::all_of(distinct.begin(), distinct.end(), [&](double v) {
                         const double places = (v - base) / least;
                         return std::fabs(places - std::round(places)) < 0.05;
                       });
  return lattice ? least : 0.0;
}

bool varies(const StudyRecording& recording, const Series& reference) {
  for (std::size_t i = recording.begin + 1; i < recording.end; ++i) {
    if (reference[i] != reference[recording.begin]) {
      return true;
    }
  }
  return false;
}

}  // namespace

std::vector<NoisyReference> noisy_references(const Study& study, const std::stop_token& stop) {
  std::vector<NoisyReference> all;
  for (std::size_t r = 0; r < study.recordings.size(); ++r) {
    const StudyRecording& recording = study.recordings[r];
    for (std::size_t c = 0; c < recording.channels.size(); ++c) {
      const Channel& channel = recording.channels[c];
      const auto axis = axis_index(channel.role.axis);
      if (channel.role.quantity != Quantity::AngularRate || !axis || channel.reference.empty() ||
          channel.error.empty() || channel.input_only || !varies(recording, channel.reference)) {
        continue;
      }
      auto found = judge(recording, channel, stop);
      if (stop.stop_requested()) {
        return {};
      }
      if (!found) {
        continue;
      }
      found->recording = r;
      found->axis = *axis;
      found->channel = c;
      found->step = coarse_step(recording, channel.reference);
      all.push_back(*std::move(found));
    }
  }
  return all;
}

}  // namespace driftlab::investigate
