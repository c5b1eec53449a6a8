#include "core/campaign/regression/report.hpp"

#include "core/campaign/regression/bias_check.hpp"
#include "core/campaign/regression/compared_sessions.hpp"
#include "core/campaign/regression/design_builder.hpp"
#include "core/campaign/regression/release_order.hpp"
#include "core/campaign/regression/request_checks.hpp"
#include "core/campaign/regression/scale_check.hpp"
#include "core/campaign/regression/time_base.hpp"
#include "core/signal/name_list.hpp"
#include "core/signal/number.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace driftlab::regression {
namespace {

tl::unexpected<Error> cancelled() { return fail(ErrorCode::Cancelled, "The regression run was cancelled."); }

void tell_trends(const Design& design, const ReleaseOrder& order, Report& report) {
  const Comparison& comparison = report.comparison;
  for (ReleaseTrend& trend : release_trends(design, scatter_terms(design), comparison.scatter, comparison.contrast,
                                            order, report.settings.test.through_s)) {
    std::string name;
    if (trend.level) {
      const Level& level = design.units[trend.unit].levels[*trend.level];
      name = level.process + "." + level.parameter;
    }
    report.trends.push_back({report.units[trend.unit].name, std::move(name), trend});
  }
}

void tell_tests(const Design& design, Report& report) {
  const Comparison& comparison = report.comparison;
  for (std::size_t u = 0; u < design.units.size(); ++u) {
    report.units[u].structure_test = comparison.contrast.structures[u];
  }
  for (std::size_t t = 0; t < comparison.contrast.tests.size(); ++t) {
    const Test& test = comparison.contrast.tests[t];
    ScaleReport told{test, comparison.outcomes[t], "", comparison.contrast.theta(static_cast<Eigen::Index>(t)),
                     comparison.gate.gated[t]};
    if (!test.level) {
      told.means = comparison.contrast.means[t];
    } else {
      const Level& level = design.units[test.unit].levels[*test.level];
      told.name = level.process + "." + level.parameter;
    }
    report.units[test.unit].tests.push_back(std::move(told));
  }
}

/// Every unit must reach the scales that must be shown.
void check_length(const Design& design, Report& report) {
  double reach_s = std::numeric_limits<double>::infinity();
  for (const Unit& unit : design.units) {
    reach_s = std::min(reach_s, design.rows[unit.first + unit.count - 1].tau_s);
  }
  const double through_s = report.settings.test.through_s;
  if (2.0 * reach_s > through_s) {
    return;
  }
  double length_s = std::numeric_limits<double>::infinity();
  std::size_t sessions = 0;
  for (const ArmReport* arm : {&report.baseline, &report.candidate}) {
    for (const ArmReport::Session& session : arm->sessions) {
      if (session.duration_s < length_s) {
        length_s = session.duration_s;
        sessions = arm->sessions.size();
      }
    }
  }
  const double enough_s = 60.0 * std::ceil(length_s * through_s / reach_s / 60.0);
  report.comparability.push_back({"length", "Too short: " + with_count(sessions, "session") + " of " +
                                                duration_text(length_s) + (sessions == 1 ? " reaches " : " reach ") +
                                                duration_text(reach_s) + "; " + duration_text(enough_s) + " reach " +
                                                duration_text(through_s) + "."});
}

void note_sessions(const ComparedSessions& sessions, Report& report) {
  for (const PowerUps* arm : {&sessions.baseline, &sessions.candidate}) {
    for (const std::string& note : arm->notes) {
      if (std::find(report.notes.begin(), report.notes.end(), note) == report.notes.end()) {
        report.notes.push_back(note);
      }
    }
  }
}

/// Adds every unit that both arms have to design and report. Error: Cancelled.
Status add_units(const ComparedSessions& sessions, const RunControl& control, DesignBuilder& builder, Report& report) {
  const auto now = units_of(sessions.candidate.sessions);
  const auto before = units_of(sessions.baseline.sessions);
  double done = 0.0;
  for (const auto& [name, unit] : before) {
    control.report("compare", 0.9 * done++ / static_cast<double>(before.size()));
    if (control.stop.stop_requested()) {
      return cancelled();
    }
    if (!now.contains(name)) {
      continue;
    }
    UnitReport told;
    told.name = name;
    told.condition = unit.condition;
    told.sensor = sensor_of(unit.quantity);
    told.axis = unit.axis;
    told.structure = {structure_of(sessions.baseline.sessions, name), structure_of(sessions.candidate.sessions, name)};
    if (builder.add(unit, told, control.stop)) {
      report.units.push_back(std::move(told));
    } else {
      report.comparability.push_back({"length", "Too short: no scale of " + name + " has " +
                                                    std::to_string(static_cast<int>(report.settings.min_edf)) +
                                                    " degrees of freedom in both arms."});
    }
  }
  return control.stop.stop_requested() ? Status(cancelled()) : Status{};
}

bool all_stamped(const std::vector<PowerUp>& sessions) {
  return std::all_of(sessions.begin(), sessions.end(), [](const PowerUp& session) {
    return std::all_of(session.recordings.begin(), session.recordings.end(),
                       [](const ComparedRecording* recording) { return recording->stamped; });
  });
}

/// What is no level of noise. Gross errors, and bias and scale factor where they are tested, share the level of events.
void check_facts(const ComparedSessions& sessions, Report& report) {
  const Settings& settings = report.settings;
  const double tests = 1.0 + (settings.bias.any() ? 1.0 : 0.0) + (settings.scale_factor.any() ? 1.0 : 0.0);
  const double level = settings.test.look_share * settings.test.event_alpha / tests;
  const std::vector<PowerUp>& before = sessions.baseline.sessions;
  const std::vector<PowerUp>& candidate = sessions.candidate.sessions;
  report.checks = check_events(before, candidate, level, settings.limits);
  report.checks.push_back(check_bias(before, candidate, settings.bias, level));
  report.checks.push_back(check_scale_factor(before, candidate, settings.scale_factor, level));
  report.checks.push_back(
      check_time_base(report.units, settings.test.through_s, all_stamped(before) && all_stamped(candidate)));
}

/// What must be known of the files of both arms, each sentence once with the recordings that it is of.
void note_recordings(const Request& request, Report& report) {
  constexpr std::size_t kNamed = 3;
  std::map<std::string, std::set<std::string>> whose;
  for (const Recordings* const arm : {&request.baseline, &request.candidate}) {
    for (const ComparedRecording& recording : arm->recordings) {
      for (const std::string& note : recording.notes) {
        whose[note].insert(recording.id);
      }
    }
  }
  for (const auto& [note, ids] : whose) {
    NameList named(kNamed);
    for (const std::string& id : ids) {
      named.add(id);
    }
    report.notes.push_back(named.text() + ": " + note);
  }
}

}  // namespace

