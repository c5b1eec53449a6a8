#pragma once
/// The use case "read a stored result": what the result of one channel says, and what its fits imply.
///
/// A result is computed once and read for years: by lists that show a sentence, by pages that draw its curve, by events
/// that announce it. All of them ask here, with the channel as it is stored (schema/json/stored_channel.hpp), so that
/// none of them computes anything of a document.
#include "core/analysis/drawn_values.hpp"
#include "core/analysis/implied_curves.hpp"
#include "core/campaign/reported_channel.hpp"
#include "core/campaign/verdict.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// One channel of a stored characterisation with its curves; a curve that the result does not hold is empty.
struct StoredChannel {
  ReportedChannel told;
  std::optional<Contamination> contamination;  ///< nothing where gross errors were not tested for
  MeasuredDeviation allan;                     ///< [channel unit]
  /// Robust Haar wavelet variances [channel unit^2], one for each of `told.haar.scale`; `x` is empty.
  DrawnCurve robust;
  std::size_t best = 0;  ///< place in `told.fits` of the fit that stands for the channel

  [[nodiscard]] const ReportedFit* best_fit() const { return best < told.fits.size() ? &told.fits[best] : nullptr; }
};

[[nodiscard]] Verdict verdict_of(const StoredChannel& channel);

/// The channel that a person should look at first: the first of those of the worst level. Nothing without channels.
[[nodiscard]] std::optional<GravestChannel> gravest_channel(std::span<const StoredChannel> channels);

/// The processes of a fit without those that it has nothing of.
[[nodiscard]] std::vector<ReportedProcess> present_processes(const ReportedFit& fit);

/// The error model of a fit to a channel of that dimension, in SI, of the processes that are present. Nothing where
/// the fit leaves a parameter open.
[[nodiscard]] std::optional<Model> model_of(const ReportedFit& fit, Dimension dimension);

/// What a fit of that channel implies beside what was measured, in the channel's own unit. Nothing where the fit leaves
/// a parameter open, or the result holds no Allan deviation.
[[nodiscard]] std::optional<ImpliedBeside> implied_by(const ReportedFit& fit, const StoredChannel& channel);

}  // namespace driftlab
