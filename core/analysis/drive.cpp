#include "core/analysis/drive.hpp"

#include "core/navigate/drive/smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace driftlab {
namespace {

/// A share with its interval: "97 % [95, 99]"; without an interval where there are too few blocks.
std::string percent_of(const Estimate& share) {
  std::array<char, 64> text{};
  if (std::isfinite(share.ci95.low)) {
    std::snprintf(text.data(), text.size(), "%.0f %% [%.0f, %.0f]", 100.0 * share.value, 100.0 * share.ci95.low,
                  100.0 * share.ci95.high);
  } else {
    std::snprintf(text.data(), text.size(), "%.0f %%", 100.0 * share.value);
  }
  return text.data();
}

}  // namespace

std::string_view name_of(DriveQuestion question) {
  constexpr std::array<std::string_view, 4> kNames{"run", "simulate", "explain", "compare"};
  return kNames[static_cast<std::size_t>(question)];
}

std::optional<DriveQuestion> parse_drive_question(std::string_view name) {
  for (const DriveQuestion question :
       {DriveQuestion::Run, DriveQuestion::Simulate, DriveQuestion::Explain, DriveQuestion::Compare}) {
    if (name_of(question) == name) {
      return question;
    }
  }
  return std::nullopt;
}

drive::FilterOptions options_of(const DriveRequest& request, const drive::Document& document) {
  drive::FilterOptions options = drive::options_of(document);
  if (request.velocity_constraint) {
    options.constraint.emplace();
  }
  options.zero_velocity = request.zero_velocity;
  options.odometer = request.odometer;
  options.gate = request.gate;
  if (request.estimate) {
    options.constants = drive::declared_states(document, options);
  }
  return options;
}

drive::Table table_of(const ColumnFile& columns) {
  drive::Table table;
  table.names = columns.names();
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const auto values = columns.column(i);
    table.columns.emplace_back(values.begin(), values.end());
  }
  return table;
}

Result<drive::Tables> open_tables(const drive::Document& document, DriveSource& source, const RunControl& control) {
  drive::Tables tables;
  const auto open = [&](const drive::Source& one) -> Result<drive::Table> {
    auto table = source.open(one, control);
    if (!table) {
      return fail(drive::of_file(table.error(), one.file));
    }
    table->tag = one.time.dates ? one.time.dates : table->tag;
    return table;
  };
  auto imu = open(document.imu.source);
  if (!imu) {
    return fail(imu.error());
  }
  tables.imu = std::move(*imu);
  auto gnss = open(document.gnss.source);
  if (!gnss) {
    return fail(gnss.error());
  }
  tables.gnss = std::move(*gnss);
  const auto optional = [&](const drive::Source* one, std::optional<drive::Table>& into) -> Status {
    if (one == nullptr) {
      return {};
    }
    auto table = open(*one);
    if (!table) {
      return fail(table.error());
    }
    into = std::move(*table);
    return {};
  };
  if (auto status = optional(document.imu.force ? &*document.imu.force : nullptr, tables.force); !status) {
    return fail(status.error());
  }
  if (auto status = optional(document.reference.source ? &*document.reference.source : nullptr, tables.reference);
      !status) {
    return fail(status.error());
  }
  if (auto status = optional(document.odometer ? &document.odometer->source : nullptr, tables.odometer); !status) {
    return fail(status.error());
  }
  return tables;
}

double DriveCheck::resting_s() const {
  double resting_s = 0.0;
  for (const drive::Rest& rest : rests) {
    resting_s += rest.to_s - rest.from_s;
  }
  return resting_s;
}

double DriveCheck::repeated_percent() const {
  const drive::SamplingFacts& sampling = drive.facts.sampling;
  return sampling.rows == 0 ? 0.0 : 100.0 * static_cast<double>(sampling.repeated) / static_cast<double>(sampling.rows);
}

