#pragma once
/// How close each ranked model is to the data.
///
/// Models are ranked by L + p ln N, and those whose L + 2p is within 6 of the least cannot be told apart
/// (core/fit/candidate.hpp): a criterion that finds the right model in the long run, and one that finds the closest.
/// They disagree where ln N weighs parameters so much more that the model ranked first is not plausible. Both follow
/// from the criterion as it is stored, so that results of any age can say which model is the closest.
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace driftlab {

struct RankedModel {
  std::string_view model;  ///< `WN+GM`
  double criterion = 0.0;  ///< L + p ln N
};

/// The N of the criterion: the samples of the grid, or where no candidate describes the curve (discrepancy > 0) the
/// scales that were fitted, for each is then one observation of a regression.
[[nodiscard]] double criterion_observations(std::size_t grid_samples, double discrepancy, std::size_t scales);

/// How many of the Haar filters of `scale` samples, whose tau is half their length, models were fitted to: those of tau
/// from `from_tau_s` on, to 1e-9.
[[nodiscard]] std::size_t fitted_scales(std::span<const std::size_t> scale, double dt_s, double from_tau_s);

/// L + 2p of each model minus the least of all; nothing for a model without a finite criterion or with an unknown name.
[[nodiscard]] std::vector<std::optional<double>> distances_2p(std::span<const RankedModel> models, double observations);

}  // namespace driftlab
