#include "clients/cli/print_answer.hpp"

#include "clients/cli/http_client.hpp"
#include "schema/json/json.hpp"

#include <cstdio>

namespace driftlab::cli {

Exit print_answer(const std::string& server, const std::string& target, const std::string& accept) {
  auto client = HttpClient::to(server);
  if (!client) {
    return complain(client.error());
  }
  auto reply = client->get_settled(target, accept, [] { return interrupt_token().stop_requested(); });
  if (!reply) {
    return complain(reply.error(), Exit::ServerOrJob);
  }
  if (reply->status != 200) {
    const auto problem = parse_json(reply->body);
    const std::string detail = problem && problem->is_object() ? problem->value("detail", "") : "";
    return complain({ErrorCode::InvalidArgument, detail.empty() ? "The daemon refused." : detail, {}},
                    reply->status < 500 ? Exit::BadInput : Exit::ServerOrJob);
  }
  std::fwrite(reply->body.data(), 1, reply->body.size(), stdout);
  return Exit::Success;
}

}  // namespace driftlab::cli
