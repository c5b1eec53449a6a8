#pragma once
/// The inner loops of the variances, in the widest instruction set the processor has.
///
/// All versions are one source (kernels_body.inc): sums run in sixteen lanes whose order of additions is fixed, without
/// fused multiply-add, so the bits are the same in every version; the portable one is what other processors and
/// compilers use.
#include <cstddef>

namespace driftlab {

struct Kernels {
  /// next[i] = now[i] + before[i]; the sum of (now[i] - before[i])^2 over i >= first.
  double (*pyramid_step)(const double* now, const double* before, double* next, std::size_t first, std::size_t count);
  /// For level k of `levels`, offset m 2^k: the sum over i of (now[i] - 2 now[i - m 2^k] + now[i - m 2^(k+1)])^2, added
  /// to power[k].
  void (*octave_powers)(const double* now, std::size_t m, std::size_t levels, std::size_t count, double* power);
  /// Sum of u (1 - u bound)^4 over the u below 1/bound.
  double (*biweight_sum)(const double* u, std::size_t count, double bound);
  /// out[i] = (a[i] - 2 b[i] + c[i])^2 scale.
  void (*square_second_differences)(const double* a, const double* b, const double* c, std::size_t count, double scale,
                                    double* out);
};

/// The version for this processor; chosen once.
[[nodiscard]] const Kernels& kernels();

/// The portable version, for comparison.
[[nodiscard]] const Kernels& portable_kernels();

}  // namespace driftlab
