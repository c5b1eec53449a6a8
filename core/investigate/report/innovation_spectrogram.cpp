#include "core/investigate/report/innovation_spectrogram.hpp"

#include "core/variance/spectrogram.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

// Chosen for the width of a figure and the size of a document.
constexpr std::size_t kCells = 64;
constexpr std::size_t kBands = 32;

/// The chance of what a test saw, places included [ln].
double log_chance(const Remainder& remainder) { return std::log(std::max(1.0, remainder.places)) - remainder.observed; }

}  // namespace

std::optional<InnovationSpectrogram> spectrogram_of_innovations(const ChannelGroup& group, const FullRate& data,
                                                                const std::vector<Remainder>& remains) {
  const Remainder* least = nullptr;
  for (const Remainder& remainder : remains) {
    if (remainder.in_time_or_frequency && !remainder.recording.empty() &&
        (least == nullptr || log_chance(remainder) < log_chance(*least))) {
      least = &remainder;
    }
  }
  for (std::size_t r = 0; least != nullptr && r < data.members(); ++r) {
    const StudyRecording& recording = *group.members[r].recording;
    if (recording.id != least->recording) {
      continue;
    }
    std::vector<double> innovations = data.innovation[r].values();
    for (double& e : innovations) {
      e = std::clamp(e, -6.0, 6.0);
    }
    const Spectrogram powers = spectrogram(innovations, 0.0, data.dt_s, kCells, kBands);
    InnovationSpectrogram picture;
    picture.recording = recording.id;
    picture.f_hz = powers.frequency_hz;
    for (const double t : powers.time_s) {
      picture.time_s.push_back(recording.time_s(recording.begin) + t);
    }
    for (const double density : powers.density) {
      picture.log10_ratio.push_back(density > 0.0 ? std::log10(density / data.dt_s) : std::nan(""));
    }
    return picture;
  }
  return std::nullopt;
}

}  // namespace driftlab::investigate
