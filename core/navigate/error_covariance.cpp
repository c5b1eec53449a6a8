#include "core/navigate/error_covariance.hpp"

#include <cassert>
#include <type_traits>

namespace driftlab {
namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;

/// Everything of a row length S that the compiler knows: plain loops over rows, which unroll and vectorise. Rows of the
/// nine navigation states lie one behind the other, S numbers each.
template <int S>
struct Kernel {
  static constexpr std::ptrdiff_t kRow = S;

  /// out = x + a y.
  static void combine(double* __restrict out, const double* __restrict x, double a, const double* __restrict y) {
    for (int j = 0; j < S; ++j) {
      out[j] = x[j] + a * y[j];
    }
  }
  /// out += a x + b y.
  static void add(double* __restrict out, double a, const double* __restrict x, double b, const double* __restrict y) {
    for (int j = 0; j < S; ++j) {
      out[j] += a * x[j] + b * y[j];
    }
  }

  /// out = F x for nine rows; `out` is not `x`.
  static void apply_navigation(const NavigationTransition& f, const double* x, double* out) {
    const double t = f.step_s;
    const double turn = kEarthRate * t;
    const Vector3& v = f.velocity;
    const Vector3& p = f.position;
    const double* const r0 = x;
    const double* const r1 = x + S;
    const double* const r2 = x + 2 * kRow;
    const double* const v0 = x + 3 * kRow;
    const double* const v1 = x + 4 * kRow;
    const double* const v2 = x + 5 * kRow;
    const double* const a0 = x + 6 * kRow;
    const double* const a1 = x + 7 * kRow;
    const double* const a2 = x + 8 * kRow;
    combine(out, r0, t, v0);
    add(out, p.z(), a1, -p.y(), a2);
    combine(out + S, r1, t, v1);
    add(out + S, -p.z(), a0, p.x(), a2);
    combine(out + 2 * kRow, r2, t, v2);
    add(out + 2 * kRow, p.y(), a0, -p.x(), a1);
    const Matrix3& g = f.gravity_step;
    combine(out + 3 * kRow, v0, 2.0 * turn, v1);
    add(out + 3 * kRow, v.z(), a1, -v.y(), a2);
    combine(out + 4 * kRow, v1, -2.0 * turn, v0);
    add(out + 4 * kRow, -v.z(), a0, v.x(), a2);
    combine(out + 5 * kRow, v2, g(2, 2), r2);
    add(out + 5 * kRow, v.y(), a0, -v.x(), a1);
    add(out + 5 * kRow, g(2, 0), r0, g(2, 1), r1);
    for (int i = 0; i < 2; ++i) {
      add(out + (3 + i) * kRow, g(i, 0), r0, g(i, 1), r1);
      add(out + (3 + i) * kRow, g(i, 2), r2, 0.0, r2);
    }
    combine(out + 6 * kRow, a0, turn, a1);
    combine(out + 7 * kRow, a1, -turn, a0);
    for (int j = 0; j < S; ++j) {
      out[8 * kRow + j] = a2[j];
    }
  }

