#pragma once
/// An autoregression of fixed order that whitens what a model has left coloured.
///
/// The autocovariance is pooled over all recordings, the coefficients follow by Levinson's recursion (Durbin 1960).
/// Gross values would stretch the covariance; clipping at 4 standard deviations changes a Gaussian one by 1e-4.
#include <array>
#include <cstddef>
#include <vector>

namespace driftlab::investigate {

/// Chosen, not measured: what a filter colours is taken to be over within 24 samples; each order costs a product a
/// sample.
inline constexpr std::size_t kAutoregressionOrder = 24;

/// The last values of a walk through a series.
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
