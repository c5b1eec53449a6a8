#include "schema/json/drive.hpp"

#include "core/analysis/drawn_drive.hpp"
#include "core/signal/angle.hpp"

#include <array>

namespace driftlab {
Json estimate_to_json(const Estimate& estimate) {
  return Json{{"value", number(estimate.value)}, {"ci95", interval(estimate.ci95)}};
}

Json facts_to_json(const drive::Drive& drive) {
  const drive::FileFacts& facts = drive.facts;
  const drive::SamplingFacts& s = facts.sampling;
  return Json{{"duration_s", number(drive.end_s())},
              {"length_m", number(facts.length_m)},
              {"highest_speed_m_s", number(facts.highest_speed_m_s)},
              {"runs", drive.runs.size()},
              {"imu",
               {{"rows", s.rows},
                {"incomplete_rows", s.incomplete},
                {"repeated_rows", s.repeated},
                {"stuck_rows", s.stuck},
                {"polled_faster_than_sampled", s.polled_faster},
                {"stamped_rate_hz", number(s.stamped_rate_hz)},
                {"sensor_rate_hz", number(s.sensor_rate_hz)},
                {"jitter_s", number(s.jitter_s)},
                {"gaps_bridged", s.gaps_bridged},
                {"samples_bridged", s.samples_bridged},
                {"gaps_splitting", s.gaps_splitting},
                {"longest_gap_s", number(s.longest_gap_s)}}},
              {"gnss",
               {{"fixes", facts.fixes},
                {"rate_hz", number(facts.fix_rate_hz)},
                {"held", facts.held},
                {"other_types", facts.other_types},
                {"incomplete", facts.incomplete},
                {"far_away", facts.far_away},
                {"accuracy_constant", facts.accuracy_constant},
                {"speed_accuracy_constant", facts.speed_accuracy_constant}}},
              {"reference", drive.withheld_fixes                ? "withheld_fixes"
                            : drive.document.reference.smoothed ? "smoothed_fixes"
                                                                : "own"},
              {"notes", facts.notes}};
}

Json options_to_json(const drive::FilterOptions& options) {
  return Json{{"velocity_constraint", options.constraint.has_value()},
              {"zero_velocity", options.zero_velocity},
              {"odometer", options.odometer}};
}

namespace {

Json growth_json(const drive::ErrorGrowth& growth) {
  return Json{{"time_s", numbers(growth.time_s)},     {"n", growth.count},
              {"rms_m", numbers(growth.rms_m)},       {"p05_m", numbers(growth.p05_m)},
              {"median_m", numbers(growth.median_m)}, {"p95_m", numbers(growth.p95_m)}};
}

Json path_json(const drive::Drive& drive) {
  Json north = Json::array();
  Json east = Json::array();
  for (const drive::MapPlace& place : drive::way_of(drive)) {
    north.push_back(number(place[1]));
    east.push_back(number(place[0]));
  }
  return Json{{"north_m", std::move(north)}, {"east_m", std::move(east)}};
}

Json start_json(const drive::Start& start) {
  const EulerAngles angles = start.attitude();
  constexpr std::array<const char*, 3> kTilt{"stated", "rest", "motion"};
  constexpr std::array<const char*, 2> kHeading{"stated", "course"};
  return Json{{"time_s", number(start.time_s)},
              {"roll_deg", number(angles.roll_rad / kDegree)},
              {"pitch_deg", number(angles.pitch_rad / kDegree)},
              {"heading_deg", number(angles.heading_rad / kDegree)},
              {"tilt_from", kTilt[static_cast<std::size_t>(start.tilt_from)]},
              {"heading_from", kHeading[static_cast<std::size_t>(start.heading_from)]}};
}

}  // namespace

Json to_json(const DriveCheck& checked) {
  Json rests = Json::array();
  for (const drive::Rest& rest : checked.rests) {
    rests.push_back(Json{number(rest.from_s), number(rest.to_s)});
  }
  Json document{{"id", checked.drive.document.id},
                {"vehicle", name_of(checked.drive.document.vehicle)},
                {"facts", facts_to_json(checked.drive)},
                {"rests_s", std::move(rests)}};
  if (checked.start) {
    document["start"] = start_json(*checked.start);
  } else {
    document["cannot_start"] = checked.cannot_start;
  }
  return document;
}

Json to_json(const drive::DurationSummary& d, const drive::Drive& drive) {
  Json outages = Json::array();
  for (const drive::DriveOutage& o : d.outages) {
    const drive::MappedOutage mapped = drive::mapped(o, drive);
    outages.push_back(Json{{"start_s", number(o.outage.start_s)},
                           {"phase", o.phase},
                           {"motion", name_of(o.outage_class)},
                           {"north_m", number(mapped.error_m[1])},
                           {"east_m", number(mapped.error_m[0])},
                           {"along_m", number(o.along_m)},
                           {"across_m", number(o.across_m)},
                           {"covariance_m2", numbers(mapped.covariance_m2)},
                           {"nees", number(o.nees())},
                           {"start_error_m", number(o.start_error_m)},
                           {"straight_line_error_m", number(o.straight_line_error_m)},
                           {"map_m", Json{number(mapped.truth_m[1]), number(mapped.truth_m[0])}}});
  }
  Json classes = Json::array();
  for (const auto& c : d.classes) {
    classes.push_back(Json{
        {"motion", name_of(c.outage_class)}, {"n", c.count}, {"rms_m", number(c.rms_m)}, {"nees", number(c.nees)}});
  }
  return Json{{"duration_s", number(d.duration_s)},
              {"period_s", number(d.period_s)},
              {"n", d.outages.size()},
              {"rms_m", estimate_to_json(d.rms_m)},
              {"median_m", estimate_to_json(d.median_m)},
              {"mean_m", number(d.mean_m)},
              {"p95_m", number(d.p95_m)},
              {"worst_m", number(d.worst_m)},
              {"along_rms_m", number(d.along_rms_m)},
              {"across_rms_m", number(d.across_rms_m)},
              {"nees", estimate_to_json(d.nees)},
              {"coverage50", estimate_to_json(d.coverage50)},
              {"coverage95", estimate_to_json(d.coverage95)},
              {"start_error_rms_m", number(d.start_error_rms_m)},
              {"straight_line_rms_m", number(d.straight_line_rms_m)},
              {"promised_rms_m", number(d.promised_rms_m)},
              {"by_motion", std::move(classes)},
              {"growth", growth_json(d.growth)},
              {"outages", std::move(outages)}};
}

Json to_json(const DriveReport& report) {
  Json durations = Json::array();
  for (const drive::DurationSummary& d : report.evaluation.durations) {
    durations.push_back(to_json(d, report.drive));
  }
  constexpr std::array<const char*, 6> kKinds{"position",      "velocity", "constraint",
                                              "zero_velocity", "odometer", "zero_turn"};
  Json innovations = Json::array();
  for (const drive::InnovationSummary& one : report.evaluation.innovations) {
    innovations.push_back(Json{{"kind", kKinds[static_cast<std::size_t>(one.kind)]},
                               {"n", one.count},
                               {"rms", number(one.rms)},
                               {"stated_rms", number(one.stated_rms)},
                               {"normalised_square", number(one.normalised)},
                               {"correlation_next", number(one.correlation_next)},
                               {"correlation_1s", number(one.correlation_1s)},
                               {"correlation_4s", number(one.correlation_4s)}});
  }
  Json natural = Json::array();
  for (const drive::NaturalOutage& one : report.evaluation.natural) {
    natural.push_back(Json{{"start_s", number(one.start_s)}, {"duration_s", number(one.duration_s)}});
  }
  Json starts = Json::array();
  for (const drive::Start& start : report.evaluation.starts) {
    starts.push_back(start_json(start));
  }
  Json document{{"id", report.drive.document.id},
                {"vehicle", name_of(report.drive.document.vehicle)},
                {"summary", sentence_of(report)},
                {"algorithm_version", drive::kDriveAlgorithmVersion},
                {"options", options_to_json(report.options)},
                {"facts", facts_to_json(report.drive)},
                {"path", path_json(report.drive)},
                {"starts", std::move(starts)},
                {"durations", std::move(durations)},
                {"innovations", std::move(innovations)},
                {"natural_outages", std::move(natural)},
                {"rejected_fixes", report.evaluation.rejected},
                {"notes", report.evaluation.notes}};
  document["heading_known_s"] = report.evaluation.heading_known_s ? number(*report.evaluation.heading_known_s) : Json();
  return document;
}

namespace {

Json simulated_json(const std::vector<drive::SimulatedDuration>& simulated) {
  Json list = Json::array();
  for (const drive::SimulatedDuration& s : simulated) {
    list.push_back(Json{{"duration_s", number(s.duration_s)},
                        {"n", s.count},
                        {"rms_m", number(s.rms_m)},
                        {"mean_m", number(s.mean_m)},
                        {"median_m", number(s.median_m)},
                        {"nees", number(s.nees.value)},
                        {"coverage50", number(s.coverage50.value)},
                        {"coverage95", number(s.coverage95.value)},
                        {"nees_ci95", interval(s.nees.ci95)},
                        {"coverage50_ci95", interval(s.coverage50.ci95)},
                        {"coverage95_ci95", interval(s.coverage95.ci95)},
                        {"measured_over_simulated", estimate_to_json(s.ratio)},
                        {"growth", growth_json(s.growth)}});
  }
  return list;
}

Json durations_json(const drive::DriveEvaluation& evaluation, const drive::Drive& drive) {
  Json durations = Json::array();
  for (const drive::DurationSummary& d : evaluation.durations) {
    durations.push_back(driftlab::to_json(d, drive));
  }
  return durations;
}

}  // namespace

Json to_json(const DriveSimulationReport& simulation) {
  Json document = to_json(simulation.measured);
  document["summary"] = sentence_of(simulation);
  document["simulated"] = simulated_json(simulation.simulated);
  return document;
}

Json to_json(const DriveExplanationReport& report) {
  const drive::DriveExplanation& e = report.explanation;
  Json findings = Json::array();
  for (const drive::DriveFinding& f : e.findings) {
    Json finding{{"cause", f.cause},
                 {"parameter", f.parameter},
                 {"words", drive::words_of(f.cause)},
                 {"title", f.title},
                 {"value", number(f.value)},
                 {"se", number(f.se)},
                 {"unit", f.unit},
                 {"score", number(f.score)},
                 {"evidence", f.evidence},
                 {"told_apart", f.told_apart},
                 {"at_bound", f.at_bound},
                 {"kept", f.kept},
                 {"held_out_gain", number(f.held_out_gain)}};
    if (!f.pair.empty()) {
      finding["pair"] = f.pair;
      finding["pair_words"] = drive::words_of(f.pair);
    }
    findings.push_back(std::move(finding));
  }
  Json rungs = Json::array();
  for (const drive::Rung& rung : e.rungs) {
    Json durations = Json::array();
    for (const drive::RungFigures& d : rung.durations) {
      durations.push_back(
          Json{{"duration_s", number(d.duration_s)},
               {"found", {{"n", d.found_count}, {"rms_m", number(d.found_rms_m)}, {"nees", number(d.found_nees)}}},
               {"held_out",
                {{"n", d.held_out_count},
                 {"rms_m", number(d.held_out_rms_m)},
                 {"median_m", number(d.held_out_median_m)},
                 {"nees", number(d.held_out_nees)},
                 {"coverage50", number(d.held_out_coverage50)},
                 {"coverage95", number(d.held_out_coverage95.value)},
                 {"coverage95_ci95", interval(d.held_out_coverage95.ci95)},
                 {"log_score", number(d.held_out_log_score)}}}});
    }
    rungs.push_back(Json{{"name", rung.name}, {"kept", rung.kept}, {"durations", std::move(durations)}});
  }
  return Json{
      {"id", report.drive.document.id},
      {"vehicle", name_of(report.drive.document.vehicle)},
      {"summary", sentence_of(report)},
      {"algorithm_version", drive::kDriveAlgorithmVersion},
      {"facts", facts_to_json(report.drive)},
      {"path", path_json(report.drive)},
      {"findings", std::move(findings)},
      {"rungs", std::move(rungs)},
      {"white_noise_factors", {{"gyroscope", number(e.gyro_noise)}, {"accelerometer", number(e.force_noise)}}},
      {"before",
       {{"durations", durations_json(e.before, report.drive)}, {"simulated", simulated_json(e.simulated_before)}}},
      {"after",
       {{"durations", durations_json(e.after, report.drive)}, {"simulated", simulated_json(e.simulated_after)}}},
      {"notes", e.notes}};
}

}  // namespace driftlab
