#include "core/analysis/characterise_campaign.hpp"

#include <algorithm>
#include <utility>

namespace driftlab {
namespace {

bool of_one_device(const std::vector<CharacterisedRecording>& recordings) {
  return std::all_of(recordings.begin(), recordings.end(), [&](const CharacterisedRecording& recording) {
    return recording.device == recordings.front().device;
  });
}

}  // namespace

Result<CharacterisedCampaign> characterise_campaign(RecordingSource& recordings, const CharacteriseOptions& options,
                                                    const RunControl& control, const ResultName& result_name) {
  auto found = characterise(recordings, options, part_of(control, 0.0, kRecordingsShare));
  if (!found) {
    return fail(found.error());
  }
  return summarise_characterised(std::move(*found), part_of(control, kRecordingsShare, 1.0), result_name);
}

Result<CharacterisedCampaign> summarise_characterised(std::vector<CharacterisedRecording> recordings,
                                                      const RunControl& control, const ResultName& result_name) {
  CharacterisedCampaign campaign{std::move(recordings), {}};
  if (campaign.recordings.empty() || !of_one_device(campaign.recordings)) {
    return campaign;
  }
  const std::vector<SensorSources> sensors = sensors_of(campaign.recordings, result_name);
  auto together = summarise_campaign(campaign.recordings.front().device, sensors, control);
  if (!together) {
    return fail(together.error());
  }
  campaign.together = std::move(*together);
  return campaign;
}

}  // namespace driftlab
