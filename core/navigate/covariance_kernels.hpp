#pragma once
/// The loops of the error covariance, for rows of a length that the compiler knows: once for any processor and once for
/// those with AVX2. Both give the same to the bit (tests/unit/navigate/error_covariance_test.cpp).
#include "core/navigate/error_covariance.hpp"

#include <cstddef>

namespace driftlab::covariance_kernels {

using Matrix9 = ErrorCovariance::Navigation;

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

inline bool has_avx2() {
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
}
#else
template <int S>
using WideKernel = Kernel<S>;

inline bool has_avx2() { return false; }
#endif

}  // namespace driftlab::covariance_kernels
