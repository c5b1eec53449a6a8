#include "core/variance/kernels.hpp"

#include <array>
#include <cstring>

// NOLINTBEGIN(cppcoreguidelines-init-variables): vector types
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define DRIFTLAB_HAS_VERSIONS 1
#include <immintrin.h>
#else
#define DRIFTLAB_HAS_VERSIONS 0
#endif

namespace driftlab {
namespace {

namespace portable {
constexpr std::size_t kWidth = 2;
using Register = double __attribute__((vector_size(kWidth * sizeof(double))));
inline Register load(const double* from) {
  Register value;
  std::memcpy(&value, from, sizeof value);  // one unaligned move
  return value;
}
inline void store(double* to, const Register& value) { std::memcpy(to, &value, sizeof value); }

/// Running sums by eights, in the order of additions that two registers of four make: within four x0, x0 + x1,
/// (x0 + x1) + x2, (x0 + x1) + (x2 + x3); the second four on top of the first four's total.
inline double scan_eights(const double* x, std::size_t eights, double pivot, double base, double inside, double* out) {
  for (std::size_t i = 0; i < 8 * eights; i += 8) {
    std::array<double, 8> sum;  // NOLINT: written below
    for (std::size_t half = 0; half < 8; half += 4) {
      const double a = x[i + half] - pivot;
      const double b = a + (x[i + half + 1] - pivot);
      const double c = x[i + half + 2] - pivot;
      sum[half] = a;
      sum[half + 1] = b;
      sum[half + 2] = c + b;
      sum[half + 3] = (c + (x[i + half + 3] - pivot)) + b;
    }
    for (std::size_t k = 0; k < 8; ++k) {
      const double within = k < 4 ? sum[k] : sum[3] + sum[k];
      out[i + k] = base + (inside + within);
      sum[k] = within;
    }
    inside += sum[7];
  }
  return inside;
}
#include "core/variance/kernels_body.inc"
}  // namespace portable

#if DRIFTLAB_HAS_VERSIONS
#pragma GCC push_options
#pragma GCC target("avx2")
namespace avx2 {
constexpr std::size_t kWidth = 4;
using Register = __m256d;
// Not memcpy: GCC moves 32 bytes in two halves through the stack, which costs five times the arithmetic.
inline Register load(const double* from) { return _mm256_loadu_pd(from); }
inline void store(double* to, const Register& value) { _mm256_storeu_pd(to, value); }

inline Register scan_four(const Register& x) {
  const Register zero = _mm256_setzero_pd();
  const Register pairs = x + _mm256_unpacklo_pd(zero, x);
  return pairs + _mm256_blend_pd(zero, _mm256_permute4x64_pd(pairs, 0x55), 0b1100);
}
inline double scan_eights(const double* x, std::size_t eights, double pivot, double base, double inside, double* out) {
  const Register centre = _mm256_set1_pd(pivot);
  const Register offset = _mm256_set1_pd(base);
  Register running = _mm256_set1_pd(inside);
  for (std::size_t i = 0; i < 8 * eights; i += 8) {
    const Register low = scan_four(load(x + i) - centre);
    const Register high = _mm256_permute4x64_pd(low, 0xFF) + scan_four(load(x + i + 4) - centre);
    store(out + i, offset + (running + low));
    store(out + i + 4, offset + (running + high));
    running += _mm256_permute4x64_pd(high, 0xFF);
  }
  return running[0];
}
#include "core/variance/kernels_body.inc"
}  // namespace avx2
#pragma GCC pop_options

#pragma GCC push_options
#pragma GCC target("avx2,avx512f")
namespace avx512 {
constexpr std::size_t kWidth = 8;
using Register = __m512d;
inline Register load(const double* from) { return _mm512_loadu_pd(from); }
inline void store(double* to, const Register& value) { _mm512_storeu_pd(to, value); }

/// In registers of four: running sums are made by fours on every machine.
inline __m256d scan_four(const __m256d& x) {
  const __m256d zero = _mm256_setzero_pd();
  const __m256d pairs = x + _mm256_unpacklo_pd(zero, x);
  return pairs + _mm256_blend_pd(zero, _mm256_permute4x64_pd(pairs, 0x55), 0b1100);
}
inline double scan_eights(const double* x, std::size_t eights, double pivot, double base, double inside, double* out) {
  const __m256d centre = _mm256_set1_pd(pivot);
  const __m256d offset = _mm256_set1_pd(base);
  __m256d running = _mm256_set1_pd(inside);
  for (std::size_t i = 0; i < 8 * eights; i += 8) {
    const __m256d low = scan_four(_mm256_loadu_pd(x + i) - centre);
    const __m256d high = _mm256_permute4x64_pd(low, 0xFF) + scan_four(_mm256_loadu_pd(x + i + 4) - centre);
    _mm256_storeu_pd(out + i, offset + (running + low));
    _mm256_storeu_pd(out + i + 4, offset + (running + high));
    running += _mm256_permute4x64_pd(high, 0xFF);
  }
  return running[0];
}
#include "core/variance/kernels_body.inc"
}  // namespace avx512
#pragma GCC pop_options
#endif
// NOLINTEND(cppcoreguidelines-init-variables)

const Kernels& choose() {
#if DRIFTLAB_HAS_VERSIONS
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx2")) {
    return avx512::kKernels;
  }
  if (__builtin_cpu_supports("avx2")) {
    return avx2::kKernels;
  }
#endif
  return portable::kKernels;
}

}  // namespace

const Kernels& kernels() {
  static const Kernels& chosen = choose();
  return chosen;
}

const Kernels& portable_kernels() { return portable::kKernels; }

}  // namespace driftlab
