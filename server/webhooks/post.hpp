#pragma once
/// One POST of a message to a receiver.
///
/// The host is resolved once; the connection goes to the first of its addresses that the guard admits, and to no other.
/// HTTPS verifies certificate chain and host name by OpenSSL against the system's authorities. A redirect is an answer
/// like any other and is not followed. Of the answer the header alone is read, 64 KiB at most. Everything together has
/// one deadline, and ends at once when it is asked to stop.
#include "server/webhooks/destination.hpp"

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace driftlab::server {

struct PostAnswer {
  int status = 0;           ///< 0: there was none
  std::string retry_after;  ///< as the header has it; empty: it is not there
  std::string error;        ///< a sentence where there was no answer; empty otherwise
};

[[nodiscard]] PostAnswer post(const DestinationGuard& guard, const Destination& destination,
                              const std::vector<std::pair<std::string, std::string>>& headers, const std::string& body,
                              std::chrono::steady_clock::duration patience, const std::stop_token& stop = {});

}  // namespace driftlab::server
