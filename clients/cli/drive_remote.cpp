#include "clients/cli/drive_remote.hpp"

#include "clients/cli/drive_files.hpp"
#include "clients/cli/remote_upload.hpp"
#include "core/read/rtklib_tag.hpp"
#include "schema/json/drive_document.hpp"
#include "schema/json/drive_request.hpp"

#include <array>
#include <filesystem>
#include <map>

namespace driftlab::cli {
namespace {

/// The members of a document that name a file, what lies in another before it: a member that is added moves what is
/// within.
std::vector<Json*> sources_in(Json& document) {
  std::vector<Json*> sources;
  for (const char* const pointer : {"/imu/accelerometer", "/imu", "/gnss", "/reference", "/odometer"}) {
    const Json::json_pointer at(pointer);
    if (document.contains(at) && document[at].is_object()) {
      sources.push_back(&document[at]);
    }
  }
  return sources;
}

/// What a recording's metadata can hold of a source's columns: the rest is said by the drive alone.
void add_columns(const Json& source, RecordingSpec& spec) {
  for (const auto& [name, column] : source["columns"].items()) {
    const auto quantity = parse_quantity(column["quantity"].get<std::string>());
    const std::string axis = column.value("axis", "");
    const auto unit = parse_unit(column.value("unit", "1"));
    const bool holds = quantity && unit && is_axis_of(axis, *quantity) && measures(*unit, *quantity);
    if (holds && name.find_first_of(",=") == std::string::npos) {
      spec.columns[name] = ColumnRole{*quantity, axis, *unit};
    }
  }
  const Json& time = source["time"];
  if (const auto unit = parse_unit(time.value("unit", "s")); unit && time.contains("column")) {
    spec.columns[time["column"].get<std::string>()] = ColumnRole{Quantity::Time, "", *unit};
  } else if (time.contains("rate_hz")) {
    spec.rate_hz = time["rate_hz"].get<double>();
  }
}

/// Dates in the place of a time tag, which a daemon does not have.
Status put_dates(const std::filesystem::path& folder, Json& source) {
  Json& time = source["time"];
  if (!time.contains("tag")) {
    return {};
  }
  const auto tag = read_rtklib_tag(folder / time["tag"].get<std::string>());
  if (!tag) {
    return fail(tag.error());
  }
  time.erase("tag");
  time["dates"] = Json{{"first_s", tag->first_s}, {"last_s", tag->last_s}};
  return {};
}

/// Uploads each file once and puts recordings in the place of files.
tl::expected<void, Failure> upload_files(HttpClient& client, const std::string& device,
                                         const std::filesystem::path& folder, Json& document, ProgressBar& bar) {
  std::map<std::string, RecordingSpec> specs;
  for (Json* const source : sources_in(document)) {
    if (auto status = put_dates(folder, *source); !status) {
      return tl::unexpected(Failure{status.error(), Exit::BadInput});
    }
    const auto file = (*source)["file"].get<std::string>();
    RecordingSpec& spec = specs[file];
    spec.id = file;
    spec.condition.kind = ConditionKind::Drive;
    add_columns(*source, spec);
  }
  std::map<std::string, Json> ids;
  for (const auto& [file, spec] : specs) {
    const auto done = static_cast<double>(ids.size());
    const std::string& name = file;
    auto id = upload_recording(client, device, spec, {}, folder / file, file, [&](double fraction) {
      bar.show("upload " + name, kUploads * (done + fraction) / static_cast<double>(specs.size()));
    });
    if (!id) {
      Failure failure = id.error();
      failure.error.message = file + ": " + failure.error.message;
      return tl::unexpected(std::move(failure));
    }
    ids[file] = std::move(*id);
  }
  for (Json* const source : sources_in(document)) {
    (*source)["recording"] = ids[(*source)["file"].get<std::string>()];
    source->erase("file");
  }
  return {};
}

}  // namespace

tl::expected<Json, Failure> ask_drive_there(const DriveServer& server, const std::string& document_path,
                                            const std::string& model_path, const DriveRequest& request) {
  auto document = read_drive_json(document_path, model_path);
  if (!document) {
    return tl::unexpected(Failure{document.error(), Exit::BadInput});
  }
  Faults faults;
  const drive::Document sound = drive_from_json(*document, faults);
  if (!faults.none()) {
    return tl::unexpected(Failure{faults.error(), Exit::BadInput});
  }
  auto client = HttpClient::to(server.address);
  if (!client) {
    return tl::unexpected(Failure{client.error(), Exit::BadInput});
  }
  ProgressBar bar;
  const std::string device = server.device.empty() ? sound.id : server.device;
  const auto folder = std::filesystem::path(document_path).parent_path();
  if (auto uploaded = upload_files(*client, device, folder, *document, bar); !uploaded) {
    return tl::unexpected(uploaded.error());
  }
  auto id = post_for_id(*client, "/v1/drives", *document, "a drive");
  if (!id) {
    return tl::unexpected(id.error());
  }
  const Json job{{"kind", "drive_evaluation"}, {"inputs", {{"drive", *id}}}, {"parameters", to_json(request)}};
  return run_job(*client, job, bar, kUploads);
}

}  // namespace driftlab::cli
