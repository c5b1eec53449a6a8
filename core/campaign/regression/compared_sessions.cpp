#include "core/campaign/regression/compared_sessions.hpp"

#include "core/campaign/regression/event_checks.hpp"

#include <limits>

namespace driftlab::regression {

std::vector<const PowerUp*> ComparedSessions::all() const {
  std::vector<const PowerUp*> list;
  for (const PowerUps* arm : {&baseline, &candidate}) {
    for (const PowerUp& session : arm->sessions) {
      list.push_back(&session);
    }
  }
  for (const PowerUps& release : history) {
    for (const PowerUp& session : release.sessions) {
      list.push_back(&session);
    }
  }
  return list;
}

std::map<std::string, NamedUnit> units_of(const std::vector<PowerUp>& sessions) {
  std::map<std::string, NamedUnit> units;
  for (const PowerUp& session : sessions) {
    for (const ComparedRecording* recording : session.recordings) {
      for (const ComparedChannel& channel : recording->channels) {
        if (const std::string name = unit_name(*recording, channel.result); !name.empty()) {
          units[name] = {name, recording->condition,
                         parse_quantity(channel.result.quantity).value_or(Quantity::Unspecified), channel.result.axis};
        }
      }
    }
  }
  return units;
}

SessionChannels channels_of(const PowerUp& session, const std::string& unit) {
  SessionChannels channels;
  for (const ComparedRecording* recording : session.recordings) {
    for (const ComparedChannel& channel : recording->channels) {
      if (unit_name(*recording, channel.result) == unit) {
        channels.push_back(&channel.result);
      }
    }
  }
  return channels;
}

std::string structure_of(const std::vector<PowerUp>& sessions, const std::string& unit) {
  std::map<std::string, double> sums;
  std::map<std::string, std::size_t> counts;
  std::size_t channels = 0;
  for (const PowerUp& session : sessions) {
    for (const ReportedChannel* channel : channels_of(session, unit)) {
      ++channels;
      for (const ReportedFit& fit : channel->fits) {
        sums[fit.model] += fit.wic;
        ++counts[fit.model];
      }
    }
  }
  std::string best;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [model, sum] : sums) {
    if (counts[model] == channels && sum < least) {
      best = model;
      least = sum;
    }
  }
  return best;
}

}  // namespace driftlab::regression
