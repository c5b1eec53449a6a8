#pragma once
/// What stored results say and imply, as documents (GET /v1/recordings/{id}/characterisation, /v1/fits/{id}/implied).
#include "core/analysis/implied_curves.hpp"
#include "core/campaign/verdict.hpp"
#include "core/process/model.hpp"
#include "schema/json/json.hpp"

#include <optional>

namespace driftlab {

/// {"verdict", "details", "level", "facts"}.
[[nodiscard]] Json to_json(const Verdict& verdict);

/// What a member of `channels` of a characterisation document says. Error: Internal, for a document that driftlab has
/// not written.
[[nodiscard]] Result<Verdict> verdict_from_json(const Json& channel);

/// The summary of one member of `channels` of a characterisation document. Error: Internal, for a document that
/// driftlab has not written.
[[nodiscard]] Result<Json> channel_summary(const Json& channel);

/// Of the summaries of all members of `channels` the one that says most against its channel, the first of these, with
/// that `channel`; null without channels. Those that driftlab has not written are passed over.
[[nodiscard]] Json gravest_summary(const Json& channels);

/// The error model of a fit, without the processes that it has nothing of; nothing where it leaves a parameter open.
[[nodiscard]] std::optional<Model> model_of(const Json& fit, Dimension dimension);

/// The Allan deviation of a channel as the document has it, in the channel's own unit.
[[nodiscard]] MeasuredDeviation deviation_from_json(const Json& allan);

/// The same as numbers; nothing where implied_by is null.
[[nodiscard]] std::optional<ImpliedBeside> implied_from_json(const Json& fit, const Json& channel);

/// What a fit of that channel implies: curves on a grid, the deviation at the times that were measured, and the
/// measured deviation over it. Null where the fit leaves a parameter open. `fit`: one member of `fits`, or a stored
/// fit.
[[nodiscard]] Json implied_by(const Json& fit, const Json& channel);

}  // namespace driftlab
