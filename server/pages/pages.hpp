#pragma once
/// The pages that people see: the lab dashboard, a program of the browser that reads the API like any other client.
///
/// Pages live beside the API and are no part of its contract. An address such as /recordings/rec_… is a page for
/// whoever prefers text/html, as browsers do, and stays what it was for everyone else. The program itself decides what
/// the address shows: each of them gets the same document, whose scripts and styles carry their hash in their name and
/// may be kept for ever.
#include "server/http/message.hpp"
#include "server/pages/dashboard_files.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::server {

class Pages {
 public:
  /// What `files` hold is not copied.
  explicit Pages(const std::vector<DashboardFile>& files);

  /// The page or file that the request asks for; nothing where it is for the API. Thread safe, never blocks.
  [[nodiscard]] std::optional<Response> answer(const Request& request) const;

 private:
  struct Kept {
    DashboardFile file;
    std::string tag;
    std::string packed;  ///< gzip; empty where it is sent as it is
  };
  [[nodiscard]] const Kept* find(std::string_view path) const;
  [[nodiscard]] static Response response_of(const Kept& kept, const Request& request);

  std::vector<Kept> files_;
};

}  // namespace driftlab::server
