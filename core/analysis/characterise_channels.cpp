#include "core/analysis/characterise_channels.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace driftlab {

std::size_t expected_channels(const RecordingSpec& spec, const ColumnNames& names) {
  const auto roles = assign_roles(spec, names);
  if (!roles) {
    return 1;
  }
  const auto sensors = std::count_if(roles->begin(), roles->end(), [](const std::optional<ColumnRole>& role) {
    return role && is_sensor(role->quantity);
  });
  return std::max<std::size_t>(1, static_cast<std::size_t>(sensors));
}

CampaignChannels::CampaignChannels(RecordingSource& recordings, const CharacteriseOptions& options,
                                   const std::vector<std::size_t>& expected)
    : recordings_(recordings), options_(options) {
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t c = 0; c < expected[i]; ++c) {
      places_.push_back({i, c, c + 1 == expected[i]});
    }
  }
}

Result<CharacterisedRecording> CampaignChannels::characterise(std::size_t number, const RunControl& control) {
  const Place& place = places_[number];
  if (!opened_ || opened_index_ != place.recording) {
    opened_.reset();
    auto opened = PreparedRecording::open(recordings_, place.recording, control);
    if (!opened) {
      return fail(opened.error());
    }
    opened_ = std::move(*opened);
    opened_index_ = place.recording;
  }
  CharacterisedRecording part;
  if (place.channel == 0) {
    part = opened_->frame();
  }
  const std::size_t end = place.last ? opened_->channels() : std::min(place.channel + 1, opened_->channels());
  for (std::size_t c = place.channel; c < end; ++c) {
    auto channel = opened_->characterise(c, options_, control);
    if (!channel) {
      return fail(recordings_.located(place.recording, channel.error()));
    }
    part.channels.push_back(std::move(*channel));
  }
  return part;
}

void CampaignChannels::add(CharacterisedRecording part) {
  if (places_[added_++].channel == 0) {
    found_.push_back(std::move(part));
  } else {
    std::move(part.channels.begin(), part.channels.end(), std::back_inserter(found_.back().channels));
  }
}

}  // namespace driftlab
