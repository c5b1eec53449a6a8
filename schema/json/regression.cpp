#include "schema/json/regression.hpp"

#include "core/campaign/regression/ratios.hpp"
#include "core/signal/angle.hpp"
#include "core/signal/unit.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/stored_member.hpp"

namespace driftlab {
namespace {

Json regression_test_json(const regression::ScaleReport& told, const ParameterUnit& unit) {
  Json test{{"kind", told.name.empty() ? "scale" : "parameter"}};
  if (told.name.empty()) {
    test["tau_s"] = number(told.test.tau_s);
  } else {
    test["name"] = told.name;
  }
  const regression::RatioReport ratios = regression::ratios_of(told);
  if (ratios.deviations) {
    const auto& [before, after] = *ratios.deviations;
    test["baseline"] = quantity(before, unit.per_si, unit.symbol);
    test["candidate"] = quantity(after, unit.per_si, unit.symbol);
  }
  test["ratio"] = number(ratios.ratio);
  test["ci"] = interval(ratios.ci95);
  test["upper_single"] = number(ratios.upper_single);
  test["margin"] = number(ratios.margin);
  test["gated"] = told.gated;
  test["verdict"] = name_of(told.outcome.finding);
  test["p_adjusted"] = number(told.outcome.p_adjusted);
  return test;
}

Json regression_unit_json(const regression::Report& report, const regression::UnitReport& unit) {
  const ParameterUnit deviations =
      lab_unit(unit.sensor == "gyroscope" ? Dimension::AngularRate : Dimension::SpecificForce, 0);
  Json tests = Json::array();
  for (const regression::ScaleReport& test : unit.tests) {
    tests.push_back(regression_test_json(test, deviations));
  }
  return Json{{"device", report.device},
              {"condition", unit.condition},
              {"sensor", unit.sensor},
              {"axis", unit.axis},
              {"robust", unit.robust},
              {"edf", {{"tau_s", unit.tau_s}, {"baseline", unit.edf[0]}, {"candidate", unit.edf[1]}}},
              {"structure",
               {{"baseline", text_or_null(unit.structure[0])},
                {"candidate", text_or_null(unit.structure[1])},
                {"pooled", text_or_null(unit.model)},
                {"changed", !unit.structure_test.compared},
                {"p", number(unit.structure_test.least_p())}}},
              {"tests", std::move(tests)}};
}

Json regression_trend_json(const regression::TrendReport& told) {
  const regression::ReleaseTrend& trend = told.trend;
  const regression::TrendRatios ratios = regression::ratios_of(trend);
  return Json{{"unit", told.unit},
              {"of", told.name.empty() ? "scales" : told.name},
              {"releases", trend.releases},
              {"per_release", number(ratios.per_release)},
              {"ci95", interval(ratios.ci95)},
              {"total", number(ratios.total)},
              {"p", number(trend.p)},
              {"warning", told.warns()}};
}

Json regression_arm_json(const regression::ArmReport& arm) {
  Json sessions = Json::array();
  for (const regression::ArmReport::Session& session : arm.sessions) {
    sessions.push_back(Json{
        {"session", session.name}, {"recordings", session.recordings}, {"duration_s", number(session.duration_s)}});
  }
  Json rates = Json::array();
  for (const double rate : arm.rates_hz) {
    rates.push_back(number(rate));
  }
  return Json{{"label", text_or_null(arm.label)},
              {"sessions", std::move(sessions)},
              {"rates_hz", std::move(rates)},
              {"merged", arm.merged()}};
}

/// A prior scatter between sessions, in per cent of the deviation.
Json regression_of_sensors(const regression::Settings& settings, double regression::Tau0::* scatter) {
  return Json{{"gyroscope", number(100.0 * settings.tau0_gyroscope.*scatter)},
              {"accelerometer", number(100.0 * settings.tau0_accelerometer.*scatter)}};
}

Json regression_between_json(const regression::Report& report) {
  const regression::SessionScatter& scatter = report.comparison.scatter;
  const regression::ScatterFactors factors = regression::factors_of(scatter);
  Json posterior = Json::array();
  for (Eigen::Index a = 0; a < scatter.posterior.rows(); ++a) {
    Json row = Json::array();
    for (Eigen::Index b = 0; b < scatter.posterior.cols(); ++b) {
      row.push_back(number(scatter.posterior(a, b)));
    }
    posterior.push_back(std::move(row));
  }
  Json informing = Json::array();
  for (const auto& [label, session] : report.informing_sessions()) {
    informing.push_back(Json{{"label", text_or_null(label)}, {"session", session}});
  }
  return Json{{"kL", {{"value", number(factors.common.value)}, {"ci95", interval(factors.common.ci95)}}},
              {"kS", {{"value", number(factors.local.value)}, {"ci95", interval(factors.local.ci95)}}},
              {"factors", regression::factor_grid()},
              {"posterior", std::move(posterior)},
              {"contrasts", scatter.contrasts},
              {"sessions", std::move(informing)},
              {"t_d", regression_of_sensors(report.settings, &regression::Tau0::device)},
              {"t_a", regression_of_sensors(report.settings, &regression::Tau0::axis)},
              {"t_s", regression_of_sensors(report.settings, &regression::Tau0::scale)}};
}

/// Every item that must agree: what stands in the way of a comparison, and what does not.
Json regression_comparability_json(const regression::Report& report) {
  Json items = Json::array();
  for (const std::string_view item : regression::kComparedItems) {
    bool holds = true;
    for (const regression::Incomparable& found : report.comparability) {
      if (found.item == item) {
        items.push_back(Json{{"item", item}, {"comparable", false}, {"sentence", found.sentence}});
        holds = false;
      }
    }
    if (holds) {
      items.push_back(Json{{"item", item}, {"comparable", true}, {"sentence", nullptr}});
    }
  }
  return items;
}

Json regression_tau0_json(const regression::Tau0& tau0) {
  return Json::array({number(100.0 * tau0.device), number(100.0 * tau0.axis), number(100.0 * tau0.scale)});
}

Json regression_limits_json(const regression::EventLimits& limits) {
  Json document = Json::object();
  for (const LimitMember& member : limit_members()) {
    document[member.name] = number_in(limits.*member.limit, member.unit);
  }
  document["findings"] = limits.findings;
  return document;
}

/// The settings of a run, each with where it comes from.
Json regression_told_settings(const RegressReport& run) {
  Json settings = driftlab::to_json(run.report.settings, run.look.of);
  Json origin = Json::object();
  for (const auto& [name, value] : settings.items()) {
    origin[name] = run.stated.contains(name)                       ? "asked"
                   : run.kept && regression::is_kept_setting(name) ? "anchor"
                                                                   : "default";
  }
  settings["origin"] = std::move(origin);
  return settings;
}

/// What was kept with the anchor and what this run does otherwise; null where nothing was kept.
Json regression_kept_json(const RegressReport& run) {
  if (!run.kept) {
    return nullptr;
  }
  Json changed = Json::array();
  for (const regression::ChangedSetting& change : regression::changed_settings(*run.kept, run.report.settings)) {
    changed.push_back(Json{{"setting", change.name}, {"kept", change.kept}, {"now", change.now}});
  }
  return Json{{"settings", kept_settings_json(*run.kept)}, {"changed", std::move(changed)}};
}

}  // namespace

Json to_json(const regression::Settings& settings, std::size_t looks) {
  return Json{{"alpha", number(settings.test.alpha)},
              {"margin",
               {{"gyroscope", settings.gyroscope.percent},
                {"accelerometer", settings.accelerometer.percent},
                {"sigma", number(settings.margin_sigma_percent)},
                {"slow", number(settings.margin_slow_percent)},
                {"bias",
                 {{"gyroscope", number_in(settings.bias.gyroscope, kDegree)},
                  {"accelerometer", number_in(settings.bias.accelerometer, kRegressionMg)}}},
                {"scale_factor",
                 {{"gyroscope", number_in(settings.scale_factor.gyroscope, kRegressionPpm)},
                  {"accelerometer", number_in(settings.scale_factor.accelerometer, kRegressionPpm)}}}}},
              {"through_s", number(settings.test.through_s)},
              {"min_edf", number(settings.min_edf)},
              {"design_power", number(settings.test.design_power)},
              {"tau0",
               {{"gyroscope", regression_tau0_json(settings.tau0_gyroscope)},
                {"accelerometer", regression_tau0_json(settings.tau0_accelerometer)}}},
              {"prior_df", number(settings.test.prior_df)},
              {"session_df", settings.test.session_df},
              {"fail_on", settings.test.fail_on_worse ? "worse" : "beyond_margin"},
              {"two_sided", settings.test.two_sided},
              {"looks", looks},
              {"event_limits", regression_limits_json(settings.limits)},
              {"seed", settings.test.seed}};
}

const std::vector<LimitMember>& limit_members() {
  using Limits = regression::EventLimits;
  constexpr double kPercent = 0.01;
  static const std::vector<LimitMember> members = {{"missing", &Limits::missing, kPercent},
                                                   {"jitter", &Limits::jitter, 1.0},
                                                   {"jitter_of_interval", &Limits::jitter_of_interval, kPercent},
                                                   {"resolution", &Limits::resolution, 1.0},
                                                   {"contamination", &Limits::contamination, 1.0},
                                                   {"rate", &Limits::rate, kPercent},
                                                   {"temperature", &Limits::temperature_k, 1.0},
                                                   {"repeatability", &Limits::repeatability, 1.0}};
  return members;
}

Json kept_settings_json(const regression::Settings& settings) {
  const Json all = to_json(settings, 3);
  Json kept = Json::object();
  for (const auto& [name, value] : all.items()) {
    if (regression::is_kept_setting(name)) {
      kept[name] = value;
    }
  }
  return kept;
}

Json to_json(const RegressReport& run) {
  const regression::Report& report = run.report;
  Json units = Json::array();
  for (const regression::UnitReport& unit : report.units) {
    units.push_back(regression_unit_json(report, unit));
  }
  Json trend = Json::array();
  for (const regression::TrendReport& told : report.trends) {
    trend.push_back(regression_trend_json(told));
  }
  Json findings = Json::array();
  for (const regression::EventCheck& check : report.checks) {
    findings.push_back(Json{{"check", check.check},
                            {"verdict", name_of(check.verdict)},
                            {"sentence", text_or_null(check.sentence)},
                            {"sessions", check.sessions},
                            {"p", check.p ? number(*check.p) : Json(nullptr)}});
  }
  Json history = Json::array();
  for (const regression::ArmReport& arm : report.history) {
    history.push_back(regression_arm_json(arm));
  }
  Json excluded = Json::array();
  for (const regression::Exclusion& exclusion : report.excluded) {
    excluded.push_back(Json{{"recording", exclusion.recording}, {"reason", exclusion.reason}});
  }
  const regression::Needs& needs = report.comparison.needs;
  Json document{{"device", report.device},
                {"verdict", name_of(report.verdict)},
                {"lean", report.leaning_worse ? Json("worse") : Json(nullptr)},
                {"summary",
                 {{"verdict", report.summary.verdict},
                  {"details", report.summary.details},
                  {"level", report.summary.level},
                  {"facts", Json::array()}}},
                {"scope_s", number(report.scope_s)},
                {"settings", regression_told_settings(run)},
                {"arms",
                 {{"baseline", regression_arm_json(report.baseline)},
                  {"candidate", regression_arm_json(report.candidate)},
                  {"history", std::move(history)},
                  {"excluded", std::move(excluded)}}},
                {"between", report.units.empty() ? Json(nullptr) : regression_between_json(report)},
                {"critical",
                 {{"c_max", number(report.comparison.c_max)},
                  {"c_1", number(report.comparison.c_1)},
                  {"draws", report.settings.test.draws},
                  {"seed", report.settings.test.seed}}},
                {"kept", regression_kept_json(run)},
                {"look",
                 {{"number", run.look.number},
                  {"of", run.look.of},
                  {"counted", run.look.counted},
                  {"share", number(report.settings.test.look_share)}}},
                {"units", std::move(units)},
                {"findings", std::move(findings)},
                {"comparability", regression_comparability_json(report)},
                {"needs",
                 {{"sessions_per_arm", needs.sessions_per_arm ? Json(*needs.sessions_per_arm) : Json(nullptr)},
                  {"length_s", report.needed_length_s ? number(*report.needed_length_s) : Json(nullptr)},
                  {"sentence", text_or_null(report.needs)}}},
                {"trend", std::move(trend)},
                {"versus_previous", nullptr},
                {"algorithm_version", kRegressionVersion}};
  if (run.versus_previous) {
    document["versus_previous"] = Json{{"label", run.versus_previous->label},
                                       {"verdict", name_of(run.versus_previous->verdict)},
                                       {"sentence", run.versus_previous->sentence}};
  }
  return document;
}

}  // namespace driftlab
