#include "core/investigate/report/shared_misfit.hpp"

#include "core/investigate/causes/cause.hpp"

#include <algorithm>

namespace driftlab::investigate {
namespace {

/// In a recording: what comes so often leaves every part of it that lasts with the same power. Chosen, not measured.
constexpr double kFewestPeriods = 20.0;

}  // namespace

SharedMisfit::SharedMisfit(const Evidence& evidence, const ChannelGroup& group, const std::vector<Remainder>& remains,
                           const std::vector<UnnamedFinding>& unnamed)
    : evidence_(evidence), group_(group) {
  const NoiseLevel* const level = evidence.cause->as<NoiseLevel>();
  const bool confined = !evidence.members.empty() && evidence.members.size() < group.members.size();
  in_some_ = confined && evidence.cause->as<DifferencedNoise>() != nullptr;
  if (!in_some_ && !(confined && level != nullptr && level->within_recording)) {
    return;
  }
  bool here = false;
  bool elsewhere = false;
  const auto sees = [&](const std::string& recording) { (is_of_finding(recording) ? here : elsewhere) = true; };
  for (const Remainder& remainder : remains) {
    if (remainder.channel == group.column && remainder.p_study < kClear &&
        is_rhythm(remainder.recording, remainder.period_s)) {
      sees(remainder.recording);
    }
  }
  for (const UnnamedFinding& profile : unnamed) {
    if (profile.effect.column != group.column) {
      continue;
    }
    of_spectrum_ = of_spectrum_ || (profile.effect.kind == UnnamedKind::Spectrum && profile.effect.recordings.empty());
    if (is_rhythm(profile)) {
      sees(profile.effect.recordings.front());
    }
  }
  rhythm_ = here && elsewhere;
}

bool SharedMisfit::is_of_finding(const std::string& recording) const {
  return std::any_of(evidence_.members.begin(), evidence_.members.end(),
                     [&](std::size_t r) { return group_.members[r].recording->id == recording; });
}

bool SharedMisfit::is_rhythm(const std::string& recording, double period_s) const {
  return period_s > 0.0 &&
         std::any_of(group_.members.begin(), group_.members.end(), [&](const ChannelGroup::Member& member) {
           return member.recording->id == recording &&
                  static_cast<double>(member.recording->count()) * member.recording->dt_s >= kFewestPeriods * period_s;
         });
}

bool SharedMisfit::is_rhythm(const UnnamedFinding& profile) const {
  return profile.effect.kind == UnnamedKind::Variance && profile.effect.against == Against::Phase &&
         profile.effect.recordings.size() == 1 && is_rhythm(profile.effect.recordings.front(), profile.effect.period_s);
}

bool SharedMisfit::holds(const Check& check) const {
  return of_spectrum_ && check.of_spectrum && check.channel == group_.column;
}

bool SharedMisfit::holds(const Remainder& remainder) const {
  if (remainder.channel != group_.column) {
    return false;
  }
  return (rhythm_ && is_rhythm(remainder.recording, remainder.period_s)) ||
         (in_some_ && of_spectrum_ && !remainder.recording.empty() && !is_of_finding(remainder.recording));
}

bool SharedMisfit::holds(const UnnamedFinding& profile) const {
  if (profile.effect.column != group_.column) {
    return false;
  }
  return (in_some_ && profile.effect.kind == UnnamedKind::Spectrum && profile.effect.recordings.empty()) ||
         (rhythm_ && is_rhythm(profile));
}

}  // namespace driftlab::investigate
