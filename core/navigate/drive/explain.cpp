#include "core/navigate/drive/explain.hpp"

#include "core/navigate/drive/profile.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kSureOfDelay = 3.0;
constexpr double kNamedDelay = 5.0;
constexpr double kNoiseNamed = 1.25;  ///< a factor of the white noise that is worth a name

/// The options as they are for each fold: what the other fold has shown.
using FoldOptions = std::array<FilterOptions, LogLikelihood::kFolds>;

/// Whether the two are known to be alike: one set of runs is then enough.
enum class FoldValues { Apart, Alike };

double log_score(const DriveOutage& o) {
  const Matrix3& p = o.covariance_ned;
  const double determinant = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  return -0.5 * (std::log(determinant) + o.nees());
}

/// Outages of the plan under values that fold 0 has shown and under those of fold 1, by whether they were seen.
Rung rung_of(const Drive& drive, std::string name, const FoldOptions& by_fold, const RunControl& control,
             FoldValues values = FoldValues::Apart) {
  Rung rung;
  rung.name = std::move(name);
  const OutagePlan& plan = drive.document.outages;
  struct Lists {
    std::vector<DriveOutage> found, held_out;
  };
  std::vector<Lists> lists(plan.duration_s.size());
  std::vector<std::vector<DriveOutage>> scored;
  for (std::size_t fold = 0; fold < by_fold.size(); ++fold) {
    if (fold == 0 || values == FoldValues::Apart) {
      const auto prepared = PreparedDrive::make(drive, by_fold[fold]);
      if (!prepared) {
        continue;
      }
      scored = scored_outages(*prepared, control);
    }
    for (std::size_t d = 0; d < scored.size(); ++d) {
      for (const DriveOutage& outage : scored[d]) {
        if (const auto own = fold_of(outage.outage)) {
          (*own == fold ? lists[d].found : lists[d].held_out).push_back(outage);
        }
      }
    }
  }
  EvaluationOptions no_bootstrap;
  no_bootstrap.resamples = 0;
  for (std::size_t d = 0; d < lists.size(); ++d) {
    if (lists[d].found.empty() || lists[d].held_out.empty()) {
      continue;
    }
    RungFigures figures;
    figures.duration_s = plan.duration_s[d];
    figures.found_count = lists[d].found.size();
    figures.held_out_count = lists[d].held_out.size();
    for (const DriveOutage& outage : lists[d].held_out) {
      figures.held_out_log_score += log_score(outage) / static_cast<double>(lists[d].held_out.size());
    }
    const DurationSummary found = summarise(std::move(lists[d].found), figures.duration_s, 1e9, no_bootstrap);
    const DurationSummary held = summarise(std::move(lists[d].held_out), figures.duration_s, 1e9, no_bootstrap);
    figures.found_rms_m = found.rms_m.value;
    figures.found_nees = found.nees.value;
    figures.held_out_rms_m = held.rms_m.value;
    figures.held_out_median_m = held.median_m.value;
    figures.held_out_nees = held.nees.value;
    figures.held_out_coverage50 = held.coverage50.value;
    figures.held_out_coverage95 = held.coverage95.value;
    rung.durations.push_back(figures);
  }
  return rung;
}

/// Mean over durations of the held-out log score.
double held_out_score(const Rung& rung) {
  double sum = 0.0;
  for (const RungFigures& figures : rung.durations) {
    sum += figures.held_out_log_score / static_cast<double>(rung.durations.size());
  }
  return sum;
}

DriveFinding finding_of_clock(const Drive& drive) {
  const SamplingFacts& s = drive.facts.sampling;
  DriveFinding finding;
  finding.cause = "sample_clock";
  finding.parameter = "rate_hz";
  finding.title = "the host polls faster than the sensor samples, which runs at";
  finding.unit = "Hz";
  finding.value = s.sensor_rate_hz;
  const double span = drive.end_s();
  finding.se = s.sensor_rate_hz * s.jitter_s / span;
  // Repeats at random would be as likely anywhere; a lattice of them is not. One nat for each is a small part of it.
  finding.score = static_cast<double>(s.repeated - s.stuck);
  finding.evidence = "the file";
  finding.told_apart = "a lattice of single repeated rows; irregular runs of equal rows are a stuck sensor";
  return finding;
}

DriveFinding finding_of_delay(const FixDelay& delay) {
  const Knob& knob = *find_knob("gnss_velocity_latency", "delay_s");
  DriveFinding finding;
  finding.cause = knob.cause;
  finding.parameter = knob.parameter;
  finding.title = knob.title;
  finding.unit = knob.unit;
  finding.value = delay.delay_s;
  finding.se = delay.se_s;
  finding.score = delay.score;
  finding.evidence = "the fixes alone";
  finding.told_apart = knob.told_apart;
  return finding;
}

