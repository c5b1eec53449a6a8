// `driftlab api`: any resource of a daemon, with the token and the certificates of the other commands.
#include "clients/cli/print_answer.hpp"
#include "clients/cli/remote_job.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::cli {
namespace {

constexpr std::array<std::string_view, 4> kMethods{"GET", "POST", "PATCH", "DELETE"};

struct ApiFlags {
  std::vector<std::string> words;  ///< METHOD PATH, or PATH
  std::string server = "http://127.0.0.1:8477";
  std::string data;
  std::string file;
  std::string accept = "application/json";
  std::string if_match = "*";
  std::string output;
};

struct Wanted {
  std::string method;
  std::string path;
};

Result<Wanted> wanted_of(const ApiFlags& flags) {
  Wanted wanted{"GET", flags.words.back()};
  if (flags.words.size() == 2) {
    wanted.method = flags.words.front();
  } else if (!flags.data.empty() || !flags.file.empty()) {
    wanted.method = "POST";
  }
  if (std::find(kMethods.begin(), kMethods.end(), wanted.method) == kMethods.end()) {
    return fail(ErrorCode::InvalidArgument,
                "'" + wanted.method + "' is no method; known are GET, POST, PATCH and DELETE.");
  }
  if (wanted.path.empty() || wanted.path.front() != '/') {
    return fail(ErrorCode::InvalidArgument,
                "'" + wanted.path + "' is no path of a resource; one is /v1/devices, and /openapi.yaml lists all.");
  }
  if (!flags.file.empty() && (wanted.method != "POST" || !flags.data.empty())) {
    return fail(ErrorCode::InvalidArgument, "A file goes by POST and without --data.");
  }
  return wanted;
}

/// The document of --data: as it stands there, or in a file (`@name`), or on standard input (`@-`).
Result<std::string> body_of(const std::string& data) {
  if (data.empty() || data.front() != '@') {
    return data;
  }
  const std::string name = data.substr(1);
  if (name == "-") {
    return std::string(std::istreambuf_iterator<char>(std::cin), {});
  }
  std::ifstream in(name, std::ios::binary);
  if (!in) {
    return fail(ErrorCode::NotFound, "The file " + name + " cannot be opened.", {{"path", name}});
  }
  return std::string(std::istreambuf_iterator<char>(in), {});
}

bool is_stream(const std::string& path) {
  const std::string resource = path.substr(0, path.find('?'));
  constexpr std::string_view kEnd = "/events";
  return resource.size() > kEnd.size() && resource.compare(resource.size() - kEnd.size(), kEnd.size(), kEnd) == 0;
}

/// Each event as a line, until the stream ends or somebody interrupts.
Exit follow(HttpClient& client, const std::string& path) {
  const Status followed = client.follow(path, [](std::string_view data) {
    std::printf("%.*s\n", static_cast<int>(data.size()), data.data());
    std::fflush(stdout);
    return !interrupt_token().stop_requested();
  });
  return followed ? Exit::Success : complain(followed.error(), Exit::ServerOrJob);
}

/// Documents are indented and every text ends with a line; other bytes are as they came.
std::string shown(const HttpReply& reply) {
  if (reply.content_type.find("json") != std::string::npos) {
    if (const auto document = parse_json(reply.body)) {
      return document->dump(2) + "\n";
    }
  }
  const bool text = reply.content_type.rfind("text/", 0) == 0;
  return text && !reply.body.empty() && reply.body.back() != '\n' ? reply.body + "\n" : reply.body;
}

Exit run(const ApiFlags& flags) {
  const auto wanted = wanted_of(flags);
  if (!wanted) {
    return complain(wanted.error());
  }
  const auto body = body_of(flags.data);
  if (!body) {
    return complain(body.error());
  }
  auto client = HttpClient::to(flags.server);
  if (!client) {
    return complain(client.error());
  }
  if (wanted->method == "GET" && is_stream(wanted->path)) {
    return follow(*client, wanted->path);
  }
  HttpRequest request{wanted->method, wanted->path, *body, flags.accept, ""};
  if (wanted->method != "GET" && wanted->method != "POST") {
    request.if_match = flags.if_match;
  }
  const auto reply =
      flags.file.empty() ? client->send(request) : client->upload(wanted->path, flags.file, [](double) {});
  if (!reply) {
    return complain(reply.error(), reply.error().code == ErrorCode::Io ? Exit::ServerOrJob : Exit::BadInput);
  }
  constexpr int kFirstRefusal = 300;
  if (reply->status >= kFirstRefusal) {
    const Failure failure = refused(*reply).value();
    return complain(failure.error, failure.exit);
  }
  return write_text(flags.output, shown(*reply));
}

}  // namespace

void add_api(CLI::App& app, Command& chosen) {
  CLI::App* const command =
      app.add_subcommand("api", "Any resource of a daemon: devices, recordings, studies, models, webhooks, ...");
  const auto flags = std::make_shared<ApiFlags>();
  command->add_option("REQUEST", flags->words, "[METHOD] PATH, e.g. /v1/devices, or DELETE /v1/devices/imu-07")
      ->required()
      ->expected(1, 2);
  command->add_option("--server", flags->server, "Address of the daemon")->capture_default_str();
  command->add_option("--data", flags->data, "JSON to send, @FILE that holds it, or @- for standard input");
  command->add_option("--file", flags->file, "File to send as it is, such as a recording to /v1/recordings?device=…");
  command->add_option("--accept", flags->accept, "Type of the answer, e.g. text/csv")->capture_default_str();
  command->add_option("--if-match", flags->if_match, "ETag that a change or a removal asks for; *: whatever is there")
      ->capture_default_str();
  command->add_option("--output", flags->output, "Write the answer to this file instead of the terminal");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
