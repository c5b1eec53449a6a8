#pragma once
/// Overlapping Hadamard variance: like the Allan variance, but insensitive to a linear drift.
///
/// HV(m dt) is the mean over t of (y_t - 2 y_{t-m} + y_{t-2m})^2 / 6, where y_t is the mean of the m samples that end
/// at t (NIST SP 1065 eq. 12, overlapping). For white noise it equals the Allan variance, N^2/tau; for a random walk it
/// is K^2 tau/6; for a ramp it is zero.
#include "core/process/model.hpp"
#include "core/signal/progress.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

/// Variances [unit^2] at the averaging lengths `m`, in any order, with sums formed relative to `pivot`. Precondition:
/// each m is at least 1 and 3 m is at most the number of samples. The cost is O(N) per entry and one array of N
/// doubles. The result is empty if a stop was requested through `control.stop`.
[[nodiscard]] std::vector<double> hadamard_variance(std::span<const double> samples, double pivot,
                                                    std::span<const std::size_t> m, const RunControl& control = {});

/// The Hadamard variance of a model: 4/3 (nu_m - gamma_m(m)), where gamma_m(m) is the covariance of two Haar
/// coefficients m samples apart.
[[nodiscard]] double hadamard_variance(const Model& model, double m, double dt_s);

}  // namespace driftlab
