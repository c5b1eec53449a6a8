#pragma once
/// The routes over a real store in a directory that vanishes, without sockets and without workers.
#include "server/api/api.hpp"
#include "server/store/sqlite/sqlite_store.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

namespace driftlab::server {

struct World {
  World() {
    std::string name = (std::filesystem::temp_directory_path() / "driftlab-api-XXXXXX").string();
    directory = ::mkdtemp(name.data());
    store = std::move(open_sqlite_store(directory, clock).value());
    blobs = std::move(open_blob_directory(directory).value());
    context.reset(new ApiContext{*store, *blobs, clock, bell, events, [this] { ++wake_ups; },
                                 [this] { return not_ready; }, directory, store->access(), gate()});
    context->webhooks = &store->webhooks();
    add_all_routes(router, *context);
    dispatcher = std::make_unique<Dispatcher>(*context);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    dispatcher.reset();
    store.reset();
    blobs.reset();
    std::error_code ignored;
    std::filesystem::remove_all(directory, ignored);
  }

  Gate& gate() {
    if (!opened_gate) {
      opened_gate = std::make_unique<Gate>(store->access(), clock, GateOptions{});
    }
    return *opened_gate;
  }

  /// A plain request through the dispatcher, as the connection would pass it on.
  Response ask(std::string_view method, std::string_view target, std::string body = "",
               std::vector<std::pair<std::string, std::string>> headers = {}) {
    Request request;
    request.method = method;
    request.target = target;
    auto parsed = parse_target(target).value();
    request.path = parsed.path;
    request.query = parsed.query;
    request.headers = std::move(headers);
    request.body = std::move(body);
    if (!request.body.empty() && !request.header("content-type")) {
      request.headers.emplace_back("content-type", "application/json");
    }
    request.request_id = "req_test";
    auto match = router.match(method, request.path);
    request.parameters = match.parameters;
    Response response = dispatcher->run(*match.route, request);
    complete_problem(request, response);
    return response;
  }

  std::filesystem::path directory;
  SystemClock clock;
  Bell bell;
  EventLog events{bell, "run"};
  std::unique_ptr<SqliteStore> store;
  std::unique_ptr<BlobStore> blobs;
  std::unique_ptr<Gate> opened_gate;
  std::unique_ptr<ApiContext> context;
  Router router;
  std::unique_ptr<Dispatcher> dispatcher;
  int wake_ups = 0;
  std::string not_ready;
};

}  // namespace driftlab::server
