#include "server/http/answer_head.hpp"

#include <boost/beast/http/status.hpp>

#include <array>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnlessSaid{{
    {"X-Content-Type-Options", "nosniff"},
    {"Content-Security-Policy", "default-src 'self'; frame-ancestors 'none'"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-cache"},
}};

void add(std::string& head, std::string_view name, std::string_view value) {
  head += name;
  head += ": ";
  head += value;
  head += "\r\n";
}

}  // namespace

std::string answer_head(const Response& response, const AnswerFrame& frame) {
  constexpr std::size_t kUsual = 640;
  const auto status = boost::beast::http::int_to_status(static_cast<unsigned>(response.status));
  const boost::beast::string_view reason = boost::beast::http::obsolete_reason(status);
  const bool with_content = has_content(response.status);
  std::string head;
  head.reserve(kUsual);
  head += "HTTP/1.1 " + std::to_string(response.status) + " ";
  head.append(reason.data(), reason.size());
  head += "\r\n";
  if (frame.closes) {
    add(head, "Connection", "close");
  }
  if (with_content) {
    add(head, "Content-Type", response.content_type);
  }
  if (with_content && frame.length) {
    add(head, "Content-Length", std::to_string(*frame.length));
  }
  add(head, "X-Request-Id", frame.request_id);
  for (const auto& [name, value] : kUnlessSaid) {
    if (!response.has_header(name)) {
      add(head, name, value);
    }
  }
  for (const auto& [name, value] : response.headers) {
    add(head, name, value);
  }
  head += "\r\n";
  return head;
}

}  // namespace driftlab::server
