#include "core/investigate/investigate.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/report/checks.hpp"
#include "core/investigate/report/earned.hpp"
#include "core/investigate/report/explain.hpp"
#include "core/investigate/report/figures.hpp"
#include "core/investigate/report/innovation_spectrogram.hpp"
#include "core/investigate/report/order.hpp"
#include "core/investigate/report/outage_gain.hpp"
#include "core/investigate/report/recording_findings.hpp"
#include "core/investigate/report/remains.hpp"
#include "core/investigate/report/unnamed_report.hpp"
#include "core/investigate/report/verdict.hpp"
#include "core/investigate/search/given_model.hpp"
#include "core/investigate/search/group_search.hpp"
#include "core/investigate/search/join_axes.hpp"
#include "core/investigate/search/right_recordings.hpp"
#include "core/investigate/search/thresholds.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <numeric>

namespace driftlab::investigate {
namespace {

void examine_together(const std::vector<GroupOutcome>& outcomes, const std::vector<ChannelGroup>& groups,
                      std::vector<Evidence>& found, std::vector<Evidence>& examined) {
  for (const Cause& cause : cause_registry()) {
    const CommonNoise* const common = cause.as<CommonNoise>();
    if (common == nullptr) {
      continue;
    }
    std::vector<FullRate> axes;
    std::vector<std::size_t> index;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (outcomes[g].usable && groups[g].role.quantity == groups.front().role.quantity) {
        axes.push_back(outcomes[g].after);
        index.push_back(g);
      }
    }
    if (axes.size() < 2) {
      continue;
    }
    for (Evidence& evidence : common->examine_together(axes)) {
      evidence.cause = &cause;
      evidence.group = index.front();
      evidence.also_groups.assign(index.begin() + 1, index.end());
      examined.push_back(evidence);
      if (evidence.score > kThreshold) {
        found.push_back(std::move(evidence));
      }
    }
  }
}

/// What a given model says already is no finding, only a note.
void drop_confirmed(const Baseline& baseline, const std::vector<ChannelGroup>& groups, std::vector<Evidence>& found,
                    std::vector<std::string>& notes) {
  std::erase_if(found, [&](const Evidence& evidence) {
    const ChannelGroup& group = groups[evidence.group];
    if (!confirmed(baseline, group, evidence)) {
      return false;
    }
    notes.push_back("The baseline holds " + std::string(evidence.cause->name) + " of " + group.column +
                    " already, and the recordings agree with it.");
    return true;
  });
}

/// A column that no recording gives a reference for.
void without_reference(const Channel& channel, const std::vector<ChannelGroup>& groups, Report& report) {
  const bool elsewhere = std::any_of(groups.begin(), groups.end(),
                                     [&](const ChannelGroup& group) { return group.column == channel.column; });
  const bool said = std::any_of(report.not_examined.begin(), report.not_examined.end(),
                                [&](const NotExamined& item) { return item.channel == channel.column; });
  for (const Cause& cause : cause_registry()) {
    if (!elsewhere && !said) {
      report.not_examined.push_back(
          {std::string(cause.name), channel.column, "a reference column, or a condition that states the motion"});
    }
  }
}

std::vector<ChannelName> channels_of(const Evidence& evidence, const std::vector<ChannelGroup>& groups) {
  std::vector<ChannelName> names;
  std::vector<std::size_t> all{evidence.group};
  all.insert(all.end(), evidence.also_groups.begin(), evidence.also_groups.end());
  for (const std::size_t g : all) {
    for (const std::size_t r : evidence.members) {
      if (r < groups[g].members.size()) {
        names.push_back(groups[g].members[r].channel_name());
      }
    }
  }
  return names;
}

void list_findings(std::vector<Evidence> found, const std::vector<ChannelGroup>& groups, Report& report) {
  for (Evidence& evidence : found) {
    Finding finding;
    finding.channels = channels_of(evidence, groups);
    finding.everywhere = evidence.members.size() == groups[evidence.group].members.size();
    finding.because = checks_behind(evidence, groups, report);
    finding.gain.of_the_file = evidence.cause->as<FileFact>() != nullptr;
    if (evidence.heldout && evidence.heldout_samples > 0.0) {
      finding.gain.log_score_per_sample = evidence.heldout_gain / evidence.heldout_samples;
      finding.gain.heldout = true;
      finding.gain.share = evidence.share_heldout;
      finding.gain.samples = evidence.heldout_samples;
    }
    finding.evidence = std::move(evidence);
    report.findings.push_back(std::move(finding));
  }
  put_in_order(report.findings);
  settle_ends(report);
}

/// Log likelihood [nat] that the checks which still fail are worth: of each recording the largest, for its checks look
/// at the same samples.
double left_over(const Report& report) {
  std::map<std::string, double> worth;
  for (const Check& check : report.checks) {
    if (check.failed_after) {
      double& most = worth[check.recording + "/" + check.channel];
      most = std::max(most, check.excess_after);
    }
  }
  return std::accumulate(worth.begin(), worth.end(), 0.0, [](double sum, const auto& one) { return sum + one.second; });
}

/// The gain of the extension is that of its findings on the noise and the mean; what tells of the file alone is no part
/// of it. The misfit left is that of the innovations under the extended model.
void settle_gains(const std::vector<ChannelGroup>& groups, const std::vector<GroupOutcome>& outcomes, Report& report) {
  double samples = 0.0;
  for (const GroupOutcome& outcome : outcomes) {
    for (const Series& e : outcome.after.innovation) {
      samples += static_cast<double>(e.size());
    }
  }
  const auto gained = [](const Finding& finding) {
    return finding.gain.heldout && !finding.gain.of_the_file ? std::max(0.0, finding.evidence.heldout_gain) : 0.0;
  };
  double sum = 0.0;
  for (const Finding& finding : report.findings) {
    sum += gained(finding);
  }
  const double all = sum + left_over(report);
  report.explained = all > 0.0 ? sum / all : 0.0;
  report.misfit_before = report.misfit_after + sum / std::max(1.0, samples);
  for (Finding& finding : report.findings) {
    finding.gain.explained = all > 0.0 ? gained(finding) / all : 0.0;
    finding.gain.misfit_after = report.misfit_after;
    finding.gain.misfit_before =
        report.misfit_after + (finding.gain.of_the_file ? 0.0 : finding.gain.log_score_per_sample);
    finding.explanation = explain(finding, groups[finding.evidence.group]);
    finding.next_measurement = next_measurement(finding);
  }
}

/// The recording whose course is drawn: the first that a finding of the channel names, else the first.
std::size_t first_shown(const Report& report, std::size_t group) {
  for (const Finding& finding : report.findings) {
    if (finding.evidence.group == group && !finding.evidence.members.empty()) {
      return finding.evidence.members.front();
    }
  }
  return 0;
}

/// Whether noise of a channel still changes, in time, frequency or with a quantity.
bool noise_still_changes(const std::string& channel, const std::vector<Remainder>& remains,
                         const std::vector<UnnamedFinding>& unnamed) {
  return std::any_of(remains.begin(), remains.end(),
                     [&](const Remainder& remainder) {
                       return remainder.channel == channel && remainder.in_time_or_frequency &&
                              remainder.p_study < kShown;
                     }) ||
         std::any_of(unnamed.begin(), unnamed.end(), [&](const UnnamedFinding& found) {
           return found.effect.column == channel && found.effect.kind == UnnamedKind::Variance;
         });
}

/// What the report takes from the samples of a channel.
struct Taken {
  ChannelChecks checks;
  std::vector<double> means;
  MeasuredFigures figures;
  std::vector<Remainder> remains;
  std::vector<UnnamedFinding> unnamed;
  std::vector<UnnamedFinding> instead;  ///< of levels of noise and mean effects that were found
};

/// The same of all channels, each list in their order.
struct TakenOfAll {
  std::vector<ChannelChecks> checks;
  std::vector<std::vector<double>> means;
  std::vector<MeasuredFigures> figures;
  std::vector<Remainder> remains;
  std::vector<UnnamedFinding> unnamed;
  std::vector<UnnamedFinding> instead;

