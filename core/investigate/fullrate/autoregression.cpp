#include "core/investigate/fullrate/autoregression.hpp"

#include <algorithm>

namespace driftlab::investigate {

void PooledAutocovariance::begin_recording() {
  close_recording();
  recent_ = {};
  taken_ = 0;
}

void PooledAutocovariance::close_recording() {
  for (std::size_t lag = 0; lag < own_.size(); ++lag) {
    pooled_[lag] += own_[lag];
  }
  own_ = {};
}

void PooledAutocovariance::take(double value, bool used) {
  const double x = used ? std::clamp(value, -4.0, 4.0) : 0.0;
  samples_ += used ? 1.0 : 0.0;
  own_[0] += x * x;
  for (std::size_t lag = 1; lag <= std::min(taken_, kAutoregressionOrder); ++lag) {
    own_[lag] += x * recent_[lag];
  }
  recent_.push(x);
  ++taken_;
}

std::vector<double> PooledAutocovariance::autoregression() {
  close_recording();
  std::vector<double> a(kAutoregressionOrder, 0.0);
  if (!(pooled_[0] > 0.0) || samples_ < 50.0 * kAutoregressionOrder) {
    return {};
  }
  double error = pooled_[0];
  for (std::size_t k = 0; k < kAutoregressionOrder; ++k) {
    double reflection = pooled_[k + 1];
    for (std::size_t j = 0; j < k; ++j) {
      reflection -= a[j] * pooled_[k - j];
    }
    reflection /= error;
    std::vector<double> next = a;
    next[k] = reflection;
    for (std::size_t j = 0; j < k; ++j) {
      next[j] = a[j] - reflection * a[k - 1 - j];
    }
    a = next;
    error *= 1.0 - reflection * reflection;
  }
  return a;
}

}  // namespace driftlab::investigate
