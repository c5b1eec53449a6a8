#pragma once
/// What a daemon has stored, as the documents that commands here draw and print.
#include "clients/cli/remote_job.hpp"

#include <string>

namespace driftlab::cli {

struct StoredDocument {
  std::string device;  ///< its name; empty: none, or several
  Json document;
};

/// The result behind an id: of a recording (`rec_…`, what its newest characterisation says of it), an investigation
/// (`inv_…`) or a job (`job_…`, regression runs and evaluations among them). Recordings are called by the names of
/// their files. Errors are the daemon's, and BadInput where the id is none of these.
[[nodiscard]] tl::expected<StoredDocument, Failure> fetch_result(const std::string& server, const std::string& id);

/// The parameter tables of a device, of both sensors by both methods, about each axis that has results: one document
/// with `tables`. Errors: those of the daemon where it has none of them.
[[nodiscard]] tl::expected<StoredDocument, Failure> fetch_tables(const std::string& server, const std::string& device);

/// The same with `recordings`: what the newest characterisations of its channels say.
[[nodiscard]] tl::expected<StoredDocument, Failure> fetch_device(const std::string& server, const std::string& device);

}  // namespace driftlab::cli
