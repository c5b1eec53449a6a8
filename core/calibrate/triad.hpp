#pragma once
/// A triad of sensors at rest or in steady rotation: its mean reading with its uncertainty, and the linear model of its
/// errors.
///
/// The model is that of the seed paper's equations (9) and (10), read as the errata say (the scale factor multiplies
/// the true value), with axes that need not be orthogonal:
///
///   y = (I + diag(S) + M) x + b + noise
///
/// y is the reading of the triad, x the reading of an ideal one, b the bias, S the scale factor errors and M the
/// misalignments (zero diagonal; M_ij is the fraction of the true value along axis j that sensor i reads). All in SI.
#include "core/signal/estimate.hpp"
#include "core/signal/result.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace driftlab {

using Triple = std::array<double, 3>;

/// What sensor i reads of the true value along axis j [rad]; nothing on the diagonal, and where the angle is not
/// estimated: taken as 0, or 0 by the choice of the frame.
using AxisAngles = std::array<std::array<std::optional<Estimate>, 3>, 3>;

/// The mean of three channels over one recording or stretch, SI.
struct TriadMean {
  Triple mean{};
  Triple sigma{};  ///< standard deviation of each mean, inflated for being estimated itself; 0: unknown
};

/// The uncertainty comes from the means of 20 batches, so that noise correlated over less than a batch is accounted
/// for. A drift over the whole stretch is not recognised as such and counts as scatter. sigma = sd(batch
/// means)/sqrt(20) * sqrt(19/17); with it an interval of +-1.96 sigma has the variance of Student's t with 19 degrees
/// of freedom. Errors: TooFewSamples (below 40), ShapeMismatch (channels of unequal length), NonFinite. O(n).
[[nodiscard]] Result<TriadMean> triad_mean(const std::array<std::span<const double>, 3>& channels);

/// y = matrix * x + bias, and back.
struct TriadLaw {
  std::array<Triple, 3> matrix{Triple{1.0, 0.0, 0.0}, Triple{0.0, 1.0, 0.0}, Triple{0.0, 0.0, 1.0}};
  Triple bias{};

  /// The true value behind a reading. Precondition: the matrix is regular, as every estimate here is.
  [[nodiscard]] Triple correct(const Triple& reading) const;
};

/// sqrt(x^2 + y^2 + z^2).
[[nodiscard]] double length(const Triple& vector);

}  // namespace driftlab
