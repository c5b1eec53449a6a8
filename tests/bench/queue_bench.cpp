/// The queue alone: how many jobs a second are asked for, and claimed and finished, by threads that each have a
/// connection of their own. On the PostgreSQL database of DRIFTLAB_BENCH_STORE, which it empties of jobs; without one
/// on SQLite in a temporary folder. tests/bench/queue_rates.py starts a database and makes a table of it.
#include "server/store/sqlite/sqlite_store.hpp"
#ifdef DRIFTLAB_POSTGRES
#include "server/store/postgres/postgres_store.hpp"
#endif

#include <benchmark/benchmark.h>

#include <atomic>
#include <barrier>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace driftlab::server {
namespace {

constexpr std::int64_t kLeaseMicros = 60'000'000;
constexpr std::int64_t kTokens = 8;
constexpr std::int64_t kRunningPerToken = 1'000'000;  // none has to wait: what it costs to look is measured

/// ?1 jobs. In the shape that `enqueue` gives them, without a seal.
constexpr std::string_view kFill =
    "WITH RECURSIVE series (i) AS (SELECT CAST(1 AS BIGINT) UNION ALL SELECT i + 1 FROM series WHERE i < ?1) "
    "INSERT INTO jobs (id, kind, state, priority, max_failures, unique_key, request_json, run_at, created_at) "
    "SELECT 'job_000000000000000' || CAST(10000000000 + i AS TEXT), 'characterise', 'queued', 5, 5, "
    "'filled ' || CAST(i AS TEXT), '{\"kind\":\"characterise\"}', i, i FROM series";
constexpr std::string_view kFillTokens =
    "WITH RECURSIVE series (i) AS (SELECT CAST(0 AS BIGINT) UNION ALL SELECT i + 1 FROM series WHERE i + 1 < ?1) "
    "INSERT INTO tokens (id, name, scope, secret_sha256, created_at) SELECT 'bench' || CAST(100 + i AS TEXT), 'bench', "
    "'run', '00000000000000000000000000000000000000000000000000000000000' || CAST(10000 + i AS TEXT), 0 FROM series";
/// Every job has been asked for by one of ?1 tokens.
constexpr std::string_view kFillOwners =
    "INSERT INTO owners (object_id, token_id) SELECT id, 'bench' || CAST(100 + run_at % ?1 AS TEXT) FROM jobs";

struct Opened {
  std::unique_ptr<Store> store;
  Database* database = nullptr;
};
// Made before the threads of a run begin, and gone after them.
Opened opened;                    // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
std::filesystem::path folder;     // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<std::int64_t> asked;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

void end_with(const Error& error) {
  (void)std::fprintf(stderr, "%s\n", error.message.c_str());
  std::abort();
}

Opened open_store(int connections) {
  const char* const uri = std::getenv("DRIFTLAB_BENCH_STORE");  // NOLINT(concurrency-mt-unsafe): before the threads
  if (uri == nullptr) {
    static const SystemClock clock;
    folder = std::filesystem::temp_directory_path() / ("driftlab-queue-" + std::to_string(clock.now()));
    auto store = open_sqlite_store(folder, clock);
    if (!store) {
      end_with(store.error());
    }
    Database* const database = &(*store)->database();
    return {std::move(*store), database};
  }
#ifdef DRIFTLAB_POSTGRES
  PostgresOptions options;
  options.connections = connections;
  auto store = open_postgres_store(uri, options);
  if (!store) {
    end_with(store.error());
  }
  Database* const database = &(*store)->database();
  return {std::move(*store), database};
#else
  static_cast<void>(connections);
  end_with({ErrorCode::InvalidArgument, "driftlab was built without PostgreSQL.", {}});
  return {};
#endif
}

/// Runs statements, each with one number where that is not negative.
template <class... Statements>
void run(std::int64_t number, const Statements&... statements) {
  const auto one = [&](Connection& connection, std::string_view sql) {
    Statement statement = connection.prepare(sql);
    return number < 0 ? statement.run() : statement.bind(number).run();
  };
  const Status done = opened.database->write(WriteKind::Fenced, [&](Connection& connection) {
    Status status;
    (void)((status = one(connection, statements), status.has_value()) && ...);
    return status;
  });
  if (!done) {
    end_with(done.error());
  }
}

/// Opens all connections that the threads of a run use.
void connect(int connections) {
  std::barrier together(connections);
  std::vector<std::jthread> threads;
  for (int i = 0; i < connections; ++i) {
    threads.emplace_back([&] {
      const Status read = opened.database->read([&](Connection& connection) -> Status {
        const auto one = connection.query_integer("SELECT 1");
        together.arrive_and_wait();
        return one ? Status{} : fail(one.error());
      });
      if (!read) {
        end_with(read.error());
      }
    });
  }
}

void empty_store(const benchmark::State& state) {
  opened = open_store(state.threads());
  if (folder.empty()) {
    connect(state.threads());
  }
  asked = 0;
  run(-1, "DELETE FROM owners", "DELETE FROM jobs", "DELETE FROM tokens");
  if (folder.empty()) {
    run(-1, "TRUNCATE jobs, owners CASCADE");  // no rows that are dead
  }
}

/// Of all threads of a run; of claims no more than leaves the queue about as long as it was.
constexpr std::int64_t operations(std::int64_t waiting) { return waiting > 0 ? 640 : 1280; }

/// As many jobs as the run takes and `range(0)` that stay; `range(1)`: each was asked for by a token.
void fill_store(const benchmark::State& state) {
  empty_store(state);
  run(state.range(0) + operations(state.range(0)), kFill);
  if (state.range(1) != 0) {
    run(kTokens, kFillTokens, kFillOwners);
  }
  if (folder.empty()) {
    run(-1, "ANALYZE jobs", "ANALYZE owners");
  }
}

void close_store(const benchmark::State& /*state*/) {
  opened = {};
  if (!folder.empty()) {
    std::filesystem::remove_all(folder);
    folder.clear();
  }
}

/// One job is asked for. Every one is a row of the audit log too.
void Enqueue(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  NewJob job{"characterise", "", R"({"kind":"characterise","inputs":{"recordings":[]}})"};
  for (auto _ : state) {
    job.unique_key = "asked " + std::to_string(++asked);
    if (const auto queued = opened.store->enqueue(job); !queued) {
      state.SkipWithError(queued.error().message.c_str());
      break;
    }
  }
  state.SetItemsProcessed(state.iterations());
}

/// One job is claimed and finished with an empty result.
void ClaimAndFinish(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  JobResults results;
  results.document_json = "{}";
  for (auto _ : state) {
    const auto claimed = opened.store->claim(kLeaseMicros, kRunningPerToken);
    if (!claimed || !*claimed) {
      state.SkipWithError(claimed ? "the queue is empty" : claimed.error().message.c_str());
      break;
    }
    const auto ended = opened.store->succeed({(*claimed)->id, (*claimed)->attempt}, results);
    if (!ended || !ended->held) {
      state.SkipWithError(ended ? "the lease is lost" : ended.error().message.c_str());
      break;
    }
  }
  state.SetItemsProcessed(state.iterations());
}

void at_once(benchmark::internal::Benchmark* bench, int threads, std::int64_t waiting) {
  bench->Threads(threads)->Iterations(operations(waiting) / threads)->UseRealTime()->Unit(benchmark::kMillisecond);
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const int threads : {1, 8, 64}) {
    at_once(benchmark::RegisterBenchmark("Enqueue", Enqueue)->Setup(empty_store)->Teardown(close_store), threads, 0);
    for (const std::int64_t waiting : {100, 100'000}) {
      for (const std::int64_t tokens : {0, 1}) {
        at_once(benchmark::RegisterBenchmark("ClaimAndFinish", ClaimAndFinish)
                    ->Args({waiting, tokens})
                    ->ArgNames({"waiting", "tokens"})
                    ->Setup(fill_store)
                    ->Teardown(close_store),
                threads, waiting);
      }
    }
  }
  return true;
}();

}  // namespace
}  // namespace driftlab::server
