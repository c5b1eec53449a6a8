#include "schema/json/investigation.hpp"

#include "core/investigate/causes/cause.hpp"
#include "schema/json/simulation_model.hpp"

namespace driftlab {
namespace {

using investigate::Check;
using investigate::Evidence;
using investigate::Finding;
using investigate::Report;

Json check_json(const Check& check) {
  return Json{
      {"id", check.id},
      {"recording", check.recording.empty() ? Json(nullptr) : Json(check.recording)},
      {"channel", check.channel},
      {"observed", number(check.observed)},
      {"simulated", {{"q025", number(check.q025)}, {"median", number(check.median)}, {"q975", number(check.q975)}}},
      {"p", number(check.p)},
      {"p_adjusted", number(check.p_adjusted)},
      {"failed", check.failed}};
}

Json numbers(const std::vector<double>& values, double factor = 1.0) {
  Json list = Json::array();
  for (const double value : values) {
    list.push_back(number(value * factor));
  }
  return list;
}

Json band_json(const investigate::Band& band, double factor) {
  return Json{{"q025", numbers(band.low, factor)},
              {"median", numbers(band.median, factor)},
              {"q975", numbers(band.high, factor)}};
}

Json series_json(const investigate::FindingSeries& series) {
  const investigate::LabUnit unit = investigate::level_unit(series.unit);
  const double level = unit.per_si;
  const double density = level * level;
  return Json{{"recording", series.recording},
              {"channel", series.channel},
              {"unit", unit.symbol},
              {"wavelet",
               {{"scale_s", numbers(series.scale_s)},
                {"measured", numbers(series.deviation_before, level)},
                {"baseline", band_json(series.baseline, level)},
                {"remaining", numbers(series.deviation_after, level)},
                {"extended", band_json(series.extended, level)}}},
              {"spectrum",
               {{"f_hz", numbers(series.f_hz)},
                {"measured", numbers(series.density_before, density)},
                {"baseline", numbers(series.density_baseline, density)},
                {"remaining", numbers(series.density_after, density)}}},
              {"course",
               {{"time_s", numbers(series.time_s)},
                {"error", numbers(series.error, level)},
                {"effect", numbers(series.effect, level)}}}};
}

/// Predicted mean horizontal errors; `measured` needs a reference trajectory, which a study of causes has none of.
Json outages_json(const std::optional<investigate::OutageGain>& outages) {
  Json document{{"baseline", nullptr}, {"extended", nullptr}, {"measured", nullptr}};
  if (!outages) {
    return document;
  }
  document["baseline"] = number(outages->baseline_m.value);
  document["extended"] = number(outages->extended_m.value);
  document["adopted"] = number(outages->adopted_m.value);
  document["ci95"] = {{"baseline", interval(outages->baseline_m.ci95)},
                      {"extended", interval(outages->extended_m.ci95)},
                      {"adopted", interval(outages->adopted_m.ci95)}};
  document["left_out"] = outages->left_out;
  document["left_out_of_filters"] = outages->left_out_of_filters;
  return document;
}

Json finding_json(const Finding& finding) {
  Json alternatives = Json::array();
  for (const Evidence& rival : finding.evidence.rivals) {
    alternatives.push_back(std::string(rival.cause->name));
  }
  Json next = finding.next_measurement.empty() ? Json(nullptr) : Json(finding.next_measurement);
  return Json{{"cause", std::string(finding.evidence.cause->name)},
              {"status", finding.evidence.ambiguous ? "ambiguous" : "identified"},
              {"alternatives", std::move(alternatives)},
              {"channels", finding.channels},
              {"because", finding.because},
              {"explanation", finding.explanation},
              {"parameters", parameters_json(finding.evidence)},
              {"score", number(finding.evidence.score)},
              {"gain",
               {{"log_score_per_sample", number(finding.gain.log_score_per_sample)},
                {"misfit_before", number(finding.gain.misfit_before)},
                {"misfit_after", number(finding.gain.misfit_after)},
                {"heldout", finding.gain.heldout},
                {"heldout_share", number(finding.gain.share)},
                {"heldout_samples", number(finding.gain.samples)}}},
              {"next_measurement", std::move(next)},
              {"series", series_json(finding.series)}};
}

}  // namespace

Json to_json(const Report& report) {
  Json checks = Json::array();
  for (const Check& check : report.checks) {
    checks.push_back(check_json(check));
  }
  Json findings = Json::array();
  for (const Finding& finding : report.findings) {
    findings.push_back(finding_json(finding));
  }
  Json unexplained = Json::array();
  for (const auto& left : report.unexplained) {
    unexplained.push_back({{"channel", left.channel}, {"explanation", left.sentence}, {"checks", left.checks}});
  }
  Json not_examined = Json::array();
  for (const auto& item : report.not_examined) {
    not_examined.push_back({{"cause", item.cause}, {"channel", item.channel}, {"needs", item.needs}});
  }
  return Json{{"study", report.study},
              {"baseline", baseline_json(report)},
              {"checks", std::move(checks)},
              {"findings", std::move(findings)},
              {"extended_model", extended_json(report)},
              {"gain",
               {{"misfit_before", number(report.misfit_before)},
                {"misfit_after", number(report.misfit_after)},
                {"checks_failed_before", report.failed_before},
                {"checks_failed_after", report.failed_after},
                {"outage_error_m", outages_json(report.outages)}}},
              {"unexplained", std::move(unexplained)},
              {"not_examined", std::move(not_examined)},
              {"notes", report.notes}};
}

Json change_json(const Finding& finding) {
  return Json{{"change", "added"},
              {"cause", std::string(finding.evidence.cause->name)},
              {"status", finding.evidence.ambiguous ? "ambiguous" : "identified"},
              {"channels", finding.channels},
              {"why", finding.explanation},
              {"log_score_per_sample", number(finding.gain.log_score_per_sample)}};
}

Json findings_summary(const Report& report) {
  Json findings = Json::array();
  for (const Finding& finding : report.findings) {
    Json one = change_json(finding);
    one.erase("change");
    one.erase("why");
    findings.push_back(std::move(one));
  }
  return findings;
}

}  // namespace driftlab
