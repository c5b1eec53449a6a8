#include "core/navigate/drive/explain.hpp"

#include "core/navigate/drive/profile.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace driftlab::drive {
namespace {

constexpr double kLevelNamed = 5.0;            ///< score
constexpr std::uint64_t kHeldOutStream = 400;  ///< of the bootstrap

/// The options as they are for each fold: what the other fold has shown.
using FoldOptions = std::array<FilterOptions, LogLikelihood::kFolds>;

double log_score(const DriveOutage& o) {
  const Matrix3& p = o.covariance_ned;
  const double determinant = p(0, 0) * p(1, 1) - p(0, 1) * p(1, 0);
  return -0.5 * (std::log(determinant) + o.nees());
}

/// The outages of each duration of the plan.
using ScoredOutages = std::vector<std::vector<DriveOutage>>;

/// Outages by whether the fold whose values they were scored under has seen them.
struct OutageLists {
  std::vector<DriveOutage> found, held_out;
};

void sort_by_fold(const ScoredOutages& scored, std::size_t fold, std::vector<OutageLists>& lists) {
  for (std::size_t d = 0; d < scored.size(); ++d) {
    for (const DriveOutage& outage : scored[d]) {
      if (const auto own = fold_of(outage.outage)) {
        (*own == fold ? lists[d].found : lists[d].held_out).push_back(outage);
      }
    }
  }
}

Rung rung_of_lists(const OutagePlan& plan, std::string name, std::vector<OutageLists> lists) {
  Rung rung;
  rung.name = std::move(name);
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
    const double period = plan.at_s.empty() ? plan.every_s[d] : plan.duration_s[d];
    figures.held_out_coverage95 =
        share_inside(held.outages, blocks_of(held.outages, period), 0.95, EvaluationOptions{}, kHeldOutStream);
    rung.durations.push_back(figures);
  }
  return rung;
}

/// Outages of the plan under values that fold 0 has shown and under those of fold 1.
Rung rung_of(const Drive& drive, std::string name, const FoldOptions& by_fold, const RunControl& control) {
  std::vector<OutageLists> lists(drive.document.outages.duration_s.size());
  for (std::size_t fold = 0; fold < by_fold.size(); ++fold) {
    if (const auto prepared = PreparedDrive::make(drive, by_fold[fold])) {
      sort_by_fold(scored_outages(*prepared, control), fold, lists);
    }
  }
  return rung_of_lists(drive.document.outages, std::move(name), std::move(lists));
}

/// Outages that were scored under values which no fold has shown.
Rung rung_of(const OutagePlan& plan, std::string name, const ScoredOutages& scored) {
  std::vector<OutageLists> lists(plan.duration_s.size());
  for (std::size_t fold = 0; fold < LogLikelihood::kFolds; ++fold) {
    sort_by_fold(scored, fold, lists);
  }
  return rung_of_lists(plan, std::move(name), std::move(lists));
}

/// The outages that an evaluation scored, by the plan's durations.
ScoredOutages outages_of(const DriveEvaluation& evaluation, const OutagePlan& plan) {
  ScoredOutages scored(plan.duration_s.size());
  for (const DurationSummary& summary : evaluation.durations) {
    const auto at = std::find(plan.duration_s.begin(), plan.duration_s.end(), summary.duration_s);
    scored[static_cast<std::size_t>(at - plan.duration_s.begin())] = summary.outages;
  }
  return scored;
}

/// Mean over durations of the held-out log score.
double held_out_score(const Rung& rung) {
  double sum = 0.0;
  for (const RungFigures& figures : rung.durations) {
    sum += figures.held_out_log_score / static_cast<double>(rung.durations.size());
  }
  return sum;
}

/// What the files show, in the order of the causes: `start` is told all of it, `first` what says which readings may be
/// used.
std::vector<DriveFinding> findings_of_files(const Drive& drive, FilterOptions& first, FilterOptions& start) {
  std::vector<DriveFinding> findings;
  for (const Cause& cause : cause_registry()) {
    auto found = cause.from_files != nullptr ? cause.from_files(drive, start) : std::nullopt;
    if (!found) {
      continue;
    }
    found->finding.cause = cause.name;
    found->finding.from_files = true;
    if (found->use) {
      found->use(start);
      if (found->of_readings) {
        found->use(first);
      }
    }
    findings.push_back(std::move(found->finding));
  }
  return findings;
}

void add_note(std::vector<std::string>& notes, std::string note) {
  if (!note.empty() && std::find(notes.begin(), notes.end(), note) == notes.end()) {
    notes.push_back(std::move(note));
  }
}

/// What the causes of the innovations' findings add in words.
std::vector<std::string> notes_on(const std::vector<DriveFinding>& findings,
                                  const std::vector<DriveFinding>& of_files) {
  std::vector<std::string> notes;
  for (const DriveFinding& finding : findings) {
    const Cause& cause = *find_cause(finding.cause);
    const bool known = std::any_of(of_files.begin(), of_files.end(),
                                   [&](const DriveFinding& other) { return other.cause == finding.cause; });
    add_note(notes, cause.note != nullptr ? cause.note(finding, known) : "");
  }
  return notes;
}

/// The evidence of a finding of the innovations, with what the files show of it.
std::string evidence_of(const DriveFinding& finding, const Drive& drive) {
  const Cause& cause = *find_cause(finding.cause);
  const std::string seen = cause.seen_in_files != nullptr ? cause.seen_in_files(drive) : "";
  return seen.empty() ? finding.evidence : finding.evidence + "; " + seen;
}

