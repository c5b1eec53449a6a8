#pragma once
/// Sessions of a regression run whose channels have means and nothing else.
#include "core/campaign/regression/sessions.hpp"

#include <string>
#include <vector>

namespace driftlab::regression {

struct MeanChannel {
  std::string quantity;
  std::string axis;
  std::string unit;
  double mean = 0.0;
};

inline ComparedRecording recording_of_means(const std::string& id, const std::string& condition,
                                            const std::vector<MeanChannel>& channels) {
  ComparedRecording recording;
  recording.id = id;
  recording.condition = condition;
  for (const MeanChannel& one : channels) {
    ComparedChannel channel;
    channel.result.quantity = one.quantity;
    channel.result.axis = one.axis;
    channel.result.unit = one.unit;
    channel.result.samples = 1000;
    channel.facts.mean = one.mean;
    recording.channels.push_back(channel);
  }
  return recording;
}

/// Power-ups, each of which owns its recordings.
struct Sessions {
  std::vector<std::vector<ComparedRecording>> recordings;

  [[nodiscard]] std::vector<PowerUp> power_ups() const {
    std::vector<PowerUp> all;
    for (std::size_t i = 0; i < recordings.size(); ++i) {
      PowerUp one{"session " + std::to_string(i), {}};
      for (const ComparedRecording& recording : recordings[i]) {
        one.recordings.push_back(&recording);
      }
      all.push_back(std::move(one));
    }
    return all;
  }
};

}  // namespace driftlab::regression
