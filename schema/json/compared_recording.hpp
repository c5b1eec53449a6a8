#pragma once
/// What a regression run reads of stored results (core/campaign/regression/recordings.hpp): a member of `recordings` of
/// a characterisation document, or its parts where a store keeps them apart.
#include "core/campaign/regression/recordings.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// A member of `channels` with what `quality` of its recording says of the column. Error: Internal, for a document that
/// driftlab has not written.
[[nodiscard]] Result<regression::ComparedChannel> compared_channel_from_json(const Json& channel, const Json& quality);

/// Adds the figures of the whole file from `quality`: samples, gaps, jitter and the declared rate. Needs
/// `rate_hz`.
void tell_quality(const Json& quality, regression::ComparedRecording& recording);

/// One member of `recordings` of a characterisation document. Session, time, temperature and causes are not of it.
/// Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<regression::ComparedRecording> compared_recording_from_json(const Json& document);

}  // namespace driftlab
