#pragma once
/// The use case "characterise a campaign": each recording for itself (core/analysis/characterise.hpp), then what those
/// of one device say together: every sensor axis pooled, and the trends of its parameter tables
/// (core/campaign/campaign_summary.hpp).
#include "core/analysis/characterise.hpp"
#include "core/campaign/campaign_summary.hpp"

#include <vector>

namespace driftlab {

struct CharacterisedCampaign {
  std::vector<CharacterisedRecording> recordings;
  CampaignSummary together;  ///< empty for recordings of several devices, which say nothing together
};

/// Progress: kRecordingsShare for the recordings. Errors: those of characterise and of pool_sensor, Cancelled among
/// them.
[[nodiscard]] Result<CharacterisedCampaign> characterise_campaign(RecordingSource& recordings,
                                                                  const CharacteriseOptions& options,
                                                                  const RunControl& control,
                                                                  const ResultName& result_name = {});

/// The second half of it: recordings that have been characterised, together. Errors: those of pool_sensor; Cancelled.
[[nodiscard]] Result<CharacterisedCampaign> summarise_characterised(std::vector<CharacterisedRecording> recordings,
                                                                    const RunControl& control,
                                                                    const ResultName& result_name = {});

/// Of the progress; the rest is for what the recordings say together.
inline constexpr double kRecordingsShare = 0.9;

}  // namespace driftlab
