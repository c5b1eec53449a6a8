#pragma once
/// Stored channel documents and back: what tables and joint fits need of a member of `channels` of a characterisation
/// document (schema/json/characterisation.hpp), as the types of core/campaign/reported_channel.hpp.
#include "core/campaign/reported_channel.hpp"
#include "schema/json/json.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// One member of `fits`.
[[nodiscard]] Json to_json(const ReportedFit& fit);

/// `fits` is a list as `to_json` writes its members. May throw Json::exception: call it inside a reader that turns that
/// into an error.
[[nodiscard]] std::vector<ReportedFit> fits_from_json(const Json& fits);

/// The `processes` of one of them. Throws likewise.
[[nodiscard]] std::vector<ReportedProcess> processes_from_json(const Json& processes);

/// {"value", "unit", "ci95"}; null without a value, and back. Reading throws likewise.
[[nodiscard]] Json to_json(const ReportedValue& value);
[[nodiscard]] ReportedValue reported_value_from_json(const Json& document);

/// N, B, ... with null where there is no value; the reasons for it are added to `reasons`.
[[nodiscard]] Json to_json(const ReportedValues& values, Json& reasons);

/// A fit as it is stored by itself, with the density N of its channel; nothing where it was stored before that was
/// kept.
struct StoredFit {
  ReportedFit fit;
  std::optional<ReportedValue> density;
};

/// Error: Internal, for a document that driftlab has not written.
[[nodiscard]] Result<StoredFit> stored_fit_from_json(const Json& document);

/// One member of `channels`. Members that a combination of recordings does not need are ignored. Error: Internal, for a
/// document that driftlab has not written.
[[nodiscard]] Result<ReportedChannel> reported_channel_from_json(const Json& document);

/// The verdict of a member of `channels` on gross errors; nothing if they were not tested for. Of a document that
/// driftlab has written, of any age.
[[nodiscard]] std::optional<Contamination> contamination_from_json(const Json& channel);

}  // namespace driftlab
