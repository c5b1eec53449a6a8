#pragma once
/// An effect without a name, as a model holds it: a profile that was measured and belongs to no cause of the registry.
///
/// A profile is constant within bins of one quantity of a recording:
///   - spectrum: the density of all noise at a frequency is `value` times that of the model;
///   - variance: the power of the white noise is `value` times that of the model;
///   - mean: the error has this much more [SI].
/// A phase is the time since the start of the recording, modulo a period: what comes again and again.
/// Outside its bins a profile is what it is in the outermost one.
#include "core/investigate/study/study.hpp"

#include <string_view>

namespace driftlab::investigate {

[[nodiscard]] std::string_view name_of(UnnamedKind kind);
[[nodiscard]] std::string_view name_of(Against against);
/// Nothing for another name.
[[nodiscard]] std::optional<UnnamedKind> unnamed_kind(std::string_view name);
[[nodiscard]] std::optional<Against> unnamed_against(std::string_view name);

/// The quantity for people: "the rate about the axis".
[[nodiscard]] std::string_view words_of(Against against);

/// As reports write what a profile goes with.
struct ProfileUnit {
  std::string symbol;
  double per_si = 1.0;
  double zero = 0.0;  ///< of 0 SI on the reported scale
  [[nodiscard]] double to_lab(double si) const { return si * per_si + zero; }
  [[nodiscard]] double to_si(double lab) const { return (lab - zero) / per_si; }
};
[[nodiscard]] ProfileUnit unit_of(Against against);

/// The edges of a profile as reports write them, and the middles that belong to it.
[[nodiscard]] std::vector<double> in_lab_units(const std::vector<double>& si, Against against);

/// A profile whose edges are in lab units and whose values, of a mean, are `value_factor` SI.
[[nodiscard]] UnnamedEffect from_lab_units(UnnamedEffect effect, double value_factor);

/// The quantity over the grid of a recording [SI]; empty where it is not known there, and for frequencies. Of a channel
/// about no axis (a pressure) rates are those about z. Angles are taken modulo a turn, phases modulo `period_s`.
[[nodiscard]] Series course_of(Against against, const StudyRecording& recording, std::size_t axis,
                               double period_s = 0.0);
[[nodiscard]] Series course_of(const UnnamedEffect& effect, const StudyRecording& recording, std::size_t axis);

/// The profile's value at x.
[[nodiscard]] double value_at(const UnnamedEffect& effect, double x);

/// Whether the effect acts on a column of a recording.
[[nodiscard]] bool acts_on(const UnnamedEffect& effect, const std::string& column, const std::string& recording);

/// `noise` with its density at f multiplied by the profile of a spectrum. O(n log n).
void shape_spectrum(const UnnamedEffect& effect, double dt_s, std::vector<double>& noise);

}  // namespace driftlab::investigate
