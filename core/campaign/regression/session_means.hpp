#pragma once
/// Whether a figure of which each session has one value (a bias, a scale factor) moved with the change by more than a
/// margin.
///
/// How much such a figure moves from one power-up to the next differs by orders of magnitude between sensors, so there
/// is no prior for it: it is tested only where a margin and three sessions an arm are given, else reported. The test is
/// that of Welch (1947),
/// Biometrika 34, 28: with d the difference of the arms' means of session figures and se^2 = s_1^2/n + s_2^2/m, more
/// than the margin is shown where P(T > (|d| - margin)/se), T Student's with the degrees of freedom of Welch and
/// Satterthwaite, times the number of units (Bonferroni; for the smallest p it is Holm) is at most the level.
/// Internal to core/campaign/regression.
#include "core/campaign/regression/event_checks.hpp"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace driftlab::regression {

/// The figures of one unit, one for each session that has it [SI].
struct ArmFigures {
  std::vector<double> baseline;
  std::vector<double> candidate;
  bool gyroscope = false;
  [[nodiscard]] double difference() const;  ///< mean of the candidate less that of the baseline
};

using FiguresByUnit = std::map<std::string, ArmFigures>;

struct SessionFigure {
  double value = 0.0;
  bool gyroscope = false;
};

/// For each unit that both arms have, the figure that `of` finds in each session.
[[nodiscard]] FiguresByUnit arm_figures(const std::vector<PowerUp>& baseline, const std::vector<PowerUp>& candidate,
                                        const std::function<std::map<std::string, SessionFigure>(const PowerUp&)>& of);

/// The words of a check of such figures: its name, and the parts of its sentence.
struct ShiftWords {
  std::string check;    ///< `bias`
  std::string figure;   ///< "bias"
  std::string without;  ///< why a set margin is not tested where no session of both arms has such a figure
  std::function<std::string(double value, bool gyroscope)> text;  ///< with its unit, without a sign in front
};

struct ShiftMargins {
  double gyroscope = 0.0;  ///< [SI]; 0: told and not tested
  double accelerometer = 0.0;
};

/// Fail where more than the margin is shown; note where a margin cannot be tested; else fine, with a sentence on the
/// largest move. `level`: of this test in this look.
[[nodiscard]] EventCheck check_shift(const FiguresByUnit& figures, const std::vector<PowerUp>& candidate,
                                     const ShiftMargins& margins, const ShiftWords& words, double level);

}  // namespace driftlab::regression
