#pragma once
/// The files of a drive document on this machine.
#include "clients/cli/workspace.hpp"
#include "core/analysis/draft_drive.hpp"
#include "core/analysis/drive.hpp"
#include "schema/json/json.hpp"

#include <filesystem>

namespace driftlab::cli {

class DriveFiles final : public DriveSource {
 public:
  DriveFiles(std::filesystem::path folder, Workspace workspace)
      : folder_(std::move(folder)), workspace_(std::move(workspace)) {}
  [[nodiscard]] Result<drive::Table> open(const drive::Source& source, const RunControl& control) override;

 private:
  std::filesystem::path folder_;
  Workspace workspace_;
};

/// The columns of a log by their names, for a draft that lies in the same folder.
[[nodiscard]] Result<DraftFile> read_draft_file(const std::string& path, const RunControl& control);

/// The JSON text at `path`; `model_path`, where not empty, takes the place of its model.
[[nodiscard]] Result<Json> read_drive_json(const std::string& path, const std::string& model_path);

/// The document at `path`; `model_path`, where not empty, takes the place of its model.
[[nodiscard]] Result<drive::Document> read_drive_document(const std::string& path, const std::string& model_path);

/// The decoded files of the document at `path`. Errors: those of open_tables.
[[nodiscard]] Result<drive::Tables> open_drive_tables(const std::string& path, const drive::Document& document,
                                                      const RunControl& control);

/// The drive of the document at `path`, whose files lie beside it.
[[nodiscard]] Result<drive::Drive> open_drive_files(const std::string& path, const drive::Document& document,
                                                    const drive::LoadOptions& options, const RunControl& control);

/// The models of a comparison: names that driftlab knows, else JSON files, called by their name without `.json`.
/// Errors: those of the file.
[[nodiscard]] Result<std::vector<DriveModel>> read_drive_models(const std::vector<std::string>& given);

}  // namespace driftlab::cli
