#pragma once
/// The characterisation document (spec/results.md): what `driftlab characterise --json`, the daemon's job result and
/// its stored channel documents hold. Curves are in the channel's own unit; parameters in the units engineers use.
#include "core/fit/characterisation.hpp"
#include "core/signal/recording.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

/// Who a channel is: the file's column and its meaning.
struct ChannelIdentity {
  std::string column;
  ColumnRole role;
};

/// One member of `channels`.
[[nodiscard]] Json to_json(const ChannelIdentity& identity, const ChannelCharacterisation& channel);

/// One member of `recordings`: `channels` are documents made by `to_json` above.
[[nodiscard]] Json recording_document(const std::string& id, const RecordingSpec& spec, const Window& window,
                                      std::vector<Json> channels);

/// Whether a document is one of these, with a recording at least; a study has `recordings` too, without channels.
[[nodiscard]] bool is_characterisation(const Json& document);

/// The whole document.
[[nodiscard]] Json characterisation_document(std::vector<Json> recordings);

}  // namespace driftlab
