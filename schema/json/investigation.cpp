#include "schema/json/investigation.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/figures.hpp"
#include "core/investigate/report/order.hpp"
#include "schema/json/rounded.hpp"
#include "schema/json/simulation_model.hpp"
#include "schema/json/stored_channel.hpp"
#include "schema/json/unnamed_effect.hpp"

namespace driftlab {
namespace {

using investigate::Check;
using investigate::CheckEnd;
using investigate::Evidence;
using investigate::Finding;
using investigate::Report;

const char* end_name(CheckEnd end) {
  switch (end) {
    case CheckEnd::Finding:
      return "finding";
    case CheckEnd::Mended:
      return "mended";
    case CheckEnd::Unexplained:
      return "unexplained";
    case CheckEnd::None:
      break;
  }
  return nullptr;
}

Json check_json(const Check& check) {
  const char* const end = end_name(check.end);
  return Json{
      {"id", check.id},
      {"title", check.title},
      {"recording", check.recording.empty() ? Json(nullptr) : Json(check.recording)},
      {"channel", check.channel},
      {"observed", number(check.observed)},
      {"simulated", {{"q025", number(check.q025)}, {"median", number(check.median)}, {"q975", number(check.q975)}}},
      {"p", number(check.p)},
      {"p_adjusted", number(check.p_adjusted)},
      {"failed", check.failed},
      {"observed_after", number(check.observed_after)},
      {"p_after", number(check.p_after)},
      {"p_after_adjusted", number(check.p_after_adjusted)},
      {"failed_after", check.failed_after},
      {"end", end == nullptr ? Json(nullptr) : Json(end)}};
}

Json band_json(const investigate::Band& band, double factor) {
  return Json{{"q025", numbers(band.low, factor)},
              {"median", numbers(band.median, factor)},
              {"q975", numbers(band.high, factor)}};
}

Json ratios_json(const std::vector<investigate::InnovationRatio>& ratios) {
  Json list = Json::array();
  for (const investigate::InnovationRatio& ratio : ratios) {
    list.push_back(Json{{"recording", ratio.recording},
                        {"scale_s", number(ratio.scale_s)},
                        {"before", number(ratio.before)},
                        {"after", number(ratio.after)},
                        {"q025", number(ratio.low)},
                        {"q975", number(ratio.high)}});
  }
  return list;
}

Json allan_json(const investigate::ChannelFigures& figures, double level) {
  Json list{
      {"tau_s", Json::array()}, {"measured", Json::array()}, {"baseline", Json::array()}, {"extended", Json::array()}};
  for (const investigate::AllanChange& change : allan_changes(figures)) {
    list["tau_s"].push_back(number(change.tau_s));
    list["measured"].push_back(number(change.measured * level));
    list["baseline"].push_back(number(change.baseline * level));
    list["extended"].push_back(number(change.extended * level));
  }
  return list;
}

Json spectrogram_json(const investigate::InnovationSpectrogram& picture) {
  return Json{{"recording", picture.recording},
              {"time_s", numbers(picture.time_s)},
              {"f_hz", numbers(picture.f_hz)},
              {"log10_ratio", rounded_rows(picture.log10_ratio, picture.f_hz.size(), 2)}};
}

Json figures_json(const investigate::ChannelFigures& figures) {
  const investigate::LabUnit unit = investigate::level_unit(figures.unit);
  const double level = unit.per_si;
  const double density = unit.per_si * unit.per_si;
  Json document{{"channel", figures.channel},
                {"recording", figures.recording},
                {"unit", unit.symbol},
                {"allan", allan_json(figures, level)},
                {"wavelet",
                 {{"scale_s", numbers(figures.scale_s)},
                  {"measured", numbers(figures.deviation_before, level)},
                  {"baseline", band_json(figures.baseline, level)},
                  {"remaining", numbers(figures.deviation_after, level)},
                  {"extended", band_json(figures.extended, level)}}},
                {"innovations", ratios_json(figures.ratios)},
                {"spectrum",
                 {{"f_hz", numbers(figures.f_hz)},
                  {"measured", numbers(figures.density_before, density)},
                  {"highest", numbers(figures.highest_before, density)},
                  {"baseline", band_json(figures.density_baseline, density)},
                  {"chance", numbers(figures.chance, density)},
                  {"remaining", numbers(figures.density_after, density)},
                  {"highest_remaining", numbers(figures.highest_after, density)}}},
                {"course",
                 {{"time_s", numbers(figures.time_s)},
                  {"error", numbers(figures.error, level)},
                  {"effect", numbers(figures.effect, level)}}}};
  if (figures.spectrogram) {
    document["spectrogram"] = spectrogram_json(*figures.spectrogram);
  }
  return document;
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
  Json rivals = Json::array();
  for (const Evidence& rival : finding.evidence.rivals) {
    rivals.push_back(Json{{"cause", std::string(rival.cause->name)},
                          {"title", std::string(rival.cause->title)},
                          {"score", number(rival.score)}});
  }
  Json next = finding.next_measurement.empty() ? Json(nullptr) : Json(finding.next_measurement);
  return Json{{"cause", std::string(finding.evidence.cause->name)},
              {"title", std::string(finding.evidence.cause->title)},
              {"equation", std::string(finding.evidence.cause->equation)},
              {"concern", std::string(name_of(concern_of(*finding.evidence.cause)))},
              {"status", finding.evidence.ambiguous ? "ambiguous" : "identified"},
              {"alternatives", alternatives_of(finding.evidence)},
              {"rivals", std::move(rivals)},
              {"channels", texts_of(finding.channels)},
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
                {"heldout_samples", number(finding.gain.samples)},
                {"of_the_file", finding.gain.of_the_file},
                {"explained", number(finding.gain.explained)}}},
              {"next_measurement", std::move(next)}};
}

