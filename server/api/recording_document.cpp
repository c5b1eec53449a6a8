// A recording as it goes over the wire: what was said of it, and what its file tells.
#include "schema/json/recording_spec.hpp"
#include "schema/json/stored_member.hpp"
#include "server/api/documents.hpp"

namespace driftlab::server {
namespace {

/// Rows of the file over the rate, which a time column tells with its gaps; null without a rate.
Json duration_of(const Recording& recording, const std::optional<double>& rate_hz) {
  const Json quality = stored(recording.quality_json);
  if (!rate_hz || !quality.is_object()) {
    return nullptr;
  }
  return number(static_cast<double>(quality.value("samples", 0LL)) / *rate_hz);
}

/// Every column of the file with what it is taken to mean; null where that cannot be said.
Json recognised_columns(const Recording& recording, const Blob& blob) {
  Faults faults;
  const RecordingSpec spec = recording_spec_from_json(stored(recording.metadata_json), "", faults);
  ColumnNames names;
  for (const Json& name : stored(blob.columns_json)) {
    names.push_back(name.get<std::string>());
  }
  const auto roles = assign_roles(spec, names);
  if (!faults.none() || !roles) {
    return nullptr;
  }
  Json columns = Json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    columns.push_back(role_json(names[i], (*roles)[i]));
  }
  return columns;
}

}  // namespace

std::optional<double> rate_of(const Recording& recording) {
  const Json quality = stored(recording.quality_json);
  const Json measured = quality.is_object() ? quality.value("measured_rate_hz", Json(nullptr)) : Json(nullptr);
  const Json stated = stored(recording.metadata_json).value("rate_hz", Json(nullptr));
  for (const Json& rate : {measured, stated}) {
    if (rate.is_number() && rate.get<double>() > 0.0) {
      return rate.get<double>();
    }
  }
  return std::nullopt;
}

Json described(const Recording& recording) {
  Json metadata = stored(recording.metadata_json);
  const Json tags = stored(recording.tags_json);
  for (const auto& [name, value] : tags.items()) {
    metadata[name] = value;
  }
  return metadata;
}

Json to_json(const Recording& recording, const Blob* blob) {
  Json document{{"id", recording.id},
                {"device", recording.device_id},
                {"revision", recording.revision},
                {"metadata", described(recording)},
                {"quality", stored(recording.quality_json)}};
  if (blob != nullptr) {
    document["file"] =
        Json{{"sha256", blob->sha256},           {"bytes", blob->bytes}, {"format", blob->format},
             {"compression", blob->compression}, {"rows", blob->rows},   {"columns", stored(blob->columns_json)},
             {"notes", stored(blob->notes_json)}};
    document["columns"] = recognised_columns(recording, *blob);
  } else {
    document["file"] = Json{{"sha256", recording.blob_sha256}};
  }
  document["file"]["name"] = text_or_null(recording.file_name);
  const auto rate_hz = rate_of(recording);
  document["rate_hz"] = rate_hz ? number(*rate_hz) : Json(nullptr);
  document["duration_s"] = duration_of(recording, rate_hz);
  document["latest_job"] = text_or_null(recording.latest_job);
  document["created_at"] = rfc3339(recording.created_at);
  document["updated_at"] = rfc3339(recording.updated_at);
  return document;
}

}  // namespace driftlab::server