  /// out(9 x 9) = a b^T for nine rows each. Sums run over S in one order.
  static void outer(const double* __restrict a, const double* __restrict b, double* __restrict out) {
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        double even = 0.0;
        double odd = 0.0;
        for (int k = 0; k < S; k += 2) {
          even += a[i * S + k] * b[j * S + k];
          odd += a[i * S + k + 1] * b[j * S + k + 1];
        }
        out[9 * i + j] = even + odd;
      }
    }
  }

  static void propagate(const NavigationTransition& f, const double* __restrict gain, const double* __restrict phi,
                        Matrix9& nn, double* __restrict ns, double* __restrict ss) {
    alignas(32) double through[9 * kRow];  // F P_ns
    apply_navigation(f, ns, through);
    alignas(32) double half[9 * kRow];  // F P_ns + B P_ss / 2
    for (int i = 0; i < 9; ++i) {
      alignas(32) double fed[S] = {};  // row of B P_ss
      for (int k = 0; k < S; ++k) {
        const double b = gain[i * S + k];
        for (int j = 0; j < S; ++j) {
          fed[j] += b * ss[k * S + j];
        }
      }
      for (int j = 0; j < S; ++j) {
        half[i * S + j] = through[i * S + j] + 0.5 * fed[j];
        ns[i * S + j] = (through[i * S + j] + fed[j]) * phi[j];
      }
    }
    // F P_nn F^T + F P_ns B^T + B P_ns^T F^T + B P_ss B^T, the last three as X B^T + B X^T with X = half.
    double cross[81];
    outer(half, gain, cross);
    propagate_navigation(f, cross, nn);
    for (int i = 0; i < S; ++i) {
      for (int j = 0; j < S; ++j) {
        ss[i * S + j] *= phi[i] * phi[j];
      }
    }
  }

  /// nn = F nn F^T + cross + cross^T.
  static void propagate_navigation(const NavigationTransition& f, const double* cross, Matrix9& nn) {
    double once[81];
    double turned[81];
    double twice[81];
    Kernel<9>::apply_navigation(f, nn.data(), once);  // nn is symmetric: rows are columns
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        turned[9 * j + i] = once[9 * i + j];
      }
    }
    Kernel<9>::apply_navigation(f, turned, twice);
    for (int i = 0; i < 9; ++i) {
      for (int j = i; j < 9; ++j) {
        nn(i, j) = twice[9 * i + j] + (cross[9 * i + j] + cross[9 * j + i]);
        nn(j, i) = nn(i, j);
      }
    }
  }

  /// out = h^T x for nine rows.
  static void weighted(const Eigen::Matrix<double, 9, 1>& h, const double* __restrict x, double* __restrict out) {
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < S; ++j) {
        out[j] += h(i) * x[i * S + j];
      }
    }
  }

  static ScalarInnovation update(const ScalarMeasurement& m, Matrix9& nn, double* __restrict ns, double* __restrict ss,
                                 double* __restrict state) {
    const Eigen::Matrix<double, 9, 1> pn = nn.lazyProduct(m.h);
    alignas(32) double ps[S] = {};
    weighted(m.h, ns, ps);
    const double s = m.h.dot(pn) + m.variance;
    double expected = 0.0;
    for (int i = 0; i < 9; ++i) {
      expected += m.h(i) * state[i];
    }
    const double rest = m.innovation - expected;
    const Eigen::Matrix<double, 9, 1> kn = pn / s;
    alignas(32) double ks[S];
    for (int i = 0; i < 9; ++i) {
      state[i] += rest * kn(i);
    }
    for (int j = 0; j < S; ++j) {
      ks[j] = ps[j] / s;
      state[9 + j] += rest * ks[j];
    }
    // Joseph's form for one measurement (Bierman 1977): M = P - k (P h)^T, then M - (M h) k^T + R k k^T, with M h
    // summed from M as it was rounded. Products of two vectors are means of both orders, so that P stays symmetric.
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        nn(i, j) -= 0.5 * (kn(i) * pn(j) + pn(i) * kn(j));
      }
      for (int j = 0; j < S; ++j) {
        ns[i * S + j] -= 0.5 * (kn(i) * ps[j] + pn(i) * ks[j]);
      }
    }
    const Eigen::Matrix<double, 9, 1> mn = nn.lazyProduct(m.h);
    alignas(32) double ms[S] = {};
    weighted(m.h, ns, ms);
    const double r = m.variance;
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        nn(i, j) = (nn(i, j) - 0.5 * (mn(i) * kn(j) + kn(i) * mn(j))) + r * (kn(i) * kn(j));
      }
      for (int j = 0; j < S; ++j) {
        ns[i * S + j] = (ns[i * S + j] - 0.5 * (mn(i) * ks[j] + kn(i) * ms[j])) + r * (kn(i) * ks[j]);
      }
    }
    for (int i = 0; i < S; ++i) {
      for (int j = 0; j < S; ++j) {
        const double once = ss[i * S + j] - 0.5 * (ks[i] * ps[j] + ps[i] * ks[j]);
        ss[i * S + j] = (once - 0.5 * (ms[i] * ks[j] + ks[i] * ms[j])) + r * (ks[i] * ks[j]);
      }
    }
    return {rest, s};
  }
};

#if defined(__x86_64__) && defined(__GNUC__)
/// The same loops for processors with AVX2, four numbers at once. Sums run in the same order and no product is fused
/// into a sum (-ffp-contract=off), so that results are those of Kernel to the bit.
template <int S>
struct WideKernel {
  [[gnu::target("avx2"), gnu::flatten]] static void propagate(const NavigationTransition& f, const double* gain,
                                                              const double* phi, Matrix9& nn, double* ns, double* ss) {
    Kernel<S>::propagate(f, gain, phi, nn, ns, ss);
  }
  [[gnu::target("avx2"), gnu::flatten]] static ScalarInnovation update(const ScalarMeasurement& m, Matrix9& nn,
                                                                       double* ns, double* ss, double* state) {
    return Kernel<S>::update(m, nn, ns, ss, state);
  }
};

bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#else
template <int S>
using WideKernel = Kernel<S>;

bool has_avx2() { return false; }
#endif

/// Calls `f` with the kernel of this stride that suits the processor.
template <class Function>
void with_kernel(int stride, const Function& f) {
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