Json groups_json(const Report& report) {
  Json list = Json::array();
  for (const investigate::FindingGroup& group : groups_of(report.findings)) {
    list.push_back(Json{{"cause", std::string(group.cause->name)},
                        {"title", std::string(group.cause->title)},
                        {"concern", std::string(name_of(concern_of(*group.cause)))},
                        {"findings", group.findings},
                        {"channels", group.columns}});
  }
  return list;
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
  Json unnamed = Json::array();
  for (const investigate::UnnamedFinding& found : report.unnamed) {
    for (const investigate::ChannelModel& model : report.models) {
      if (model.channel == found.effect.column) {
        unnamed.push_back(to_json(found, model.unit));
      }
    }
  }
  Json not_examined = Json::array();
  for (const auto& item : report.not_examined) {
    not_examined.push_back({{"cause", item.cause}, {"channel", item.channel}, {"needs", item.needs}});
  }
  Json figures = Json::array();
  for (const auto& of_channel : report.figures) {
    figures.push_back(figures_json(of_channel));
  }
  return Json{{"study", report.study},
              {"summary", to_json(report.summary)},
              {"baseline", baseline_json(report)},
              {"checks", std::move(checks)},
              {"findings", std::move(findings)},
              {"groups", groups_json(report)},
              {"figures", std::move(figures)},
              {"extended_model", extended_json(report)},
              {"gain",
               {{"misfit_before", number(report.misfit_before)},
                {"misfit_after", number(report.misfit_after)},
                {"checks_failed_before", report.failed_before},
                {"checks_failed_after", report.failed_after},
                {"explained", number(report.explained)},
                {"outage_error_m", outages_json(report.outages)}}},
              {"unexplained", std::move(unexplained)},
              {"unnamed", std::move(unnamed)},
              {"not_examined", std::move(not_examined)},
              {"notes", report.notes}};
}

Json change_json(const Finding& finding) {
  return Json{{"change", "added"},
              {"cause", std::string(finding.evidence.cause->name)},
              {"status", finding.evidence.ambiguous ? "ambiguous" : "identified"},
              {"channels", texts_of(finding.channels)},
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
