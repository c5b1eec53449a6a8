#pragma once
/// Theo1: a variance of two means at a stride of 0.75 of its window, defined up to three quarters of the record.
///
/// With x the running sum of the samples (N + 1 phases) and m even,
///   Theo1(0.75 m dt) = 1/(0.75 (N + 1 - m) m^2) sum_{i=0}^{N-m} sum_{d=0}^{m/2-1}
///                      [(x_i - x_{i-d+m/2}) + (x_{i+m} - x_{i+d+m/2})]^2/(m/2 - d)
/// (Howe and Peppler 2003; NIST SP 1065 eq. 30 with the factor 1/0.75 of its definition). It equals the Allan variance
/// in the mean for white noise, and is less for redder noise: see long_tau.hpp.
///
/// The double sum costs (N - m) m/2. A window of more than 127 samples is therefore made of 64 to 95 whole blocks, and
/// Theo1 is formed of the block means: a statement about the averages of the same signal.
#include <cstddef>
#include <span>
#include <vector>

namespace driftlab {

struct Theo1Value {
  double tau_s = 0.0;      ///< 0.75 m blocks dt
  double variance = 0.0;   ///< [unit^2], not corrected
  double ratio = 0.0;      ///< tau over the length of a block: 0.75 m, m counted in blocks
  std::size_t length = 0;  ///< blocks in the record
};

/// Theo1 exactly as defined, of the series itself. Preconditions: m is even and 2 <= m <= N. O((N - m) m).
[[nodiscard]] double theo1(std::span<const double> samples, double pivot, std::size_t m);

/// Theo1 of a window of about `window` samples (to 2 %), 10 <= window <= N, blocks as described above.
[[nodiscard]] Theo1Value theo1_at(std::span<const double> samples, double pivot, std::size_t window, double dt_s);

}  // namespace driftlab
