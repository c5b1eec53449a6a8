#include "core/investigate/report/earned.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/consistency/reference_clock.hpp"
#include "core/investigate/report/shared_misfit.hpp"
#include "core/process/constant_offset.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

namespace driftlab::investigate {
namespace {

/// Times the longest recording: a time beyond it is at the end of its search and not measured by the data. Chosen, not
/// measured.
constexpr double kMostRecords = 20.0;

bool is_fact(const Cause& cause) { return cause.as<FileFact>() != nullptr || cause.as<RecordingFault>() != nullptr; }

bool at_bound(const Evidence& evidence, const ChannelGroup& group) {
  double longest = 0.0;
  for (const auto& member : group.members) {
    longest = std::max(longest, static_cast<double>(member.recording->count()) * member.recording->dt_s);
  }
  for (const FoundParameter& parameter : evidence.parameters) {
    const double value = parameter.estimate.value;
    const bool time = parameter.unit.symbol == "s";
    if (!std::isfinite(value) || (time && std::fabs(value) > kMostRecords * longest)) {
      return true;
    }
    for (const CauseParameter& declared : evidence.cause->parameters) {
      if (declared.name == parameter.name && value < declared.doubtful_below) {
        return true;
      }
    }
  }
  return false;
}

/// The recording that alone carries a bias said to differ among all; empty where several do.
std::string carried_by(const Evidence& evidence, const ChannelGroup& group, const std::vector<double>& mean) {
  const SlowNoise* const slow = evidence.cause->as<SlowNoise>();
  // Recordings. Of three biases one always lies far from the median. Chosen, not measured.
  constexpr std::size_t kFewest = 4;
  // Of the squares about the median. Chosen, not measured.
  constexpr double kAlone = 0.95;
  if (slow == nullptr || slow->kind != &constant_offset() || mean.size() < kFewest) {
    return "";
  }
  std::vector<double> sorted = mean;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  const double median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
  double all = 0.0;
  std::size_t most = 0;
  for (std::size_t r = 0; r < n; ++r) {
    all += (mean[r] - median) * (mean[r] - median);
    most = std::fabs(mean[r] - median) > std::fabs(mean[most] - median) ? r : most;
  }
  const double own = (mean[most] - median) * (mean[most] - median);
  return own > kAlone * all ? group.members[most].recording->id : std::string();
}

/// How far a recording turned, with its sign [turns].
double turns_of(const StudyRecording& recording) {
  return recording.angle.empty()
             ? 0.0
             : (recording.angle[recording.end - 1] - recording.angle[recording.begin]) / (2.0 * std::numbers::pi);
}

/// How many times a turn a line comes, where in each of its recordings it is a whole number of times; 0: it is no line,
/// or one of its own. A bias that goes with the angle is such a line in a recording that turns evenly.
int times_a_turn(const Evidence& evidence, const ChannelGroup& group) {
  constexpr int kMost = 12;             // Chosen, not measured.
  constexpr double kFewestTurns = 3.0;  // Chosen: lines a turn apart are told apart then.
  constexpr double kRateError = 5e-4;   // Of a stated rate. Chosen, not measured.
  const auto frequency = std::find_if(evidence.parameters.begin(), evidence.parameters.end(),
                                      [](const FoundParameter& parameter) { return parameter.name == "frequency_hz"; });
  if (evidence.cause->as<SpectralLine>() == nullptr || frequency == evidence.parameters.end()) {
    return 0;
  }
  const auto& [value, interval] = frequency->estimate;
  const double within = 1.5 * interval.half_width() + kRateError * value;  // three standard errors
  double times = 0.0;
  for (const std::size_t r : evidence.members) {
    const StudyRecording& recording = *group.members[r].recording;
    if (recording.angle.empty()) {
      return 0;
    }
    const double seconds = static_cast<double>(recording.count() - 1) * recording.dt_s;
    const double turns =
        std::fabs(recording.angle[recording.end - 1] - recording.angle[recording.begin]) / (2.0 * std::numbers::pi);
    times = std::round(value * seconds / std::max(turns, 1e-9));
    if (turns < kFewestTurns || times < 1.0 || times > kMost || std::fabs(value - times * turns / seconds) > within) {
      return 0;
    }
  }
  return static_cast<int>(times);
}

/// A level of noise that is that of the recordings, two and more, that turn one way, and of no other, though others
/// turn the other way: it may go with the sign of the rate.
bool goes_one_way(const Evidence& evidence, const ChannelGroup& group) {
  constexpr std::size_t kFewest = 2;
  constexpr double kTurns = 1.0;  // Chosen, not measured.
  if (evidence.cause->as<NoiseLevel>() == nullptr || evidence.members.size() < kFewest) {
    return false;
  }
  const double way = turns_of(*group.members[evidence.members.front()].recording);
  bool other_way = false;
  for (std::size_t r = 0; r < group.members.size(); ++r) {
    const double turns = turns_of(*group.members[r].recording);
    const bool same = std::fabs(turns) >= kTurns && turns * way > 0.0;
    const bool has_it = std::find(evidence.members.begin(), evidence.members.end(), r) != evidence.members.end();
    if (same != has_it) {
      return false;
    }
    other_way = other_way || (std::fabs(turns) >= kTurns && turns * way < 0.0);
  }
  return other_way;
}

bool turns_unevenly(const StudyRecording& recording) {
  const ConditionKind kind = recording.condition.kind;
  return kind == ConditionKind::ConstantAngularAcceleration || kind == ConditionKind::Profile ||
         kind == ConditionKind::Drive;
}

/// Slow noise, or a level, that recordings with a changing rate alone have, though there are others: an error of any
/// form that goes with the motion would be found in the same places.
bool goes_with_motion(const Evidence& evidence, const ChannelGroup& group) {
  const SlowNoise* const slow = evidence.cause->as<SlowNoise>();
  const NoiseLevel* const level = evidence.cause->as<NoiseLevel>();
  const bool of_recordings =
      (slow != nullptr && slow->kind != &constant_offset()) || (level != nullptr && level->replaces_white);
  return of_recordings && !evidence.members.empty() && evidence.members.size() < group.members.size() &&
         std::all_of(
             evidence.members.begin(), evidence.members.end(),
             [&](std::size_t r) { return turns_unevenly(*group.members[r].recording); });
}

/// The check of slow misfit that still fails in a recording of a slow finding; nullptr: it is mended.
const Check* not_mended(const Evidence& evidence, const ChannelGroup& group, const Report& report) {
  if (!evidence.cause->is_slow()) {
    return nullptr;
  }
  const auto is_of_it = [&](const Check& check) {
    return check.of_slow_misfit && check.channel == group.column && check.failed && check.p_after_adjusted < kClear &&
           std::any_of(
               evidence.members.begin(), evidence.members.end(),
               [&](std::size_t r) { return group.members[r].recording->id == check.recording; });
  };
  const auto found = std::find_if(report.checks.begin(), report.checks.end(), is_of_it);
  return found == report.checks.end() ? nullptr : &*found;
}

/// What a profile is of is what the cause is of.
bool are_of_one_kind(const Cause& cause, UnnamedKind kind) {
  switch (kind) {
    case UnnamedKind::Spectrum:
      return cause.as<SpectralPeak>() != nullptr || cause.as<BandLimit>() != nullptr ||
             cause.as<DifferencedNoise>() != nullptr || cause.as<SlowNoise>() != nullptr;
    case UnnamedKind::Variance:
      return cause.as<NoiseLevel>() != nullptr || cause.as<NoiseTails>() != nullptr;
    case UnnamedKind::Mean:
      break;
  }
  return cause.as<MeanEffect>() != nullptr || cause.as<SlowNoise>() != nullptr || cause.as<SpectralLine>() != nullptr ||
         cause.as<NoiseTails>() != nullptr;
}

/// What is left is a rival of a finding from this share of its gain on. Chosen, not measured.
constexpr double kShare = 1.0 / 3.0;

/// Whether a finding is of how a recording was made, as the time of its reference is, and not of the sensor, and a
/// fault of recordings declares it a rival: the breaks of a clock do.
bool rivals_a_break(const Cause& cause) {
  return cause.concern == Concern::Recording &&
         std::any_of(cause_registry().begin(), cause_registry().end(), [&](const Cause& fault) {
           return fault.as<RecordingFault>() != nullptr &&
                  std::find(fault.rivals.begin(), fault.rivals.end(), cause.name) != fault.rivals.end();
         });
}

/// The recording of a finding whose clock may break instead; nullptr: none.
const StudyRecording* suspect_of(const Evidence& evidence, const ChannelGroup& group,
                                 const std::vector<const StudyRecording*>& suspects) {
  if (rivals_a_break(*evidence.cause)) {
    for (const std::size_t r : evidence.members) {
      if (std::find(suspects.begin(), suspects.end(), group.members[r].recording) != suspects.end()) {
        return group.members[r].recording;
      }
    }
  }
  return nullptr;
}

/// Values that stand out of the noise, and no other distribution of it.
bool are_gross_values(const Cause& cause) {
  const NoiseTails* const tails = cause.as<NoiseTails>();
  return tails != nullptr && tails->added_variance != nullptr;
}

/// Gross values that stand out of noise of so many times the power, as they do of the model's.
bool stand_out_of(const Evidence& evidence, const std::vector<double>& powers) {
  constexpr double kDeviations = 4.0;  // Chosen: one of 16,000 normal values lies beyond.
  const double most = powers.empty() ? 1.0 : *std::max_element(powers.begin(), powers.end());
  return are_gross_values(*evidence.cause) && evidence.shape > kDeviations * std::sqrt(std::max(1.0, most));
}

/// A profile that shows itself predicts as much.
bool rivalled(const Evidence& evidence, const ChannelGroup& group, const SharedMisfit& shared,
              const std::vector<UnnamedFinding>& unnamed, std::size_t channels) {
  return std::any_of(unnamed.begin(), unnamed.end(), [&](const UnnamedFinding& one) {
    const bool of_power = one.effect.kind == UnnamedKind::Variance;
    return !shared.holds(one) && !(of_power && stand_out_of(evidence, one.effect.value)) &&
           one.effect.column == group.column && are_of_one_kind(*evidence.cause, one.effect.kind) &&
           shows_itself(one, channels) && one.heldout_gain > kShare * std::max(evidence.heldout_gain, 0.0);
  });
}

/// What a profile must gain to predict more than `gain`. Chosen, not measured: a profile is measured on more of the
/// data than a cause is that halves judge.
double more_than(double gain) { return 1.15 * std::max(gain, 0.0) + 3.0; }

/// Whether a profile in place of findings predicts more than `gain`.
bool predicts_more(const std::vector<UnnamedFinding>& instead, const ChannelGroup& group, UnnamedKind kind,
                   double gain) {
  return std::any_of(instead.begin(), instead.end(), [&](const UnnamedFinding& one) {
    return one.effect.kind == kind && one.effect.column == group.column && one.heldout_gain > more_than(gain);
  });
}

/// A profile in place of a level, that of recordings or of parts of them, predicts more. A level that itself goes with
/// a quantity is not asked.
bool level_is_surpassed(const Evidence& evidence, const ChannelGroup& group,
                        const std::vector<UnnamedFinding>& instead) {
  const NoiseLevel* const level = evidence.cause->as<NoiseLevel>();
  const bool of_recordings = level != nullptr && (level->replaces_white || level->within_recording);
  return of_recordings && evidence.heldout &&
         predicts_more(instead, group, UnnamedKind::Variance, evidence.heldout_gain);
}

/// A profile in place of all mean effects of the channel predicts more than they do together.
bool mean_is_surpassed(const Evidence& evidence, const ChannelGroup& group, const std::vector<UnnamedFinding>& instead,
                       const std::vector<Evidence>& found) {
  double together = 0.0;
  for (const Evidence& other : found) {
    const bool counts = other.group == evidence.group && other.cause->as<MeanEffect>() != nullptr;
    together += counts ? std::max(other.heldout_gain, 0.0) : 0.0;
  }
  return evidence.cause->as<MeanEffect>() != nullptr && evidence.heldout &&
         predicts_more(instead, group, UnnamedKind::Mean, together);
}

/// The test that a remainder is of: the end of its id.
std::string_view test_of(const Remainder& remainder) {
  return std::string_view(remainder.id).substr(remainder.id.rfind('.') + 1);
}

/// Noise that still changes takes a finding of noise back. A mean effect is taken back by what a mean can show in, if
/// it is a rival by its size, and a difference beside a spectrum that no recording has as the model does by what is one
/// too. Noise of another power makes gross values likelier by no more than it is likelier itself, in all recordings
/// together.
bool speaks_against(const Remainder& remainder, const std::vector<Remainder>& all, const Evidence& evidence,
                    const SharedMisfit& shared) {
  const double gain = std::max(evidence.heldout_gain, 0.0);
  const bool is_rival = remainder.observed > kShare * gain;
  if (evidence.cause->as<MeanEffect>() != nullptr) {
    return !remainder.of_power_alone && is_rival;
  }
  if (are_gross_values(*evidence.cause)) {
    double together = 0.0;
    for (const Remainder& other : all) {
      together += other.channel == remainder.channel && test_of(other) == test_of(remainder) ? other.observed : 0.0;
    }
    return together > gain;
  }
  return !shared.holds(remainder) && (!shared.of_spectrum() || is_rival);
}

/// Whether two findings are of the same thing: the mean, or the level of the noise.
bool are_of_one_kind(const Cause& a, const Cause& b) {
  return (a.as<NoiseLevel>() != nullptr && b.as<NoiseLevel>() != nullptr) || (a.is_slow() && b.is_slow());
}

/// The larger finding of the same kind on the same channel that has been doubted: where its form is not known, a
/// smaller one may be what is left of it. nullptr: there is none.
const Evidence* in_shadow_of(const Evidence& evidence, const std::vector<Evidence>& found) {
  const auto larger = std::find_if(found.begin(), found.end(), [&](const Evidence& other) {
    return !other.doubt.empty() && other.group == evidence.group && are_of_one_kind(*evidence.cause, *other.cause) &&
           evidence.heldout_gain < kShare * other.heldout_gain;
  });
  return larger == found.end() ? nullptr : &*larger;
}

/// Checks that fail, with the baseline and with the extended model, without those that all recordings share.
struct Failing {
  std::size_t before = 0;
  std::size_t after = 0;
};
Failing failing_of(const SharedMisfit& shared, const Report& report) {
  Failing failing{report.failed_before, report.failed_after};
  for (const Check& check : report.checks) {
    failing.before -= check.failed && shared.holds(check) ? 1 : 0;
    failing.after -= check.failed_after && shared.holds(check) ? 1 : 0;
  }
  return failing;
}

/// Why one finding is not earned; empty: it is.
std::string doubt_of(const Evidence& evidence, const ChannelGroup& group, const std::vector<double>& means,
                     const SharedMisfit& shared, const std::vector<Remainder>& remains, const Report& report) {
  // Failed checks that take a finding back. Chosen, not measured: one or two may fail beside a true cause.
  constexpr std::size_t kFewest = 3;
  if (at_bound(evidence, group)) {
    return "a parameter is at the bound of its search";
  }
  if (const std::string alone = carried_by(evidence, group, means); !alone.empty()) {
    return "it is carried by " + alone + " alone";
  }
  if (const int times = times_a_turn(evidence, group); times > 0) {
    return "it comes " + how_often(times) + " a turn, as what goes with the angle does";
  }
  if (goes_one_way(evidence, group)) {
    return "it is that of the recordings that turn one way";
  }
  if (goes_with_motion(evidence, group)) {
    return "only recordings whose rate changes have it, as what goes with the motion does";
  }
  if (const Check* const check = not_mended(evidence, group, report); check != nullptr) {
    return "with it in the model " + check->title + " of " + check->recording + " still fails";
  }
  if (const Failing failing = failing_of(shared, report);
      failing.after >= kFewest && 2 * failing.after >= failing.before) {
    return std::to_string(failing.after) + " checks still fail with it";
  }
  const auto left = std::find_if(remains.begin(), remains.end(), [&](const Remainder& remainder) {
    return remainder.channel == group.column && remainder.in_time_or_frequency && remainder.p_study < kClear &&
           speaks_against(remainder, remains, evidence, shared);
  });
  if (left != remains.end()) {
    return "with it in the model the noise of " + group.column + " still changes";
  }
  const bool lopsided = std::any_of(remains.begin(), remains.end(), [&](const Remainder& remainder) {
    return remainder.id == group.column + ".skewness" && remainder.p_study < kClear &&
           remainder.observed > kShare * std::max(evidence.heldout_gain, 0.0);
  });
  return lopsided && evidence.cause->as<NoiseTails>() != nullptr
             ? "errors of " + group.column + " to one side are larger than to the other"
             : std::string();
}

}  // namespace

std::vector<double> means_of(const FullRate& before) {
  std::vector<double> means;
  for (const Series& residual : before.residual) {
    double sum = 0.0;
    for (const double v : residual) {
      sum += v;
    }
    means.push_back(sum / std::max(1.0, static_cast<double>(residual.size())));
  }
  return means;
}

std::vector<const StudyRecording*> suspects_of(const Study& study, const std::vector<Evidence>& found) {
  std::vector<const StudyRecording*> suspects;
  if (std::none_of(found.begin(), found.end(),
                   [](const Evidence& evidence) { return rivals_a_break(*evidence.cause); })) {
    return suspects;
  }
  for (std::size_t r = 0; r < study.recordings.size(); ++r) {
    if (find_clock_fault(study, r, kClockMayBreak)) {
      suspects.push_back(&study.recordings[r]);
    }
  }
  return suspects;
}

bool may_be_a_profile(const Evidence& evidence, UnnamedKind kind) {
  return kind == UnnamedKind::Variance ? evidence.cause->as<NoiseLevel>() != nullptr
                                       : kind == UnnamedKind::Mean && evidence.cause->as<MeanEffect>() != nullptr;
}

void doubt_what_is_not_earned(const std::vector<ChannelGroup>& groups, const std::vector<std::vector<double>>& means,
                              const std::vector<Remainder>& remains, const Instead& instead, const Report& report,
                              std::vector<Evidence>& found) {
  for (Evidence& evidence : found) {
    if (is_fact(*evidence.cause)) {
      continue;
    }
    const SharedMisfit shared(evidence, groups[evidence.group], remains, instead.beside);
    evidence.doubt = doubt_of(evidence, groups[evidence.group], means[evidence.group], shared, remains, report);
    if (evidence.doubt.empty() && rivalled(evidence, groups[evidence.group], shared, instead.beside, groups.size())) {
      evidence.doubt = "a profile that has no name predicts the recordings beside it";
    }
    if (evidence.doubt.empty() && level_is_surpassed(evidence, groups[evidence.group], instead.instead)) {
      evidence.doubt = "noise that goes with a quantity predicts the recordings better";
    }
    if (evidence.doubt.empty() && mean_is_surpassed(evidence, groups[evidence.group], instead.instead, found)) {
      evidence.doubt = "a mean that goes with a quantity in another way predicts the recordings better";
    }
    const StudyRecording* const suspect = suspect_of(evidence, groups[evidence.group], instead.suspects);
    if (evidence.doubt.empty() && suspect != nullptr) {
      evidence.doubt = "the clock of " + suspect->id + " may break instead";
    }
  }
  for (Evidence& evidence : found) {
    const Evidence* const larger =
        is_fact(*evidence.cause) || !evidence.doubt.empty() ? nullptr : in_shadow_of(evidence, found);
    if (larger != nullptr) {
      evidence.doubt = "a larger finding beside it, " + std::string(larger->cause->title) + ", has no certain name";
    }
  }
  for (Evidence& evidence : found) {
    evidence.ambiguous = evidence.ambiguous || !evidence.doubt.empty();
  }
}

bool shows_itself(const UnnamedFinding& found, std::size_t channels) {
  constexpr double kMuch = 0.1;
  const bool of_size = found.effect.kind == UnnamedKind::Mean ||
                       std::any_of(found.effect.value.begin(), found.effect.value.end(),
                                   [](double ratio) { return std::fabs(ratio - 1.0) > kMuch; });
  return of_size && found.chance(channels) < kShown;
}

}  // namespace driftlab::investigate