DriveCheck check_drive(drive::Drive drive) {
  DriveCheck checked;
  for (std::size_t run = 0; run < drive.runs.size(); ++run) {
    const auto rests = drive::rests_of(drive, run);
    checked.rests.insert(checked.rests.end(), rests.begin(), rests.end());
    if (checked.start) {
      continue;
    }
    if (auto start = drive::find_start(drive, run)) {
      checked.start = *start;
    } else {
      checked.cannot_start = start.error().message;
    }
  }
  checked.drive = std::move(drive);
  return checked;
}

Status check_options(const drive::Drive& drive, const drive::FilterOptions& options) {
  if (options.constraint && !drive::moves_along_its_nose(drive.document.vehicle)) {
    return fail(ErrorCode::InvalidArgument,
                "A vehicle of kind " + std::string(name_of(drive.document.vehicle)) +
                    " does not move along its nose: velocity constraints are for road, rail and rover.",
                {{"parameter", "vehicle"}});
  }
  if (options.odometer && drive.odometer.empty()) {
    return fail(ErrorCode::InvalidArgument, "The drive has no odometer.", {{"parameter", "odometer"}});
  }
  return {};
}

Result<DriveReport> run_drive(drive::Drive drive, const drive::FilterOptions& options,
                              const drive::EvaluationOptions& settings, const RunControl& control) {
  if (auto status = check_options(drive, options); !status) {
    return fail(status.error());
  }
  auto evaluation = drive::evaluate_drive(drive, options, settings, control);
  if (!evaluation) {
    return fail(evaluation.error());
  }
  return DriveReport{std::move(drive), options, std::move(*evaluation)};
}

Result<drive::Drive> load_with_reference(const drive::Document& document, const drive::Tables& tables,
                                         const drive::LoadOptions& options) {
  auto drive = drive::load_drive(document, tables, options);
  return drive && document.reference.smoothed
             ? drive::with_smoothed_reference(std::move(*drive), drive::options_of(document))
             : std::move(drive);
}

Result<DriveExplanationReport> report_explanation(const drive::Document& document, const drive::Tables& tables,
                                                  const drive::ExplainOptions& options, const RunControl& control) {
  auto drive = load_with_reference(document, tables);
  if (!drive) {
    return fail(drive.error());
  }
  const auto as_stamped = load_with_reference(document, tables, {.repair = false});
  if (!as_stamped) {
    return fail(as_stamped.error());
  }
  auto explanation = drive::explain_drive(*drive, *as_stamped, options, control);
  if (!explanation) {
    return fail(explanation.error());
  }
  return DriveExplanationReport{std::move(*drive), std::move(*explanation)};
}

std::string sentence_of(const DriveExplanationReport& report) {
  const drive::DriveExplanation& e = report.explanation;
  const drive::SimulatedDuration& before = e.simulated_before.front();
  std::string causes;
  for (auto finding = e.findings.begin(); finding != e.findings.end(); ++finding) {
    const auto of_cause = [&](const drive::DriveFinding& other) { return other.cause == finding->cause; };
    if (std::any_of(e.findings.begin(), finding, of_cause)) {
      continue;
    }
    const bool doubtful = std::all_of(finding, e.findings.end(), [&](const drive::DriveFinding& other) {
      return !of_cause(other) || other.at_bound;
    });
    causes.append(causes.empty() ? "" : ", ").append(doubtful ? "what looks like " : "");
    causes.append(drive::words_of(finding->cause));
  }
  std::array<char, 512> text{};
  std::snprintf(
      text.data(), text.size(),
      "After %.3g s without fixes the drive's errors are %.3g times (95 %% interval %.3g to %.3g) those that the "
      "simulation of the same trajectory gives, whose own 95 %% ellipse holds %s of its errors. ",
      before.duration_s, before.ratio.value, before.ratio.ci95.low, before.ratio.ci95.high,
      percent_of(before.coverage95).c_str());
  std::string sentence = text.data();
  sentence += causes.empty() ? "No cause is shown. " : "Found: " + causes + ". ";
  const drive::RungFigures* first = nullptr;
  const drive::RungFigures* last = nullptr;
  for (const drive::Rung& rung : e.rungs) {
    if (rung.durations.empty()) {
      continue;
    }
    first = first == nullptr ? &rung.durations.front() : first;
    last = rung.kept ? &rung.durations.front() : last;
  }
  if (first != nullptr && last != nullptr) {
    std::snprintf(
        text.data(), text.size(),
        "On %zu outages of %.3g s that it has not seen the mended model takes the rms from %.3g to %.3g m and the "
        "NEES from %.3g to %.3g (2 is right), with %s inside its 95 %% ellipse.",
        last->held_out_count, last->duration_s, first->held_out_rms_m, last->held_out_rms_m, first->held_out_nees,
        last->held_out_nees, percent_of(last->held_out_coverage95).c_str());
    sentence += text.data();
  }
  return sentence;
}

