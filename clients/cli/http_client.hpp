#pragma once
/// The little HTTP that the command line needs: requests with bodies from memory or a file, and event streams.
#include "core/signal/result.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::cli {

struct HttpReply {
  int status = 0;
  std::string content_type;
  std::string body;
  bool pending = false;  ///< the answer will change when a job ends: it has Retry-After
};

struct HttpRequest {
  std::string method;  ///< GET, POST, PATCH, DELETE
  std::string target;  ///< path and query
  std::string json;    ///< body; empty: none
  std::string accept = "application/json";
  std::string if_match;  ///< ETag, or `*`; empty: not said
};

/// Talks to one daemon. Every failure to reach it is ErrorCode::Io, with a sentence that names the address. Not thread
/// safe.
class HttpClient {
 public:
  /// The token that every client made from now on sends; empty: none. It comes from a file or from DRIFTLAB_TOKEN, and
  /// never from an argument, which others could read.
  static void use_token(std::string token);
  /// The authorities that clients made from now on trust, as a PEM file; empty: those of the system.
  static void trust(std::string ca_file);
  /// `http://127.0.0.1:8477`, `https://lab.example`. Errors: InvalidArgument (not such an address).
  [[nodiscard]] static Result<HttpClient> to(std::string_view server);

  [[nodiscard]] Result<HttpReply> get(const std::string& target, const std::string& accept = "application/json");
  /// The same once no job that may change it is queued or running any more; asks again until `stop` says so.
  [[nodiscard]] Result<HttpReply> get_settled(const std::string& target, const std::string& accept,
                                              const std::function<bool()>& stop);
  [[nodiscard]] Result<HttpReply> post(const std::string& target, const std::string& json);
  [[nodiscard]] Result<HttpReply> send(const HttpRequest& wanted);
  /// Streams a file; `sent` is called with the fraction sent.
  [[nodiscard]] Result<HttpReply> upload(const std::string& target, const std::filesystem::path& file,
                                         const std::function<void(double)>& sent);
  /// Follows a server-sent event stream until it closes or `event` returns false. `event` gets the data of each. With
  /// `last_id` it goes on behind the event of that id, where that is not empty, and leaves the id of the last there.
  [[nodiscard]] Status follow(const std::string& target, const std::function<bool(std::string_view data)>& event,
                              std::string* last_id = nullptr);

 private:
  [[nodiscard]] Result<HttpReply> get(const std::string& target, const std::string& accept, int wait_s);
  HttpClient(std::string host, std::string port, bool secure)
      : host_(std::move(host)), port_(std::move(port)), secure_(secure) {}
  std::string host_;
  std::string port_;
  bool secure_;
};

/// A query component with everything but unreserved characters percent-encoded (RFC 3986).
[[nodiscard]] std::string percent_encode(std::string_view text);

}  // namespace driftlab::cli
