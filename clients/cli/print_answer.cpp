#include "clients/cli/print_answer.hpp"

#include "clients/cli/http_client.hpp"
#include "schema/json/json.hpp"

#include <cstdio>
#include <fstream>

namespace driftlab::cli {

namespace {

tl::expected<HttpReply, Failure> answer_of(const std::string& server, const std::string& target,
                                           const std::string& accept) {
  auto client = HttpClient::to(server);
  if (!client) {
    return tl::unexpected(Failure{client.error(), Exit::BadInput});
  }
  auto reply = client->get_settled(target, accept, [] { return interrupt_token().stop_requested(); });
  if (!reply) {
    return tl::unexpected(Failure{reply.error(), Exit::ServerOrJob});
  }
  if (reply->status != 200) {
    const auto problem = parse_json(reply->body);
    const std::string detail = problem && problem->is_object() ? problem->value("detail", "") : "";
    return tl::unexpected(Failure{{ErrorCode::InvalidArgument, detail.empty() ? "The daemon refused." : detail, {}},
                                  reply->status < 500 ? Exit::BadInput : Exit::ServerOrJob});
  }
  return std::move(*reply);
}

}  // namespace

Exit print_answer(const std::string& server, const std::string& target, const std::string& accept,
                  const std::string& output) {
  const auto reply = answer_of(server, target, accept);
  return reply ? write_text(output, reply->body) : complain(reply.error().error, reply.error().exit);
}

tl::expected<Json, Failure> fetch_document(const std::string& server, const std::string& target) {
  const auto reply = answer_of(server, target, "application/json");
  if (!reply) {
    return tl::unexpected(reply.error());
  }
  auto document = parse_json(reply->body);
  if (!document) {
    return tl::unexpected(Failure{document.error(), Exit::ServerOrJob});
  }
  return std::move(*document);
}

Exit write_text(const std::string& path, const std::string& text) {
  if (path.empty()) {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return Exit::Success;
  }
  std::ofstream out(path, std::ios::binary);
  out << text;
  out.close();
  return out ? Exit::Success : complain({ErrorCode::Io, "The file " + path + " cannot be written.", {{"path", path}}});
}

}  // namespace driftlab::cli
