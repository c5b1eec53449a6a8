#pragma once
/// The verdict on one change (spec/regression.md, sections 1 and 6).
///
///   fail          if lower > margin for any test
///   pass          else, if upper < margin for all gated tests
///   inconclusive  else
///
/// Pass needs every gated test at its own level (intersection-union): no correction. Fail is a union: corrected once,
/// by c_max. Each of pass and fail is a claim that is wrong in at most 5 % of the runs whose truth contradicts it.
#include "core/campaign/regression/critical.hpp"

#include <stop_token>
#include <string_view>
#include <vector>

namespace driftlab::regression {

enum class Verdict { Pass, Fail, Inconclusive };
enum class Finding {
  Ok,                 ///< upper < margin
  WorseWithinMargin,  ///< upper < margin, lower > 0
  Beyond,             ///< lower > margin, or what else the settings let fail
  Open,               ///< neither
  Improved,           ///< theta + c_max se < 0
};

[[nodiscard]] std::string_view name_of(Verdict verdict);
[[nodiscard]] std::string_view name_of(Finding finding);

struct Outcome {
  double lower = 0.0;       ///< theta - c_max se
  double upper = 0.0;       ///< theta + c_max se
  double upper_one = 0.0;   ///< theta + c_1 se
  double p_adjusted = 1.0;  ///< share of draws whose largest Z/se exceeds (theta - margin)/se
  Finding finding = Finding::Open;
};

struct Comparison {
  SessionScatter scatter;
  Contrast contrast;
  double c_max = 0.0;
  double c_1 = 0.0;
  Gate gate;
  std::vector<Outcome> outcomes;  ///< per test
  Verdict verdict = Verdict::Inconclusive;
  bool worse_shown = false;  ///< lower > 0 somewhere
  Needs needs;               ///< of an inconclusive comparison
};

/// The whole comparison of noise. Deterministic in design and settings; the order of the sessions changes nothing but
/// rounding. Without a test that both arms have the verdict is inconclusive. Cost at 6 axes of 13 scales: some 50 ms.
/// Once `stop` is requested it ends soon, with a result that must not be used.
[[nodiscard]] Comparison compare(const Design& design, const TestSettings& settings, const std::stop_token& stop = {});

}  // namespace driftlab::regression