/// The levels of the noise that are worth a name under the options.
std::vector<DriveFinding> findings_of_levels(const Drive& drive, const FilterOptions& options,
                                             const RunControl& control) {
  std::vector<DriveFinding> findings;
  const Profile profile(drive, {true, true}, control);
  for (const Cause& cause : cause_registry()) {
    for (const NoiseLevel& level : cause.levels) {
      const double factor = options.*level.factor;
      if (factor < level.named_from && factor > 1.0 / level.named_from) {
        continue;
      }
      FilterOptions without = options;
      without.*level.factor = 1.0;
      const auto sums = profile.values({options, without});
      DriveFinding finding;
      finding.cause = cause.name;
      finding.parameter = level.parameter;
      finding.title = level.title;
      finding.unit = "1";
      finding.value = factor;
      finding.evidence = "innovations";
      finding.told_apart = level.told_apart;
      finding.score = std::max((sums[0] - sums[1]) / profile.scale(options), 0.0);
      if (finding.score >= kLevelNamed) {
        findings.push_back(std::move(finding));
      }
    }
  }
  return findings;
}

/// The levels of the noise as the options `from` have them.
void take_levels(const FilterOptions& from, FilterOptions& into) {
  for (const Cause& cause : cause_registry()) {
    for (const NoiseLevel& level : cause.levels) {
      into.*level.factor = from.*level.factor;
    }
  }
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
  first.odometer = !drive.odometer.empty();
  FilterOptions start = first;
  explanation.findings = findings_of_files(drive, first, start);
  const FilterOptions from_files = start;
  auto search = search_causes(drive, start, options.most_causes, control);
  if (!search) {
    return fail(search.error());
  }
  explanation.notes = notes_on(search->findings, explanation.findings);
  std::vector<const Knob*> knobs;
  for (const DriveFinding& finding : search->findings) {
    knobs.push_back(find_knob(finding.cause, finding.parameter));
    explanation.findings.push_back(finding);
    explanation.findings.back().evidence = evidence_of(finding, drive);
  }
  explanation.gyro_noise = search->options.gyro_noise;
  explanation.force_noise = search->options.force_noise;
  for (DriveFinding& finding : findings_of_levels(drive, search->options, control)) {
    explanation.findings.push_back(std::move(finding));
  }

  control.report("held-out outages", 0.5);
  FoldOptions fitted{search->options, search->options};
  parallel_for(
      control.threads, fitted.size(),
      [&](std::size_t fold) { fitted[fold] = fitted_on(drive, fold, search->options, knobs, control); }, control.stop);
  const OutagePlan& plan = drive.document.outages;
  explanation.rungs.push_back(rung_of(plan, "as stamped, the document's model", outages_of(explanation.before, plan)));
  const auto prepared_first = PreparedDrive::make(drive, first);
  if (!prepared_first) {
    return fail(prepared_first.error());
  }
  explanation.rungs.push_back(rung_of(plan,
                                      drive.facts.sampling.polled_faster ? "repeats out, fixes dated" : "fixes dated",
                                      scored_outages(*prepared_first, control)));
  // The noise level comes first: judged under the document's, every gain would be one of covariance alone.
  FoldOptions current{first, first};
  for (std::size_t fold = 0; fold < current.size(); ++fold) {
    take_levels(fitted[fold], current[fold]);
  }
  const double unmended_score = held_out_score(explanation.rungs.back());
  explanation.rungs.push_back(rung_of(drive, "the white noise of the road", current, control));
  for (DriveFinding& finding : explanation.findings) {
    if (!find_cause(finding.cause)->levels.empty()) {
      finding.judged = true;
      finding.held_out_gain = held_out_score(explanation.rungs.back()) - unmended_score;
    }
  }
  const auto set = [&](FoldOptions& folds, const DriveFinding& finding, bool on) {
    const Knob* const knob = find_knob(finding.cause, finding.parameter);
    for (std::size_t fold = 0; fold < folds.size(); ++fold) {
      const FilterOptions& source = !on ? first : finding.from_files ? from_files : fitted[fold];
      knob->turn(folds[fold], knob->value(source) - knob->value(folds[fold]));
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
  const double without_last = held_out_score(*std::prev(explanation.rungs.end(), turned.empty() ? 1 : 2));
  for (DriveFinding* const finding : turned) {
    FoldOptions without = current;
    set(without, *finding, false);
    finding->judged = true;
    finding->held_out_gain =
        whole - (finding == turned.back() ? without_last : held_out_score(rung_of(drive, "", without, control)));
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
  take_levels(search->options, explanation.extended);
  for (const DriveFinding* const finding : turned) {
    if (finding->kept) {
      const Knob& knob = *find_knob(finding->cause, finding->parameter);
      knob.turn(explanation.extended, knob.value(search->options) - knob.value(explanation.extended));
    }
  }
  control.report("the mended model", 0.9);
  auto after = evaluate_drive(drive, explanation.extended, settings, control);
  if (!after) {
    return fail(after.error());
  }
  explanation.after = std::move(*after);
  for (const DriveFinding& finding : search->findings) {
    const Cause& cause = *find_cause(finding.cause);
    add_note(explanation.notes,
             cause.seen_in_outages != nullptr ? cause.seen_in_outages(drive, explanation.after) : "");
  }
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
