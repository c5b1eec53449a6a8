#pragma once
/// A job in a daemon, from the command line: queued, followed by its events, its result fetched.
#include "clients/cli/cli.hpp"
#include "clients/cli/http_client.hpp"
#include "clients/cli/progress.hpp"
#include "schema/json/json.hpp"

namespace driftlab::cli {

/// Share of the progress bar that the uploads before one job take.
inline constexpr double kUploads = 0.3;

/// What went wrong and how the process ends because of it.
struct Failure {
  Error error;
  Exit exit = Exit::BadInput;
};

/// The daemon could not be reached or understood.
[[nodiscard]] tl::unexpected<Failure> unreachable(const Error& error);

/// A problem document as a failure; a client's fault (4xx) is the user's input, the rest the server's.
[[nodiscard]] tl::unexpected<Failure> refused(const HttpReply& reply);

/// Posts a document and takes the id of what it made, `what`.
[[nodiscard]] tl::expected<Json, Failure> post_for_id(HttpClient& client, const std::string& target,
                                                      const Json& document, const std::string& what);

/// The result document of the job that `request` (kind, inputs, parameters) describes. The bar goes on from
/// `progress_before` to 1. An interrupt leaves the job running and says so.
[[nodiscard]] tl::expected<Json, Failure> run_job(HttpClient& client, const Json& request, ProgressBar& bar,
                                                  double progress_before = 0.0);

/// The same where the job itself is wanted: its id, once it has succeeded.
[[nodiscard]] tl::expected<std::string, Failure> succeeded_job(HttpClient& client, const Json& request,
                                                               ProgressBar& bar, double progress_before = 0.0,
                                                               double progress_after = 1.0);

}  // namespace driftlab::cli
