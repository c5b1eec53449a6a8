#include "core/navigate/error_covariance.hpp"

#include "core/navigate/covariance_kernels.hpp"

#include <cassert>
#include <type_traits>

namespace driftlab {
namespace {

/// Calls `f` with the kernel of this stride that suits the processor.
template <class Function>
void with_kernel(int stride, const Function& f) {
  using covariance_kernels::has_avx2;
  using covariance_kernels::Kernel;
  using covariance_kernels::WideKernel;
  const auto of = [&]<int S>(std::integral_constant<int, S>) { has_avx2() ? f(WideKernel<S>{}) : f(Kernel<S>{}); };
  switch (stride) {
    case 12:
      return of(std::integral_constant<int, 12>{});
    case 16:
      return of(std::integral_constant<int, 16>{});
    case 24:
      return of(std::integral_constant<int, 24>{});
    default:
      return of(std::integral_constant<int, kMaxSensorStates>{});
  }
}

int stride_for(int states) { return states <= 12 ? 12 : states <= 16 ? 16 : states <= 24 ? 24 : kMaxSensorStates; }

}  // namespace

ErrorCovariance::ErrorCovariance(int sensor_states)
    : sensor_states_(sensor_states), stride_(stride_for(sensor_states)) {
  assert(sensor_states <= kMaxSensorStates);
}

Eigen::MatrixXd ErrorCovariance::dense() const {
  const Eigen::Index n = 9 + sensor_states_;
  Eigen::MatrixXd whole(n, n);
  whole.topLeftCorner<9, 9>() = nn_;
  for (int j = 0; j < sensor_states_; ++j) {
    for (int i = 0; i < 9; ++i) {
      whole(i, 9 + j) = ns_[at(i, j)];
      whole(9 + j, i) = ns_[at(i, j)];
    }
    for (int i = 0; i < sensor_states_; ++i) {
      whole(9 + i, 9 + j) = ss_[at(i, j)];
    }
  }
  return whole;
}

void ErrorCovariance::propagate(const NavigationTransition& navigation, const SensorTransition& sensors) {
  with_kernel(stride_, [&](auto kernel) {
    decltype(kernel)::propagate(navigation, sensors.gain.data(), sensors.phi.data(), nn_, ns_.data(), ss_.data());
  });
}

void ErrorCovariance::mix(int first, const Eigen::Ref<const Eigen::MatrixXd>& block) {
  using Strided =
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0, Eigen::OuterStride<>>;
  const Eigen::Index n = block.rows();
  Strided cross(ns_.data(), 9, stride_, Eigen::OuterStride<>(stride_));
  cross.middleCols(first, n) = (cross.middleCols(first, n) * block.transpose()).eval();
  Strided square(ss_.data(), stride_, stride_, Eigen::OuterStride<>(stride_));
  square.middleRows(first, n) = (block * square.middleRows(first, n)).eval();
  square.middleCols(first, n) = (square.middleCols(first, n) * block.transpose()).eval();
  for (int i = 0; i < stride_; ++i) {
    for (int j = 0; j < i; ++j) {
      const double mean = 0.5 * (square(i, j) + square(j, i));
      square(i, j) = mean;
      square(j, i) = mean;
    }
  }
}

void ErrorCovariance::add_noise(const SensorTransition& sensors) {
  nn_ += sensors.noise;
  for (std::size_t i = 0; i < 9 * static_cast<std::size_t>(stride_); ++i) {
    ns_[i] += sensors.cross_noise[i];
  }
}

ScalarInnovation ErrorCovariance::update(const ScalarMeasurement& measurement, State& state) {
  ScalarInnovation innovation;
  with_kernel(stride_, [&](auto kernel) {
    innovation = decltype(kernel)::update(measurement, nn_, ns_.data(), ss_.data(), state.data());
  });
  return innovation;
}

ErrorCovariance::State ErrorCovariance::times(const WideMeasurement& measurement) const {
  const Eigen::Matrix<double, 9, 1>& h = measurement.navigation.h;
  State product = State::Zero();
  product.head<9>() = nn_.lazyProduct(h);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < sensor_states_; ++j) {
      product(9 + j) += h(i) * ns_[at(i, j)];
    }
  }
  for (std::size_t k = 0; k < measurement.count; ++k) {
    const int own = measurement.index[k];
    const double weight = measurement.weight[k];
    for (int i = 0; i < 9; ++i) {
      product(i) += weight * ns_[at(i, own)];
    }
    for (int j = 0; j < sensor_states_; ++j) {
      product(9 + j) += weight * ss_[at(own, j)];
    }
  }
  return product;
}

namespace {

/// h . x over navigation and sensor states.
double projected(const WideMeasurement& measurement, const ErrorCovariance::State& x) {
  double sum = measurement.navigation.h.dot(x.head<9>());
  for (std::size_t k = 0; k < measurement.count; ++k) {
    sum += measurement.weight[k] * x(9 + measurement.index[k]);
  }
  return sum;
}

}  // namespace

ScalarInnovation ErrorCovariance::expected(const WideMeasurement& measurement, const State& state) const {
  return {measurement.navigation.innovation - projected(measurement, state),
          projected(measurement, times(measurement)) + measurement.navigation.variance};
}

ScalarInnovation ErrorCovariance::update(const WideMeasurement& measurement, State& state) {
  if (measurement.count == 0) {
    return update(measurement.navigation, state);
  }
  const State p = times(measurement);
  const ScalarInnovation innovation{measurement.navigation.innovation - projected(measurement, state),
                                    projected(measurement, p) + measurement.navigation.variance};
  const Eigen::Index n = 9 + sensor_states_;
  const State k = p / innovation.variance;
  state.head(n) += innovation.value * k.head(n);
  // Joseph's form as in Kernel::update, its two corrections of rank one after the other.
  const auto correct = [&](const State& a, const State& b, double factor) {
    const auto both = [&](Eigen::Index i, Eigen::Index j) { return 0.5 * factor * (a(i) * b(j) + b(i) * a(j)); };
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        nn_(i, j) += both(i, j);
      }
      for (int j = 0; j < sensor_states_; ++j) {
        ns_[at(i, j)] += both(i, 9 + j);
      }
    }
    for (int i = 0; i < sensor_states_; ++i) {
      for (int j = 0; j < sensor_states_; ++j) {
        ss_[at(i, j)] += both(9 + i, 9 + j);
      }
    }
  };
  correct(k, p, -1.0);
  correct(k, times(measurement), -1.0);
  correct(k, k, measurement.navigation.variance);
  return innovation;
}

}  // namespace driftlab
