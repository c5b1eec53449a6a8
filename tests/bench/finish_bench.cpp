/// What a write of many rows takes where the database is some way off: the end of a job with its results, and the move
/// of a store. On the PostgreSQL database of DRIFTLAB_BENCH_STORE, which it empties; tests/bench/finish_times.py starts
/// one, puts a network of a known delay before it and makes a table of the times.
#include "server/move_rows.hpp"
#include "server/moved_tables.hpp"
#include "server/store/clock.hpp"
#include "server/store/digest.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "server/store/sqlite/sqlite_store.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::int64_t kLeaseMicros = 600'000'000;
constexpr int kModels = 9;                      // that a characterisation fits to a channel
constexpr std::size_t kFitBytes = 2000;         // a row of fits and its indexes are 2.4 kB (tests/SCALE.md)
constexpr std::size_t kChannelBytes = 20'000;   // its curve
constexpr std::size_t kDocumentBytes = 40'000;  // of the job

template <class T>
T value_of(Result<T> result) {
  if (!result) {
    (void)std::fprintf(stderr, "%s\n", result.error().message.c_str());
    std::abort();
  }
  return std::move(*result);
}

std::unique_ptr<PostgresStore> open_store() {
  const char* const uri = std::getenv("DRIFTLAB_BENCH_STORE");  // NOLINT(concurrency-mt-unsafe): no thread yet
  return value_of(open_postgres_store(uri == nullptr ? "" : uri, PostgresOptions{}));
}

JobResults results_of(const Recording& recording, int channels) {
  JobResults results;
  results.document_json = "\"" + std::string(kDocumentBytes, 'd') + "\"";
  for (int i = 0; i < channels; ++i) {
    ChannelResult channel;
    channel.id = make_id("chr", i);
    channel.device_id = recording.device_id;
    channel.recording_id = recording.id;
    channel.recording_revision = recording.revision;
    channel.channel = "channel " + std::to_string(i);
    channel.quantity = i < 3 ? "angular_rate" : "acceleration";
    channel.axis = std::string(1, "xyz"[i % 3]);
    channel.condition = "static";
    channel.document_json = "\"" + std::string(kChannelBytes, 'c') + "\"";
    channel.settings_json = "{}";
    channel.glance = {R"({"models":1})", 1};
    for (int rank = 0; rank < kModels; ++rank) {
      Fit fit;
      fit.channel_result_id = channel.id;
      fit.device_id = channel.device_id;
      fit.recording_id = channel.recording_id;
      fit.recording_revision = channel.recording_revision;
      fit.channel = channel.channel;
      fit.quantity = channel.quantity;
      fit.axis = channel.axis;
      fit.condition = channel.condition;
      fit.model = "model " + std::to_string(rank);
      fit.rank = rank;
      fit.document_json = "\"" + std::string(kFitBytes, 'f') + "\"";
      results.fits.push_back(std::move(fit));
    }
    results.channels.push_back(std::move(channel));
  }
  return results;
}

/// A job about a recording of a device of its own, claimed: what is left is to end it.
std::pair<Lease, Recording> claimed_job(Store& store) {
  static int number = 0;
  const std::string name = "device " + std::to_string(SystemClock().now()) + " " + std::to_string(++number);
  Device device;
  device.name = name;
  Blob blob;
  blob.sha256 = sha256_hex(name);
  blob.format = "csv";
  blob.compression = "none";
  Recording recording;
  recording.device_id = value_of(store.ensure_device(device)).device.id;
  recording.metadata_json = R"({"condition":"static"})";
  recording.condition = "static";
  recording = value_of(store.add_recording(blob, recording)).recording;
  value_of(store.enqueue({"characterise", name, R"({"inputs":{"recordings":[")" + recording.id + "\"]}}", 0}));
  const auto job = value_of(store.claim(kLeaseMicros));
  if (!job) {
    std::abort();
  }
  return {{job->id, job->attempt}, recording};
}

template <class Work>
double seconds_of(const Work& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// A job ends with the results of `range(0)` channels, nine fits each.
void FinishJob(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  const auto store = open_store();
  for (auto _ : state) {
    const auto [lease, recording] = claimed_job(*store);
    const JobResults results = results_of(recording, static_cast<int>(state.range(0)));
    state.SetIterationTime(seconds_of([&] {
      if (!value_of(store->succeed(lease, results)).held) {
        std::abort();
      }
    }));
  }
}

/// The rows of such jobs of six channels are copied from SQLite; or are there already, and are compared.
void MoveRows(benchmark::State& state) {  // NOLINT(readability-identifier-naming)
  static const SystemClock clock;
  const auto folder =
      std::filesystem::temp_directory_path() / ("driftlab-finish-" + std::to_string(SystemClock().now()));
  auto source = value_of(open_sqlite_store(folder, clock));
  for (int i = 0; i < state.range(0); ++i) {
    const auto [lease, recording] = claimed_job(*source);
    value_of(source->succeed(lease, results_of(recording, 6)));
  }
  const auto store = open_store();
  std::string tables;
  const auto moving = value_of(moved_tables(source->database(), store->database()));
  for (const MovedTable& table : moving) {
    tables += table.name == "audit" ? "" : (tables.empty() ? "" : ", ") + std::string(table.name);
  }
  for (auto _ : state) {
    value_of(store->database().write(WriteKind::Fenced, [&](Connection& connection) -> Result<int> {
      const Status emptied = connection.prepare("TRUNCATE " + tables + " CASCADE").run();
      return emptied ? Result<int>(0) : fail(emptied.error());
    }));
    MovedRows moved;
    const auto copied = [&] { moved = value_of(copy_rows(source->database(), store->database(), moving)); };
    const double first_s = seconds_of(copied);
    state.counters["rows"] = static_cast<double>(moved.added);
    // What a lab that went ahead waits for: nothing has changed, and all is compared.
    const double again_s = seconds_of(copied);
    state.SetIterationTime(state.range(1) == 0 ? first_s : again_s);
  }
  source.reset();
  std::filesystem::remove_all(folder);
}

BENCHMARK(FinishJob)
    ->ArgName("channels")
    ->Arg(3)
    ->Arg(6)
    ->Iterations(20)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(MoveRows)
    ->ArgNames({"jobs", "ahead"})
    ->ArgsProduct({{10, 500}, {0, 1}})
    ->Iterations(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace driftlab::server
