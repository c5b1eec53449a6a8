#pragma once
/// The inner loops of the variances, in the widest instruction set that the processor has.
///
/// All versions are compiled from one source (kernels_body.inc). Sums run in sixteen or eight lanes whose order of
/// additions is fixed, without fused multiply-add, so every version gives the same bits. The portable version serves
/// other processors and compilers.
#include <cstddef>
#include <cstdint>

namespace driftlab {

struct Kernels {
  /// next[i] = now[i] + now[i - m]; the sum of (now[i] - now[i - m])^2 over i >= first.
  double (*pyramid_step)(const double* now, std::size_t m, double* next, std::size_t first, std::size_t count);
  /// Two such steps, the second of 2 m on the sums of the first: next[i] = now[i] + now[i - m] + now[i - 2m] +
  /// now[i - 3m]; the sums of squares of step k over i >= first[k] are added to power[k]. first[0] <= first[1].
  void (*pyramid_pair)(const double* now, std::size_t m, double* next, const std::size_t* first, std::size_t count,
                       double* power);
  /// out[i] = base + (inside + sum of x[0] - pivot .. x[i] - pivot); the last bracket.
  double (*prefix_block)(const double* x, std::size_t count, double pivot, double base, double inside, double* out);
  /// For level k of `levels`, offset m 2^k: the sum over i of (now[i] - 2 now[i - m 2^k] + now[i - m 2^(k+1)])^2, added
  /// to power[k].
  void (*octave_powers)(const double* now, std::size_t m, std::size_t levels, std::size_t count, double* power);
  /// Sum of (a[i] - 2 b[i] + c[i])^2.
  double (*second_difference_power)(const double* a, const double* b, const double* c, std::size_t count);
  /// Sum over i of (now[i] - 3 now[i - m] + 3 now[i - 2m] - now[i - 3m])^2.
  double (*third_difference_power)(const double* now, std::size_t m, std::size_t count);
  /// Sum of u (1 - u bound)^4 over the u below 1/bound.
  double (*biweight_sum)(const double* u, std::size_t count, double bound);
  /// With t = u bound: adds the sums of t, t^2, .. t^5 over the t below 1 to power[0 .. 4], writes the t from 1 up to
  /// `reach` to `between`, which has room for count + 1, and returns how many these are.
  std::size_t (*biweight_powers)(const double* u, std::size_t count, double bound, double reach, double* power,
                                 double* between);
  /// out = lower right, column after column: rows x rows, zero above the diagonal, times rows x columns.
  void (*lower_product)(const double* lower, std::size_t rows, const double* right, std::size_t columns, double* out);
  /// out = a' a of a rows x columns matrix, column after column.
  void (*gram)(const double* a, std::size_t rows, std::size_t columns, double* out);
  /// out[i] = (a[i] - 2 b[i] + c[i])^2 scale.
  void (*square_second_differences)(const double* a, const double* b, const double* c, std::size_t count, double scale,
                                    double* out);
  /// For each of the pairs of rows one after the other, lane by lane: the lower value to the first row, the other to
  /// the second. A row is kWindowsAtOnce values.
  void (*exchange)(double* rows, const std::uint16_t* pair, std::size_t pairs);
};

/// Lanes of `exchange`.
inline constexpr std::size_t kWindowsAtOnce = 8;

/// The version for this processor; chosen once.
[[nodiscard]] const Kernels& kernels();

/// The portable version, for comparison.
[[nodiscard]] const Kernels& portable_kernels();

}  // namespace driftlab
