#pragma once
/// Overlapping Hadamard variance: like the Allan variance, but blind to a linear drift.
///
/// HV(m dt) = mean over t of (y_t - 2 y_{t-m} + y_{t-2m})^2 / 6, y_t the mean of the m samples that end at t (NIST SP
/// 1065 eq. 12, overlapping). White noise gives the Allan variance, N^2/tau; a ramp gives nothing; random walk K^2
/// tau/6.
#include "core/process/model.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Variances [unit^2] at the averaging lengths `m` (each at least 1 and 3 m <= samples: a broken precondition
/// otherwise), in any order, about `pivot`. O(N) per entry; one array of N doubles. Empty where control.stop asked.
[[nodiscard]] std::vector<double> hadamard_variance(std::span<const double> samples, double pivot,
                                                    std::span<const std::size_t> m, const RunControl& control = {});

/// The same of a model: 4/3 (nu_m - gamma_m(m)), gamma the covariance of Haar coefficients m samples apart.
[[nodiscard]] double hadamard_variance(const Model& model, double m, double dt_s);

}  // namespace driftlab
