#include "schema/text/drive.hpp"

#include "core/signal/angle.hpp"
#include "schema/text/printed.hpp"

#include <array>

namespace driftlab {
std::string notes_of_drive(const std::vector<std::string>& notes) {
  std::string text;
  for (const std::string& note : notes) {
    text += "  - " + note + "\n";
  }
  return text.empty() ? text : "\nTrue of this drive:\n" + text;
}

std::string header_of_drive(const drive::Drive& drive) {
  const drive::FileFacts& facts = drive.facts;
  return printed("%s: %s, %.0f s, %.2f km, up to %.1f m/s\n", drive.document.id.c_str(),
                 std::string(name_of(drive.document.vehicle)).c_str(), drive.end_s(), 1e-3 * facts.length_m,
                 facts.highest_speed_m_s);
}

std::string drive_check_to_text(const DriveCheck& checked) {
  const drive::FileFacts& facts = checked.drive.facts;
  const drive::SamplingFacts& sampling = facts.sampling;
  std::string text = header_of_drive(checked.drive);
  text += printed("\nInertial unit: %zu rows, stamped at %.2f Hz, steps scatter by %.2f ms\n", sampling.rows,
                  sampling.stamped_rate_hz, 1e3 * sampling.jitter_s);
  if (sampling.polled_faster) {
    text += printed(
        "  The host polls faster than the sensor samples: %zu rows (%.2f %%) repeat the row before; the sensor runs at "
        "%.2f Hz. They are dropped, and the others get equal spacing.\n",
        sampling.repeated, checked.repeated_percent(), sampling.sensor_rate_hz);
  } else if (sampling.repeated > 0) {
    text +=
        printed("  %zu rows repeat the row before, %zu of them in longer runs.\n", sampling.repeated, sampling.stuck);
  }
  text += printed("  gaps: %zu bridged (%zu samples), %zu too long to bridge, the longest %.2f s; runs: %zu\n",
                  sampling.gaps_bridged, sampling.samples_bridged, sampling.gaps_splitting, sampling.longest_gap_s,
                  checked.drive.runs.size());
  text += printed(
      "Fixes: %zu used at %.2f Hz; left out: %zu held, %zu of other types, %zu without a position, %zu far "
      "away\n",
      facts.fixes, facts.fix_rate_hz, facts.held, facts.other_types, facts.incomplete, facts.far_away);
  text += printed("Rest: %.0f s in %zu stretches\n", checked.resting_s(), checked.rests.size());
  if (checked.start) {
    const drive::Start& start = *checked.start;
    const EulerAngles angles = start.attitude();
    text += printed(
        "Start: at %.2f s, roll %.1f, pitch %.1f, heading %.1f deg; tilt from %s (%.0f deg), heading from %s "
        "(%.0f deg)\n",
        start.time_s, angles.roll_rad / kDegree, angles.pitch_rad / kDegree, angles.heading_rad / kDegree,
        start.tilt_from == drive::TiltFrom::Rest     ? "rest"
        : start.tilt_from == drive::TiltFrom::Stated ? "the document"
                                                     : "a second of motion",
        start.uncertainty.tilt_sd_rad / kDegree,
        start.heading_from == drive::HeadingFrom::Stated ? "the document" : "the course",
        start.uncertainty.heading_sd_rad / kDegree);
  } else {
    text += "No start: " + checked.cannot_start + "\n";
  }
  return text + notes_of_drive(facts.notes);
}

std::string duration_rows(const std::vector<drive::DurationSummary>& durations) {
  std::string text =
      "outage   n   rms m  [95 %]             median   95 %  worst  along  across   NEES  in 50 %  in 95 %  line m  "
      "promised m\n";
  for (const drive::DurationSummary& d : durations) {
    text += printed("%4.0f s %4zu %7.2f  [%7.2f, %7.2f] %7.2f %6.1f %6.1f %6.1f %7.1f %6.1f %8.2f %8.2f %7.1f %11.2f\n",
                    d.duration_s, d.outages.size(), d.rms_m.value, d.rms_m.ci95.low, d.rms_m.ci95.high,
                    d.median_m.value, d.p95_m, d.worst_m, d.along_rms_m, d.across_rms_m, d.nees.value,
                    d.coverage50.value, d.coverage95.value, d.straight_line_rms_m, d.promised_rms_m);
  }
  return text;
}

std::string drive_report_to_text(const DriveReport& report) {
  std::string text =
      sentence_of(report) + "\n\n" + header_of_drive(report.drive) + "\n" + duration_rows(report.evaluation.durations);
  text += "\nBy what the vehicle does:\n";
  for (const drive::DurationSummary& d : report.evaluation.durations) {
    for (const auto& c : d.classes) {
      text += printed("%4.0f s  %-8s  n %3zu  rms %7.2f m  NEES %7.1f\n", d.duration_s,
                      std::string(name_of(c.outage_class)).c_str(), c.count, c.rms_m, c.nees);
    }
  }
  constexpr std::array<const char*, 6> kKinds{"position",      "velocity", "constraint",
                                              "zero velocity", "odometer", "zero turn"};
  text += "\nInnovations (horizontal), all fixes used:\n";
  for (const drive::InnovationSummary& one : report.evaluation.innovations) {
    text += printed(
        "  %-13s n %6zu  rms %8.3f, stated %8.3f; normalised square %6.2f; correlation: next %.2f, 1 s %.2f, 4 "
        "s %.2f\n",
        kKinds[static_cast<std::size_t>(one.kind)], one.count, one.rms, one.stated_rms, one.normalised,
        one.correlation_next, one.correlation_1s, one.correlation_4s);
  }
  if (report.evaluation.heading_known_s) {
    text += printed("Heading known to 1 deg from %.0f s on.\n", *report.evaluation.heading_known_s);
  } else {
    text += "The heading is never known to 1 deg.\n";
  }
  for (const drive::NaturalOutage& natural : report.evaluation.natural) {
    text += printed("Natural outage, not scored: %.1f s from %.1f s on\n", natural.duration_s, natural.start_s);
  }
  std::vector<std::string> notes = report.drive.facts.notes;
  notes.insert(notes.end(), report.evaluation.notes.begin(), report.evaluation.notes.end());
  return text + notes_of_drive(notes);
}

namespace {

std::string simulated_rows(const std::vector<drive::SimulatedDuration>& simulated) {
  std::string text = "outage   n sim  rms m  median  NEES  in 50 %  in 95 % [95 %]      measured / simulated [95 %]\n";
  for (const drive::SimulatedDuration& s : simulated) {
    text += printed("%4.0f s %7zu %7.2f %7.2f %5.2f %8.2f %8.2f [%.2f, %.2f]  %.3g [%.3g, %.3g]\n", s.duration_s,
                    s.count, s.rms_m, s.median_m, s.nees.value, s.coverage50.value, s.coverage95.value,
                    s.coverage95.ci95.low, s.coverage95.ci95.high, s.ratio.value, s.ratio.ci95.low, s.ratio.ci95.high);
  }
  return text;
}

}  // namespace

std::string size_of_finding(const drive::DriveFinding& finding) {
  std::string text = printed("%.4g", finding.value);
  if (finding.se > 0.0) {
    text += printed(" +- %.2g", finding.se);
  }
  return finding.unit.empty() || finding.unit == "1" ? text : text + " " + finding.unit;
}

std::string drive_explanation_to_text(const DriveExplanationReport& report) {
  const drive::DriveExplanation& e = report.explanation;
  std::string text = sentence_of(report) + "\n\n" + header_of_drive(report.drive) + "\nFound:\n";
  for (const drive::DriveFinding& f : e.findings) {
    text += printed("  %s %s: %s %s (score %.0f, from %s)%s\n", f.cause.c_str(), f.parameter.c_str(), f.title.c_str(),
                    size_of_finding(f).c_str(), f.score, f.evidence.c_str(),
                    f.pair.empty() ? "" : (", not told apart from " + std::string(drive::words_of(f.pair))).c_str());
    if (f.at_bound) {
      text += "      the value lies where the search ends, beyond what this can be: something else looks like it\n";
    }
    if (f.judged) {
      text += printed("      held-out outages: log score %+.3f; %s\n", f.held_out_gain,
                      f.kept ? "kept in the mended model" : "found, but no gain: not in the mended model");
    }
  }
  if (e.findings.empty()) {
    text += "  nothing\n";
  }
  text +=
      "\nRungs (each adds to those kept before it; errors on outages that found its values and on those that did "
      "not):\n"
      "                                                      found           held out\n"
      "rung                                         outage   n   rms m  NEES   n   rms m  median  NEES  in 50 %  in 95 "
      "%\n";
  for (const drive::Rung& rung : e.rungs) {
    for (const drive::RungFigures& d : rung.durations) {
      text += printed("%-44s %4.0f s %4zu %7.2f %5.1f %4zu %7.2f %7.2f %5.1f %8.2f %8.2f%s\n", rung.name.c_str(),
                      d.duration_s, d.found_count, d.found_rms_m, d.found_nees, d.held_out_count, d.held_out_rms_m,
                      d.held_out_median_m, d.held_out_nees, d.held_out_coverage50, d.held_out_coverage95.value,
                      rung.kept ? "" : "  (not kept)");
    }
  }
  text +=
      "\nAs stamped, the document's model:\n" + duration_rows(e.before.durations) + simulated_rows(e.simulated_before);
  text += "\nMended:\n" + duration_rows(e.after.durations) + simulated_rows(e.simulated_after);
  std::vector<std::string> notes = report.drive.facts.notes;
  notes.insert(notes.end(), e.notes.begin(), e.notes.end());
  return text + notes_of_drive(notes);
}

std::string drive_simulation_to_text(const DriveSimulationReport& simulation) {
  return sentence_of(simulation) + "\n\n" + header_of_drive(simulation.measured.drive) + "\nMeasured:\n" +
         duration_rows(simulation.measured.evaluation.durations) + "\nSimulated:\n" +
         simulated_rows(simulation.simulated);
}

std::string drive_answer_to_text(const DriveAnswer& answer) {
  if (const auto* const explained = std::get_if<DriveExplanationReport>(&answer)) {
    return drive_explanation_to_text(*explained);
  }
  if (const auto* const compared = std::get_if<DriveComparisonReport>(&answer)) {
    return drive_comparison_to_text(*compared);
  }
  const auto* const simulated = std::get_if<DriveSimulationReport>(&answer);
  return simulated != nullptr ? drive_simulation_to_text(*simulated)
                              : drive_report_to_text(std::get<DriveReport>(answer));
}

}  // namespace driftlab
