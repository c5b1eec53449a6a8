#pragma once
/// Whether a filter errs more where the unit is shaken: its outages in three equal parts by the power of the
/// gyroscope's vibration meanwhile (spec/drives.md, section 6: what tells noise that follows the vibration apart from a
/// level, under which the three parts err alike).
///
/// The power of an outage is the mean over its time and over the three axes of P(t)/mean P (vibration.hpp), each axis
/// over its mean of the whole drive. Parts differ in how the vehicle moves as well, which is no noise: three figures
/// that grow are evidence beside the innovations', none by themselves.
#include "core/navigate/drive/evaluation.hpp"

#include <array>
#include <optional>

namespace driftlab::drive {

struct VibrationThirds {
  double duration_s = 0.0;        ///< of the outages
  std::array<double, 3> rms_m{};  ///< of the horizontal errors, calmest third first
  std::array<double, 3> power{};  ///< mean of each third; 1 on average over the drive
  std::array<std::size_t, 3> count{};
};

/// Nothing with fewer than nine outages. O(readings).
[[nodiscard]] std::optional<VibrationThirds> errors_by_vibration(const Drive& drive, const DurationSummary& outages);

}  // namespace driftlab::drive
