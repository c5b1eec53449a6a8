#pragma once
/// A drive document of this machine, answered by a daemon: its files are uploaded, the drive stored, the job followed.
#include "clients/cli/remote_job.hpp"
#include "core/analysis/drive.hpp"

namespace driftlab::cli {

struct DriveServer {
  std::string address;
  std::string device;  ///< under which the files are stored; empty: the document's id
};

/// The result document. `document_path` names the drive.json, whose files lie beside it; `model_path`, where not empty,
/// what the filter believes in place of its model.
[[nodiscard]] tl::expected<Json, Failure> ask_drive_there(const DriveServer& server, const std::string& document_path,
                                                          const std::string& model_path, const DriveRequest& request);

}  // namespace driftlab::cli
