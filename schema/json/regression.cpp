#include "schema/json/regression.hpp"

#include "core/campaign/regression/ratios.hpp"
#include "core/signal/angle.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/reported_channel.hpp"

namespace driftlab {
namespace {

std::size_t regression_count_member(const Json& object, const char* name) {
  const auto found = object.find(name);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
}

regression::ChannelFacts regression_facts_of(const Json& quality, const Json& channel) {
  regression::ChannelFacts facts;
  facts.samples = regression_count_member(quality, "samples");
  for (const Json& known : quality.value("channels", Json::array())) {
    if (text_member(known, "column") == text_member(channel, "channel")) {
      facts.missing = regression_count_member(known, "missing") + regression_count_member(known, "implausible");
      facts.frozen = regression_count_member(known, "frozen");
      facts.repeated = regression_count_member(known, "repeated");
      facts.saturated = regression_count_member(known, "saturated");
      facts.resolution = finite_member(known, "resolution", 0.0);
    }
  }
  if (const auto mean = channel.find("mean"); mean != channel.end() && mean->is_number()) {
    facts.mean = mean->get<double>();
  }
  facts.mean_of_error = channel.contains("reference");
  if (const auto found = channel.find("contamination"); found != channel.end() && found->is_object()) {
    facts.flagged = regression_count_member(*found, "flagged_samples");
  }
  return facts;
}

regression::ComparedRecording regression_compared_of(const Json& document) {
  regression::ComparedRecording recording;
  Faults ignored;
  recording.id = document.at("id").get<std::string>();
  recording.condition = to_text(condition_from_json(document.at("condition"), "", ignored));
  recording.duration_s = finite_member(document, "duration_s", 0.0);
  recording.rate_hz = finite_member(document, "rate_hz", 0.0);
  const Json quality = document.value("quality", Json::object());
  const double measured_hz = finite_member(quality, "measured_rate_hz", 0.0);
  const double ratio = finite_member(quality, "clock_ratio", 0.0);
  if (ratio > 0.0 && measured_hz > 0.0) {
    recording.declared_hz = measured_hz / ratio;
  } else if (!(measured_hz > 0.0)) {
    recording.declared_hz = recording.rate_hz;  // without time stamps the rate is what somebody said
  }
  recording.jitter_s = finite_member(quality, "jitter_s", 0.0);
  recording.samples = regression_count_member(quality, "samples");
  recording.missing = regression_count_member(quality, "missing");
  for (const Json& channel : document.at("channels")) {
    auto read = reported_channel_from_json(channel);
    if (read) {
      recording.channels.push_back({std::move(*read), regression_facts_of(quality, channel)});
    }
  }
  return recording;
}

Json regression_test_json(const regression::ScaleReport& told) {
  Json test{{"kind", told.name.empty() ? "scale" : "parameter"}};
  if (told.name.empty()) {
    test["tau_s"] = number(told.test.tau_s);
  } else {
    test["name"] = told.name;
  }
  const regression::RatioReport ratios = regression::ratios_of(told);
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
  Json tests = Json::array();
  for (const regression::ScaleReport& test : unit.tests) {
    tests.push_back(regression_test_json(test));
  }
  return Json{{"device", report.device},
              {"condition", unit.condition},
              {"sensor", unit.sensor},
              {"axis", unit.axis},
              {"edf", {{"tau_s", unit.tau_s}, {"baseline", unit.edf[0]}, {"candidate", unit.edf[1]}}},
              {"structure",
               {{"baseline", text_or_null(unit.structure[0])},
                {"candidate", text_or_null(unit.structure[1])},
                {"pooled", text_or_null(unit.model)},
                {"changed", !unit.structure_test.compared},
                {"p", number(std::min(unit.structure_test.p_fit, unit.structure_test.p_contrast))}}},
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
  return Json{{"label", text_or_null(arm.label)}, {"sessions", std::move(sessions)}, {"rate_hz", number(arm.rate_hz)}};
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
  return Json{{"common",
               {{"value", number(factors.common)},
                {"ci95", {number(scatter.quantile_common(0.025)), number(scatter.quantile_common(0.975))}}}},
              {"local",
               {{"value", number(factors.local)},
                {"ci95", {number(scatter.quantile_local(0.025)), number(scatter.quantile_local(0.975))}}}},
              {"factors", regression::factor_grid()},
              {"posterior", std::move(posterior)},
              {"contrasts", scatter.contrasts}};
}

Json regression_tau0_json(const regression::Tau0& tau0) {
  return Json::array({number(100.0 * tau0.device), number(100.0 * tau0.axis), number(100.0 * tau0.scale)});
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
                 {{"gyroscope", number(settings.bias.gyroscope / kDegree)},
                  {"accelerometer", number(settings.bias.accelerometer / kRegressionMg)}}},
                {"scale_factor",
                 {{"gyroscope", number(settings.scale_factor.gyroscope / kRegressionPpm)},
                  {"accelerometer", number(settings.scale_factor.accelerometer / kRegressionPpm)}}}}},
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
              {"seed", settings.test.seed}};
}

Result<regression::ComparedRecording> compared_recording_from_json(const Json& document) {
  try {
    return regression_compared_of(document);
  } catch (const Json::exception& fault) {
    return fail(ErrorCode::Internal, "A characterisation cannot be read: " + std::string(fault.what()) + ".");
  }
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
  Json comparability = Json::array();
  for (const regression::Incomparable& item : report.comparability) {
    comparability.push_back(Json{{"item", item.item}, {"sentence", item.sentence}});
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
                {"settings", to_json(report.settings, run.look.of)},
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
                {"look",
                 {{"number", run.look.number},
                  {"of", run.look.of},
                  {"counted", run.look.counted},
                  {"share", number(report.settings.test.look_share)}}},
                {"units", std::move(units)},
                {"findings", std::move(findings)},
                {"comparability", std::move(comparability)},
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
