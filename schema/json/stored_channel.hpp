#pragma once
/// One member of `channels` of a characterisation document as the use case "read a stored result" takes it
/// (core/analysis/stored_channel.hpp), and its answers as documents.
#include "core/analysis/stored_channel.hpp"
#include "schema/json/json.hpp"

#include <vector>

namespace driftlab {

/// Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<StoredChannel> stored_channel_from_json(const Json& channel);

/// All members of `channels` but those that driftlab has not written.
[[nodiscard]] std::vector<StoredChannel> stored_channels_from_json(const Json& channels);

/// {"verdict", "details", "level", "facts"}.
[[nodiscard]] Json to_json(const Verdict& verdict);

/// Curves on a grid, the deviation at the times that were measured, and the measured deviation over it. `unit`: symbol
/// of the channel's own unit.
[[nodiscard]] Json to_json(const ImpliedBeside& implied, const std::string& unit);

}  // namespace driftlab
