#pragma once
/// Commands that show one page of the daemon.
#include "clients/cli/cli.hpp"
#include "clients/cli/remote_job.hpp"

#include <string>

namespace driftlab::cli {

/// Prints what the daemon answers to GET `target`, or complains in the words of its problem document: bad input where
/// the request was at fault, else server. `output`: the file to write instead. Recordings that are still being pooled
/// are waited for.
[[nodiscard]] Exit print_answer(const std::string& server, const std::string& target, const std::string& accept,
                                const std::string& output = "");

/// The document that the daemon answers to GET `target`, with the same refusals.
[[nodiscard]] tl::expected<Json, Failure> fetch_document(const std::string& server, const std::string& target);

/// Writes a text to a file, or to standard output where `path` is empty. Error: one sentence, BadInput.
[[nodiscard]] Exit write_text(const std::string& path, const std::string& text);

}  // namespace driftlab::cli
