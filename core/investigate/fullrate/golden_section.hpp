#pragma once
/// Golden-section search for the maximum of a function of one variable (Kiefer 1953).

namespace driftlab::investigate {

/// Where f is largest in [low, high], f unimodal there; each step shortens the bracket by 0.618. Costs steps + 2
/// values.
template <class F>
[[nodiscard]] double golden_section(double low, double high, int steps, const F& f) {
  constexpr double kGolden = 0.6180339887498949;
  double a = high - kGolden * (high - low);
  double b = low + kGolden * (high - low);
  double fa = f(a);
  double fb = f(b);
  for (int i = 0; i < steps; ++i) {
    if (fa > fb) {
      high = b;
      b = a;
      fb = fa;
      a = high - kGolden * (high - low);
      fa = f(a);
    } else {
      low = a;
      a = b;
      fa = fb;
      b = low + kGolden * (high - low);
      fb = f(b);
    }
  }
  return 0.5 * (low + high);
}

}  // namespace driftlab::investigate