Result<Report> run_regression(const Request& request, const RunControl& control) {
  if (auto checked = check_arms(request); !checked) {
    return fail(checked.error());
  }
  ComparedSessions sessions{group_sessions(request.baseline), group_sessions(request.candidate), {}};
  Report report;
  report.device = request.device;
  report.settings = request.settings;
  report.excluded = request.excluded;
  report.baseline = arm_report(request.baseline, sessions.baseline);
  report.candidate = arm_report(request.candidate, sessions.candidate);
  for (const Recordings& release : request.history) {
    sessions.history.push_back(group_sessions(release));
    report.history.push_back(arm_report(release, sessions.history.back()));
  }
  note_sessions(sessions, report);
  report.comparability = compare_arms(sessions.baseline.sessions, sessions.candidate.sessions, request.settings.limits);
  DesignBuilder builder(sessions, request.settings);
  if (auto added = add_units(sessions, control, builder, report); !added) {
    return fail(added.error());
  }
  if (report.units.empty() && report.comparability.empty()) {
    return fail(ErrorCode::InvalidArgument,
                "There is nothing to compare: no column of the recordings is known to be an axis of a gyroscope or an "
                "accelerometer. Name them, for example --columns gz=angular_rate:z:deg/s.");
  }
  if (!report.units.empty()) {
    builder.finish();
    report.comparison = compare(builder.design(), request.settings.test, control.stop);
    if (control.stop.stop_requested()) {
      return cancelled();
    }
    report.scope_s = report.comparison.gate.scope_s;
    tell_tests(builder.design(), report);
    tell_trends(builder.design(), order_of(request, sessions), report);
    check_length(builder.design(), report);
  }
  if (builder.mixed_rates()) {
    report.notes.push_back(rates_sentence(report.baseline, report.candidate, report.units.front().tau_s.front()));
  }
  if (report.comparison.scatter.contrasts > 0 &&
      std::sqrt(report.comparison.scatter.mean_square_common()) > request.settings.limits.repeatability) {
    report.comparability.push_back({"repeatability",
                                    "The rig does not repeat: sessions without a change differ more "
                                    "than " +
                                        short_text(request.settings.limits.repeatability) +
                                        " times as much as sessions of such sensors do."});
  }
  check_facts(sessions, report);
  const bool event = std::any_of(report.checks.begin(), report.checks.end(),
                                 [](const EventCheck& check) { return check.verdict == CheckVerdict::Fail; });
  report.verdict = event                           ? Verdict::Fail
                   : !report.comparability.empty() ? Verdict::Inconclusive
                                                   : report.comparison.verdict;
  report.leaning_worse = report.verdict == Verdict::Inconclusive && report.comparison.worse_shown;
  note_recordings(request, report);
  tell(report);
  return report;
}

std::vector<Report::InformingSession> Report::informing_sessions() const {
  std::vector<InformingSession> informing;
  const auto add = [&](const ArmReport& arm) {
    if (arm.sessions.size() > 1) {
      for (const ArmReport::Session& session : arm.sessions) {
        informing.push_back({arm.label, session.name});
      }
    }
  };
  add(baseline);
  add(candidate);
  for (const ArmReport& release : history) {
    add(release);
  }
  return informing;
}

}  // namespace driftlab::regression
