/// The sentences of a regression run, made once for every output (spec/regression.md, section 9).
#include "core/campaign/regression/report.hpp"
#include "core/signal/short_name.hpp"
#include "core/signal/sort_keeping_ties.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

namespace driftlab::regression {
namespace {

constexpr double kOnTheMargin = 0.02;

template <class... Arguments>
std::string written(const char* format, Arguments... arguments) {
  std::array<char, 256> buffer{};
  const int length = std::snprintf(buffer.data(), buffer.size(), format, arguments...);
  return {buffer.data(), std::min(static_cast<std::size_t>(length), buffer.size() - 1)};
}

double percent_of(double ln_deviation) { return 100.0 * std::expm1(ln_deviation); }

std::string place_of(const ToldTest& told) {
  return told.test->name.empty() ? " at " + duration_text(told.test->test.tau_s)
                                 : " in " + told.test->name.substr(told.test->name.find('.') + 1);
}

/// Of the tests that `is` holds for, the one with the largest `score`.
template <class Is, class Score>
ToldTest largest(const Report& report, const Is& is, const Score& score) {
  ToldTest best;
  for (const UnitReport& unit : report.units) {
    for (const ScaleReport& test : unit.tests) {
      if (is(test) && (best.test == nullptr || score(test) > score(*best.test))) {
        best = {&unit, &test};
      }
    }
  }
  return best;
}

std::string worse_sentence(const ToldTest& told) {
  const ScaleReport& test = *told.test;
  return short_sensor_name(told.unit->name) + (test.theta >= 0.0 ? " is worse: " : " changed: ") +
         interval_text(test.theta, test.outcome.lower, test.outcome.upper) + place_of(told) + ", margin " +
         written("%.3g %%.", percent_of(test.test.margin));
}

std::string pass_sentence(const Report& report) {
  std::string margins;
  for (const char* const sensor : {"gyroscope", "accelerometer"}) {
    const bool present = std::any_of(report.units.begin(), report.units.end(),
                                     [&](const UnitReport& unit) { return unit.sensor == sensor; });
    if (present) {
      const bool gyroscope = sensor == std::string("gyroscope");
      margins += (margins.empty() ? "" : " and ") +
                 written("%.3g %% (%s)",
                         gyroscope ? report.settings.gyroscope.percent[0] : report.settings.accelerometer.percent[0],
                         gyroscope ? "gyro" : "accel");
    }
  }
  return "No worse than " + margins + " to " + duration_text(report.scope_s) + ", " +
         with_count(report.units.size(), "axis", "axes") + ", " +
         with_count(report.candidate.sessions.size(), "session") + " against " +
         std::to_string(report.baseline.sessions.size()) + ".";
}

bool is_open(const ScaleReport& test) { return test.gated && test.outcome.upper_one >= test.test.margin; }

bool is_on_the_margin(const ToldTest& open) {
  return open.test != nullptr && std::abs(open.test->theta - open.test->test.margin) < kOnTheMargin;
}

std::string needs_sentence(const Report& report, const ToldTest& open) {
  if (is_on_the_margin(open)) {
    return short_sensor_name(open.unit->name) +
           " sits on the margin; no affordable recording decides; the margin does.";
  }
  const Needs& needs = report.comparison.needs;
  const std::string length = report.needed_length_s ? duration_text(*report.needed_length_s) : std::string();
  const std::string longer = length.empty() ? "" : "sessions of " + length;
  if (needs.sessions_per_arm) {
    return with_count(*needs.sessions_per_arm, "session") + " an arm decide; " +
           (longer.empty() ? "longer recordings do not." : "so do " + longer + ".");
  }
  return longer.empty() ? "Neither more sessions (to 30) nor longer ones (to 64 times) decide."
                        : "Sessions of " + length + " decide.";
}

std::string undecided_sentence(const Report& report, const ToldTest& open) {
  const std::string head = report.leaning_worse ? "Undecided, leaning worse: " : "Undecided: ";
  if (!report.comparability.empty()) {
    return head + report.comparability.front().sentence;
  }
  if (open.test == nullptr) {
    return head + "nothing could be compared.";
  }
  return head + short_sensor_name(open.unit->name) +
         written(" could be up to %+.0f %% worse", percent_of(open.test->outcome.upper_one)) + place_of(open) +
         written(" (margin %.3g %%).", percent_of(open.test->test.margin));
}

void note_structures(Report& report) {
  for (const UnitReport& unit : report.units) {
    if (unit.model.empty() || unit.structure_test.compared) {
      continue;
    }
    const bool moved = unit.structure[0] != unit.structure[1];
    report.notes.push_back(short_sensor_name(unit.name) + ": " +
                           (moved ? "structure changed (" + unit.structure[0] + " to " + unit.structure[1] + ")"
                                  : "no fitted model describes both arms (" + unit.model + ")") +
                           ": parameters are not compared, scales are.");
  }
}

void note_improvement(Report& report) {
  const ToldTest best = largest(
      report, [](const ScaleReport& test) { return test.outcome.finding == Finding::Improved; },
      [](const ScaleReport& test) { return -test.theta; });
  if (best.test == nullptr) {
    return;
  }
  const bool much = best.test->theta < -best.test->test.margin && best.test->test.tau_s <= 1.0;
  report.notes.push_back(short_sensor_name(best.unit->name) + " improved: " +
                         interval_text(best.test->theta, best.test->outcome.lower, best.test->outcome.upper) +
                         place_of(best) + (much ? "; check filter bandwidth and scale." : "."));
}

void note_scatter(Report& report) {
  if (report.comparison.scatter.contrasts > 0 || report.units.empty()) {
    return;
  }
  const bool gyroscope = std::any_of(report.units.begin(), report.units.end(),
                                     [](const UnitReport& unit) { return unit.sensor == "gyroscope"; });
  const Tau0& tau0 = gyroscope ? report.settings.tau0_gyroscope : report.settings.tau0_accelerometer;
  const double sd = std::sqrt(tau0.device * tau0.device + tau0.axis * tau0.axis + tau0.scale * tau0.scale);
  report.notes.push_back(
      written("One session an arm: the scatter between sessions is assumed (%.1f %% %s), not "
              "measured.",
              100.0 * sd, gyroscope ? "gyro" : "accel"));
}

/// Drifts over the releases, each unit once: by its scales where these show it, else by N.
void note_trends(Report& report) {
  std::string told;
  for (const TrendReport& one : report.trends) {
    if (!one.warns() || one.unit == told) {
      continue;
    }
    told = one.unit;
    const std::string since = report.baseline.label.empty() ? "the baseline" : report.baseline.label;
    report.notes.push_back(short_sensor_name(one.unit) + " drifts over " + std::to_string(one.trend.releases) +
                           " releases: " + interval_text(one.trend.slope, one.trend.ci95.low, one.trend.ci95.high) +
                           " a release, " + percent_text(one.trend.total) + " since " + since + ".");
  }
}

/// Units in which gross errors of an arm asked for the robust variances of both.
void note_robust(Report& report) {
  std::string units;
  for (const UnitReport& unit : report.units) {
    if (unit.robust) {
      units += (units.empty() ? "" : ", ") + short_sensor_name(unit.name);
    }
  }
  if (!units.empty()) {
    report.notes.push_back(units + ": an arm has gross errors, so that both are compared by robust variances.");
  }
}

}  // namespace

std::string percent_text(double ln_deviation) {
  const double percent = percent_of(ln_deviation);
  return std::abs(percent) < 9.95 ? written("%+.1f %%", percent) : written("%+.0f %%", percent);
}

std::string interval_text(double theta, double lower, double upper) {
  const bool fine = std::abs(percent_of(theta)) < 9.95;
  const char* const format = fine ? "%+.1f %% [%+.1f, %+.1f]" : "%+.0f %% [%+.0f, %+.0f]";
  return written(format, percent_of(theta), percent_of(lower), percent_of(upper));
}

std::string duration_text(double seconds) {
  if (seconds >= 7200.0) {
    return written("%.2g h", seconds / 3600.0);
  }
  return seconds >= 120.0 ? written("%.3g min", seconds / 60.0) : written("%.2g s", seconds);
}

ToldTest furthest_beyond(const Report& report) {
  return largest(
      report, [](const ScaleReport& test) { return test.outcome.finding == Finding::Beyond; },
      [](const ScaleReport& test) { return test.outcome.lower - test.test.margin; });
}

std::vector<ToldTest> by_distance(const Report& report) {
  std::vector<ToldTest> tests;
  for (const UnitReport& unit : report.units) {
    for (const ScaleReport& test : unit.tests) {
      tests.push_back({&unit, &test});
    }
  }
  const auto score = [](const ToldTest& told) {
    const double beyond = told.test->outcome.finding == Finding::Beyond ? 10.0 : 0.0;
    return beyond + (told.test->gated ? 1.0 : 0.0) + told.test->outcome.upper_one - told.test->test.margin;
  };
  sort_keeping_ties(tests, [&](const ToldTest& a, const ToldTest& b) { return score(a) > score(b); });
  return tests;
}

void tell(Report& report) {
  note_structures(report);
  note_improvement(report);
  note_scatter(report);
  note_robust(report);
  note_trends(report);
  const ToldTest beyond = furthest_beyond(report);
  const ToldTest open =
      largest(report, is_open, [](const ScaleReport& test) { return test.outcome.upper_one - test.test.margin; });
  if (is_on_the_margin(open)) {
    report.comparison.needs = {};  // what would decide of an unchanged device does not decide this one
  }
  if (report.comparison.needs.length_factor) {
    double longest_s = 0.0;
    for (const ArmReport::Session& session : report.candidate.sessions) {
      longest_s = std::max(longest_s, session.duration_s);
    }
    report.needed_length_s = longest_s * *report.comparison.needs.length_factor;
  }
  Summary& summary = report.summary;
  if (report.verdict == Verdict::Pass) {
    summary.verdict = pass_sentence(report);
    summary.level = "fine";
  } else if (report.verdict == Verdict::Fail) {
    summary.level = "wrong";
    if (beyond.test != nullptr) {
      summary.verdict = worse_sentence(beyond);
    }
  } else {
    summary.verdict = undecided_sentence(report, open);
    summary.level = "look";
    if (report.comparability.empty()) {
      report.needs = needs_sentence(report, open);
      summary.details.push_back(report.needs);
    }
  }
  for (const EventCheck& check : report.checks) {
    if (check.verdict == CheckVerdict::Fail) {
      if (summary.verdict.empty()) {
        summary.verdict = check.sentence;
      } else {
        summary.details.push_back(check.sentence);
      }
    }
  }
  for (const Incomparable& item : report.comparability) {
    if (report.verdict != Verdict::Inconclusive || &item != &report.comparability.front()) {
      summary.details.push_back(item.sentence);
    }
  }
  for (const EventCheck& check : report.checks) {
    if (check.verdict == CheckVerdict::Note) {
      summary.details.push_back(check.sentence);
    }
  }
  summary.details.insert(summary.details.end(), report.notes.begin(), report.notes.end());
}

}  // namespace driftlab::regression