  void add(Taken&& one) {
    checks.push_back(std::move(one.checks));
    means.push_back(std::move(one.means));
    figures.push_back(std::move(one.figures));
    const auto append = [](auto& all, auto& some) {
      all.insert(all.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
    };
    append(remains, one.remains);
    append(unnamed, one.unnamed);
    append(instead, one.instead);
  }
};

/// The base beside the means that were found without a name. What is left of a process that had followed one of them,
/// and lies below a fiftieth of the white density at every frequency of the longest recording, is left out. A given
/// base stays as it is.
void take_refitted_noise(const std::vector<UnnamedFinding>& unnamed, GroupOutcome& outcome) {
  std::vector<SlowComponent>& base = outcome.model.beside.noise.components;
  double longest = 0.0;
  for (const Series& residual : outcome.after.residual) {
    longest = std::max(longest, static_cast<double>(residual.size()));
  }
  const double dt_s = outcome.after.dt_s;
  std::vector<SlowComponent> refitted;
  for (const UnnamedFinding& found : unnamed) {
    if (found.noise) {
      refitted = *found.noise;  // the last one's is beside all of them
    }
  }
  if (refitted.empty() || outcome.after.given) {
    return;
  }
  for (std::size_t k = 0; k < std::min(base.size(), refitted.size()); ++k) {
    base[k].process = refitted[k].process;  // effects that are slow noise stand behind the base
  }
  std::erase_if(base, [&](const SlowComponent& component) {
    SlowModel alone;
    alone.components = {component};
    return slow_density(alone, 0, 1.0 / (longest * dt_s), dt_s, longest) < 0.02 * outcome.model.beside.noise.white;
  });
}

/// Takes what is needed of a channel whose search has ended, and lets its samples go but for the innovations, which are
/// compared with those of other channels.
Taken take_from(const ChannelGroup& group, GroupOutcome& outcome, const RunControl& control) {
  Taken taken;
  std::array<std::vector<UnnamedFinding>, 2> instead;
  const auto profile = [&](UnnamedKind kind, std::vector<UnnamedFinding>& found) {
    if (outcome.usable && std::any_of(outcome.found.begin(), outcome.found.end(),
                                      [&](const Evidence& evidence) { return may_be_a_profile(evidence, kind); })) {
      found = find_instead(group, outcome.before, kind);
    }
  };
  const std::array<std::function<void()>, 4> of_both{
      [&] { taken.checks = check_channel(group, outcome); },
      [&] { taken.figures = outcome.usable ? measure_figures(group, outcome) : MeasuredFigures{}; },
      [&] { profile(UnnamedKind::Variance, instead[0]); }, [&] { profile(UnnamedKind::Mean, instead[1]); }};
  parallel_for(control.threads, of_both.size(), [&](std::size_t i) { of_both[i](); }, control.stop);
  taken.means = means_of(outcome.before);
  for (std::vector<UnnamedFinding>& found : instead) {
    std::ranges::move(found, std::back_inserter(taken.instead));
  }
  outcome.before = {};
  if (outcome.usable && !control.stop.stop_requested()) {
    const std::array<std::function<void()>, 2> of_the_extended{
        [&] { taken.remains = remains_of_channel(group, outcome.after); },
        [&] { taken.unnamed = find_unnamed(group, outcome.after, outcome.model.beside.noise.components.size()); }};
    parallel_for(control.threads, of_the_extended.size(), [&](std::size_t i) { of_the_extended[i](); }, control.stop);
    taken.figures.figures.spectrogram = spectrogram_of_innovations(group, outcome.after, taken.remains);
    take_refitted_noise(taken.unnamed, outcome);
  }
  outcome.after.residual.clear();
  return taken;
}

struct Searched {
  GroupOutcome outcome;
  Taken taken;
};

std::vector<Searched> search_all(const Study& study, const std::vector<ChannelGroup>& groups,
                                 const RunControl& control) {
  std::size_t rows = 0;
  for (const StudyRecording& recording : study.recordings) {
    rows += recording.count();
  }
  std::vector<Searched> searched(groups.size());
  std::mutex told;  // progress is told by one thread at a time
  std::vector<double> done(groups.size(), 0.0);
  const std::size_t at_once = rows <= kMostRowsSideBySide ? kSideBySide : 1;
  for (std::size_t first = 0; first < groups.size() && !control.stop.stop_requested(); first += at_once) {
    const std::size_t count = std::min(at_once, groups.size() - first);
    parallel_for(
        control.threads, count,
        [&](std::size_t i) {
          const std::size_t g = first + i;
          Searched& one = searched[g];
          one.outcome =
              search_group(study, groups[g], g, control.reporting([&, g](std::string_view stage, double fraction) {
                const std::scoped_lock lock(told);
                done[g] = std::max(done[g], fraction);  // a search that begins anew tells of its beginning again
                control.report(
                    stage, 0.95 * std::accumulate(done.begin(), done.end(), 0.0) / static_cast<double>(groups.size()));
              }));
          one.taken = take_from(groups[g], one.outcome, control);
          const std::scoped_lock lock(told);
          done[g] = 1.0;
        },
        control.stop);
  }
  return searched;
}

tl::unexpected<Error> cancelled() { return fail(ErrorCode::Cancelled, "The investigation was stopped."); }

}  // namespace

Result<Report> investigate(const Study& given, const InvestigateOptions& options, const RunControl& control) {
  if (given.recordings.empty()) {
    return fail(ErrorCode::TooFewSamples, "The study holds no recording.");
  }
  control.report("recordings", 0.0);
  const RightedRecordings righted = right_recordings(given, control.stop);
  const Study& study = righted.study ? *righted.study : given;
  if (const Status known = check_processes(study.baseline); !known) {
    return fail(known.error());
  }
  Report report;
  report.study = study.id;
  report.automatic = study.baseline.automatic;
  report.baseline = study.baseline;
  report.notes = study.notes;
  for (const UnnamedEffect& effect : study.baseline.unnamed) {
    if (effect.kind != UnnamedKind::Mean) {
      report.notes.push_back("The baseline holds a profile of the " + std::string(name_of(effect.kind)) + " of " +
                             effect.column +
                             " without a name; it cannot be taken off a recording and may be found again.");
    }
  }
  const std::vector<ChannelGroup> groups = group_channels(study);
  std::vector<GroupOutcome> outcomes;
  TakenOfAll taken;
  std::vector<Evidence> found;
  std::vector<Evidence> examined;
  for (const StudyRecording& recording : study.recordings) {
    for (const Channel& channel : recording.channels) {
      if (channel.error.empty() && !channel.input_only) {
        report.notes.push_back("The channel " + recording.id + "/" + channel.column +
                               " has no reference, so its error is not known and it is not examined.");
        without_reference(channel, groups, report);
      }
    }
  }
  std::vector<Searched> searched = search_all(study, groups, control);
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    taken.add(std::move(searched[g].taken));
    outcomes.push_back(std::move(searched[g].outcome));
    const GroupOutcome& outcome = outcomes.back();
    if (!outcome.usable) {
      report.notes.push_back("The channel " + groups[g].column + " cannot be examined: " + outcome.why_not + ".");
      for (const Cause& cause : cause_registry()) {
        report.not_examined.push_back({std::string(cause.name), groups[g].column, outcome.needs});
      }
      continue;
    }
    report.models.push_back(outcome.model);
    found.insert(found.end(), outcome.found.begin(), outcome.found.end());
    for (const Evidence& evidence : outcome.examined) {
      examined.push_back(evidence);
      examined.back().group = g;
    }
    for (const Cause& cause : cause_registry()) {
      const std::string needs = cause.lacks != nullptr ? cause.lacks(study, groups[g]) : "";
      if (!needs.empty()) {
        report.not_examined.push_back({std::string(cause.name), groups[g].column, needs});
      }
    }
  }
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  examine_together(outcomes, groups, found, examined);
  join_axes(found);
  const std::vector<Evidence> seen = found;
  drop_confirmed(study.baseline, groups, found, report.notes);
  control.report("checks", 0.95);
  make_checks(groups, outcomes, taken.checks, examined, report);
  const std::vector<Remainder> remains = what_remains(groups, outcomes, seen, std::move(taken.remains));
  doubt_what_is_not_earned(groups, taken.means, remains, {taken.unnamed, taken.instead, suspects_of(study, found)},
                           report, found);
  if (control.stop.stop_requested()) {
    return cancelled();
  }
  list_findings(std::move(found), groups, report);
  settle_gains(groups, outcomes, report);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (outcomes[g].usable) {
      report.figures.push_back(figures_of(taken.figures[g], first_shown(report, g), report.checks));
      if (!noise_still_changes(groups[g].column, remains, taken.unnamed)) {
        report.figures.back().spectrogram.reset();
      }
    }
  }
  if (options.predict_outages) {
    auto outages = outage_gain(report, groups, control.reporting([&](std::string_view, double fraction) {
      control.report("outages", 0.97 + 0.03 * fraction);
    }));
    if (!outages) {
      return fail(outages.error());
    }
    report.outages = *std::move(outages);
  }
  report_remains(remains, report);
  report_unnamed(std::move(taken.unnamed), groups.size(), report);
  report_recordings(righted, report);
  report.summary = verdict_of(report);
  return report;
}

}  // namespace driftlab::investigate