DriveFinding finding_of_noise(const char* sensor, double factor, const Drive& drive) {
  DriveFinding finding;
  finding.cause = "noise_level";
  finding.parameter = sensor;
  finding.title = std::string("the white noise of the ") + sensor + " on the road is that of the model times";
  finding.unit = "1";
  finding.value = factor;
  finding.evidence = "innovations";
  finding.told_apart = "what is left when every other cause is set: innovations that are white yet too large";
  (void)drive;
  return finding;
}

DriveFinding finding_of_slips(const WheelSlips& found) {
  DriveFinding finding;
  finding.cause = "wheel_slip";
  finding.parameter = "seconds";
  finding.title = "the wheel of the odometer slips or locks, " + how_often(found.slips.size()) + ", in all";
  finding.unit = "s";
  finding.value = found.seconds();
  // Each reading of a slip is five standard deviations off and more: 12 nats in half of its square.
  finding.score = 12.5 * static_cast<double>(found.slips.size());
  finding.evidence = "odometer and fixes";
  finding.told_apart = "bursts; a scale factor of the odometer is the same everywhere";
  return finding;
}

/// The findings' knobs, fitted again on one fold from the whole drive's values.
FilterOptions fitted_on(const Drive& drive, std::size_t fold, const FilterOptions& options,
                        const std::vector<const Knob*>& knobs, const RunControl& control) {
  std::array<bool, LogLikelihood::kFolds> used{};
  used[fold] = true;
  const Profile profile(drive, used, control);
  return profile.with_noise_fitted(profile.refitted(options, knobs, 1), 1.2);
}

}  // namespace

