#pragma once
/// An autoregression of fixed order, to whiten innovations whose spectrum the model does not describe.
///
/// The autocovariance is pooled over all recordings, the coefficients follow by Levinson's recursion (Durbin 1960).
/// Outliers would enlarge the autocovariance, so values are clipped at 4 standard deviations; this changes that of
/// Gaussian noise by 1e-4.
#include <array>
#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Chosen, not measured: filters of sensors are taken to correlate samples up to 24 apart. Each order costs one
/// multiplication for each sample.
inline constexpr std::size_t kAutoregressionOrder = 24;

/// The latest values of a series that is read sample by sample.
class Recent {
 public:
  /// The value `lag` places before the present one, 1 to kAutoregressionOrder.
  [[nodiscard]] double operator[](std::size_t lag) const {
    return values_[(at_ + values_.size() - lag) % values_.size()];
  }
  void push(double value) {
    values_[at_] = value;
    at_ = (at_ + 1) % values_.size();
  }

 private:
  std::array<double, 32> values_{};
  std::size_t at_ = 0;
};

/// Sums of lagged products of innovations of unit variance, one recording after the other, a sample at a time.
class PooledAutocovariance {
 public:
  void begin_recording();
  /// A sample that is not in use counts as 0.
  void take(double value, bool used);
  /// Coefficients a of x_i ~ sum a_k x_{i-k}; none where there are too few samples to fit them.
  [[nodiscard]] std::vector<double> autoregression();

 private:
  void close_recording();

  std::array<double, kAutoregressionOrder + 1> pooled_{};
  std::array<double, kAutoregressionOrder + 1> own_{};
  Recent recent_;
  std::size_t taken_ = 0;
  double samples_ = 0.0;
};

}  // namespace driftlab::investigate