Result<DriveSimulationReport> simulate_drive_outages(drive::Drive drive, const drive::FilterOptions& options,
                                                     const drive::SimulationOptions& settings,
                                                     const RunControl& control) {
  auto measured = run_drive(std::move(drive), options, {.seed = settings.seed}, control);
  if (!measured) {
    return fail(measured.error());
  }
  const auto prepared = drive::PreparedDrive::make(measured->drive, options);
  if (!prepared) {
    return fail(prepared.error());
  }
  auto simulated = drive::simulate_outages(*prepared, measured->evaluation.durations, settings, control);
  if (!simulated) {
    return fail(simulated.error());
  }
  return DriveSimulationReport{std::move(*measured), std::move(*simulated)};
}

std::string sentence_of(const DriveSimulationReport& simulation) {
  const drive::SimulatedDuration& first = simulation.simulated.front();
  std::array<char, 512> text{};
  std::snprintf(text.data(), text.size(),
                "After %.3g s without fixes the measured error is %.3g times (95 %% interval %.3g to %.3g) that of the "
                "simulation of the same trajectory, outages and model: %.3g m against %.3g m. The filter's 95 %% "
                "ellipse holds %s of the measured errors and %s of the simulated ones.",
                first.duration_s, first.ratio.value, first.ratio.ci95.low, first.ratio.ci95.high,
                simulation.measured.evaluation.durations.front().rms_m.value, first.rms_m,
                percent_of(simulation.measured.evaluation.durations.front().coverage95).c_str(),
                percent_of(first.coverage95).c_str());
  return text.data();
}

std::string sentence_of(const DriveReport& report) {
  const drive::DurationSummary& first = report.evaluation.durations.front();
  std::array<char, 512> text{};
  std::snprintf(
      text.data(), text.size(),
      "After %.3g s without fixes the filter is %.3g m off (rms of %zu measured outages, 95 %% interval %.3g to "
      "%.3g m); by its own covariance it would be %.3g m: %.2g times as much as the model promises.",
      first.duration_s, first.rms_m.value, first.outages.size(), first.rms_m.ci95.low, first.rms_m.ci95.high,
      first.promised_rms_m, first.rms_m.value / first.promised_rms_m);
  return text.data();
}

Result<DriveAnswer> answer_drive(const DriveRequest& request, const drive::Document& document,
                                 const drive::Tables& tables, const RunControl& control) {
  const auto answer = [](auto report) {
    return report ? Result<DriveAnswer>(std::move(*report)) : Result<DriveAnswer>(fail(report.error()));
  };
  if (request.question == DriveQuestion::Explain) {
    const drive::ExplainOptions options{
        .seed = request.seed, .simulated_runs = request.runs, .constraint = request.velocity_constraint};
    return answer(report_explanation(document, tables, options, control));
  }
  const bool simulate = request.question == DriveQuestion::Simulate;
  auto drive = load_with_reference(document, tables, {.repair = simulate || !request.as_stamped});
  if (!drive) {
    return fail(drive.error());
  }
  if (request.question == DriveQuestion::Compare) {
    return answer(compare_drive_models(std::move(*drive), request, control));
  }
  const drive::FilterOptions options = options_of(request, document);
  if (simulate) {
    return answer(
        simulate_drive_outages(std::move(*drive), options, {.runs = request.runs, .seed = request.seed}, control));
  }
  return answer(run_drive(std::move(*drive), options, {.seed = request.seed}, control));
}

}  // namespace driftlab