Result<DriveExplanation> explain_drive(const Drive& drive, const Drive& as_stamped, const ExplainOptions& options,
                                       const RunControl& control) {
  DriveExplanation explanation;
  const EvaluationOptions settings{.seed = options.seed};
  FilterOptions first = options_of(drive.document);
  if (options.constraint) {
    if (!moves_along_its_nose(drive.document.vehicle)) {
      return fail(ErrorCode::InvalidArgument, "The vehicle does not move along its nose: no velocity constraints.",
                  {{"parameter", "vehicle"}});
    }
    first.constraint.emplace();
  }
  FilterOptions unmended = first;
  unmended.date_to_sample = true;
  unmended.odometer = !drive.odometer.empty();
  control.report("as stamped", 0.0);
  auto before = evaluate_drive(as_stamped, unmended, settings, control);
  if (!before) {
    return fail(before.error());
  }
  explanation.before = std::move(*before);
  const auto prepared_before = PreparedDrive::make(as_stamped, unmended);
  auto simulated =
      simulate_outages(*prepared_before, explanation.before.durations, {options.simulated_runs, options.seed}, control);
  if (!simulated) {
    return fail(simulated.error());
  }
  explanation.simulated_before = std::move(*simulated);

  control.report("causes", 0.1);
  FilterOptions start = first;
  if (drive.facts.sampling.polled_faster) {
    explanation.findings.push_back(finding_of_clock(drive));
  }
  explanation.fix_delay = delay_from_fixes(drive.fixes);
  if (explanation.fix_delay) {
    const FixDelay& delay = *explanation.fix_delay;
    const double rest = delay.delay_s - (start.velocity_latency_s - start.position_latency_s);
    if (delay.score >= kNamedDelay && std::abs(rest) >= kSureOfDelay * delay.se_s) {
      start.velocity_latency_s = start.position_latency_s + delay.delay_s;
      explanation.findings.push_back(finding_of_delay(delay));
    }
  }
  if (!drive.odometer.empty()) {
    first.odometer = start.odometer = true;
    const auto slips = slips_of(drive, start.velocity_latency_s);
    if (slips && !slips->slips.empty()) {
      first.slips = start.slips = slips->slips;
      explanation.findings.push_back(finding_of_slips(*slips));
    }
  }
  const FilterOptions from_files = start;
  auto search = search_causes(drive, start, options.most_causes, control);
  if (!search) {
    return fail(search.error());
  }
  std::vector<const Knob*> knobs;
  for (const DriveFinding& finding : search->findings) {
    knobs.push_back(find_knob(finding.cause, finding.parameter));
    const bool again = std::any_of(explanation.findings.begin(), explanation.findings.end(),
                                   [&](const DriveFinding& f) { return f.cause == finding.cause; });
    if (again && finding.cause == "gnss_velocity_latency") {
      explanation.notes.push_back("The innovations put the delay of the velocities at " +
                                  std::to_string(finding.value) +
                                  " s: a receiver's velocity can be a mean over the interval before it.");
    }
    explanation.findings.push_back(finding);
  }
  for (const DriveFinding& finding : search->findings) {
    if (finding.cause == "imu_time_offset") {
      explanation.notes.emplace_back(
          "An offset of the unit's clock and an equal delay of all fixes are the same thing here: only "
          "the difference of the two clocks shows.");
    }
  }
  explanation.gyro_noise = search->options.gyro_noise;
  explanation.force_noise = search->options.force_noise;
  for (const auto& [sensor, factor] :
       {std::pair{"gyroscope", explanation.gyro_noise}, std::pair{"accelerometer", explanation.force_noise}}) {
    if (factor >= kNoiseNamed || factor <= 1.0 / kNoiseNamed) {
      DriveFinding finding = finding_of_noise(sensor, factor, drive);
      FilterOptions without = search->options;
      (sensor[0] == 'g' ? without.gyro_noise : without.force_noise) = 1.0;
      const Profile profile(drive, {true, true}, control);
      const auto sums = profile.values({search->options, without});
      finding.score = std::max((sums[0] - sums[1]) / profile.scale(search->options), 0.0);
      if (finding.score >= kNamedDelay) {
        explanation.findings.push_back(finding);
      }
    }
  }

  control.report("held-out outages", 0.5);
  FoldOptions fitted;
  for (std::size_t fold = 0; fold < fitted.size(); ++fold) {
    fitted[fold] = fitted_on(drive, fold, search->options, knobs, control);
  }
  explanation.rungs.push_back(
      rung_of(as_stamped, "as stamped, the document's model", {unmended, unmended}, control, FoldValues::Alike));
  explanation.rungs.push_back(rung_of(drive,
                                      drive.facts.sampling.polled_faster ? "repeats out, fixes dated" : "fixes dated",
                                      {first, first}, control, FoldValues::Alike));
  // The noise level comes first: judged under the document's, every gain would be one of covariance alone.
  FoldOptions current{first, first};
  for (std::size_t fold = 0; fold < current.size(); ++fold) {
    current[fold].gyro_noise = fitted[fold].gyro_noise;
    current[fold].force_noise = fitted[fold].force_noise;
  }
  const double unmended_score = held_out_score(explanation.rungs.back());
  explanation.rungs.push_back(rung_of(drive, "the white noise of the road", current, control));
  for (DriveFinding& finding : explanation.findings) {
    if (finding.cause == "noise_level") {
      finding.held_out_gain = held_out_score(explanation.rungs.back()) - unmended_score;
    }
  }
  const auto set = [&](FoldOptions& folds, const DriveFinding& finding, bool on) {
    const Knob* const knob = find_knob(finding.cause, finding.parameter);
    for (std::size_t fold = 0; fold < folds.size(); ++fold) {
      const FilterOptions& source = !on ? first : finding.evidence == "the fixes alone" ? from_files : fitted[fold];
      knob->turn(folds[fold], Profile::value_of(source, *knob) - Profile::value_of(folds[fold], *knob));
    }
  };
  std::vector<DriveFinding*> turned;
  for (DriveFinding& finding : explanation.findings) {
    if (find_knob(finding.cause, finding.parameter) == nullptr || control.stop.stop_requested()) {
      continue;
    }
    set(current, finding, true);
    explanation.rungs.push_back(
        rung_of(drive, "+ " + words_of(*find_knob(finding.cause, finding.parameter)), current, control));
    turned.push_back(&finding);
  }
  // What each is worth beside all the others, on outages that it has not seen.
  const double whole = held_out_score(explanation.rungs.back());
  FoldOptions mended = current;
  bool dropped = false;
  for (DriveFinding* const finding : turned) {
    FoldOptions without = current;
    set(without, *finding, false);
    finding->held_out_gain = whole - held_out_score(rung_of(drive, "", without, control));
    finding->kept = finding->held_out_gain > 0.0;
    if (!finding->kept) {
      set(mended, *finding, false);
      dropped = true;
    }
  }
  if (dropped) {
    Rung rung = rung_of(drive, "without what gains nothing", mended, control);
    rung.kept = held_out_score(rung) > whole;
    if (!rung.kept) {  // they gain nothing one by one, but together they do
      std::for_each(turned.begin(), turned.end(), [](DriveFinding* finding) { finding->kept = true; });
    }
    explanation.rungs.push_back(std::move(rung));
  }
  // The extended model: what was kept, with the whole drive's values.
  explanation.extended = first;
  explanation.extended.gyro_noise = search->options.gyro_noise;
  explanation.extended.force_noise = search->options.force_noise;
  for (const DriveFinding* const finding : turned) {
    if (finding->kept) {
      const Knob& knob = *find_knob(finding->cause, finding->parameter);
      knob.turn(explanation.extended,
                Profile::value_of(search->options, knob) - Profile::value_of(explanation.extended, knob));
    }
  }
  control.report("the mended model", 0.9);
  auto after = evaluate_drive(drive, explanation.extended, settings, control);
  if (!after) {
    return fail(after.error());
  }
  explanation.after = std::move(*after);
  const auto prepared_after = PreparedDrive::make(drive, explanation.extended);
  simulated =
      simulate_outages(*prepared_after, explanation.after.durations, {options.simulated_runs, options.seed}, control);
  if (!simulated) {
    return fail(simulated.error());
  }
  explanation.simulated_after = std::move(*simulated);
  control.report("the mended model", 1.0);
  return explanation;
}

}  // namespace driftlab::drive
