#include "clients/cli/drive_files.hpp"

#include "clients/cli/json_file.hpp"
#include "core/read/format.hpp"
#include "core/read/rtklib_tag.hpp"
#include "schema/json/drive_document.hpp"

#include <algorithm>
#include <filesystem>

namespace driftlab::cli {

Result<drive::Table> DriveFiles::open(const drive::Source& source, const RunControl& control) {
  auto decoded = decode_file(folder_ / source.file, workspace_.file(), {}, control);
  if (!decoded) {
    return fail(decoded.error());
  }
  auto columns = ColumnFile::open(workspace_.file());
  if (!columns) {
    return fail(columns.error());
  }
  drive::Table table = table_of(*columns);
  table.notes = std::move(decoded->notes);
  if (!source.time.tag.empty()) {
    const auto tag = read_rtklib_tag(folder_ / source.time.tag);
    if (!tag) {
      return fail(tag.error());
    }
    table.tag = drive::TimeTag{tag->first_s, tag->last_s};
  }
  return table;
}

Result<DraftFile> read_draft_file(const std::string& path, const RunControl& control) {
  const auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  const auto decoded = decode_file(path, workspace->file(), {}, control);
  if (!decoded) {
    return fail(in_file(path, decoded.error()));
  }
  return DraftFile{path, decoded->format, decoded->names, {}};
}

Result<Json> read_drive_json(const std::string& path, const std::string& model_path) {
  auto document = read_json_file(path, "a drive document, as schema/docs/drives.md describes it");
  if (!document || model_path.empty()) {
    return document;
  }
  auto model = read_json_file(model_path, "a model");
  if (!model) {
    return fail(model.error());
  }
  if (document->is_object()) {
    (*document)["model"] = std::move(*model);
  }
  return document;
}

Result<drive::Document> read_drive_document(const std::string& path, const std::string& model_path) {
  const auto document = read_drive_json(path, model_path);
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  drive::Document made = drive_from_json(*document, faults);
  return faults.none() ? Result<drive::Document>(std::move(made)) : fail(in_file(path, faults.error()));
}

Result<std::vector<DriveModel>> read_drive_models(const std::vector<std::string>& given) {
  const std::vector<std::string>& known = known_drive_models();
  std::vector<DriveModel> models;
  for (const std::string& name : given) {
    if (std::find(known.begin(), known.end(), name) != known.end()) {
      models.push_back({name, std::nullopt});
      continue;
    }
    std::string names;
    for (const std::string& one : known) {
      names += (names.empty() ? "" : ", ") + one;
    }
    const auto document = read_json_file(name, "a model, or the name of one: " + names);
    if (!document) {
      return fail(document.error());
    }
    Faults faults;
    ImuModel imu = drive_model_from_json(*document, "", faults);
    if (!faults.none()) {
      return fail(in_file(name, faults.error()));
    }
    models.push_back({std::filesystem::path(name).stem().string(), std::move(imu)});
  }
  return models;
}

Result<drive::Tables> open_drive_tables(const std::string& path, const drive::Document& document,
                                        const RunControl& control) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  DriveFiles files(std::filesystem::path(path).parent_path(), std::move(*workspace));
  return open_tables(document, files, control);
}

Result<drive::Drive> open_drive_files(const std::string& path, const drive::Document& document,
                                      const drive::LoadOptions& options, const RunControl& control) {
  const auto tables = open_drive_tables(path, document, control);
  return tables ? drive::load_drive(document, *tables, options) : Result<drive::Drive>(fail(tables.error()));
}

}  // namespace driftlab::cli
