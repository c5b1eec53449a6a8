// The octave pass over a mapped column file that may be larger than the memory: time a sample, and what is held.
// DRIFTLAB_BENCH_ROWS sets its length (default 10^8, 0.8 GB in the directory of temporary files, twice that while it is
// written).
#include "core/process/random.hpp"
#include "core/read/column_file.hpp"
#include "core/variance/haar_variance.hpp"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace driftlab {
namespace {

std::size_t rows() {
  const char* const text = std::getenv("DRIFTLAB_BENCH_ROWS");  // NOLINT(concurrency-mt-unsafe): before any thread
  return text != nullptr ? std::strtoull(text, nullptr, 10) : 100000000;
}

std::filesystem::path make_file(std::size_t count) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "driftlab_octave_bench.dlcol";
  auto writer = ColumnFileWriter::create(path, {"x"});
  Random random(1);
  std::vector<double> chunk(1 << 20);
  for (std::size_t done = 0; writer && done < count; done += chunk.size()) {
    for (double& value : chunk) {
      value = random.normal();
    }
    const std::span<const double> part(chunk.data(), std::min(chunk.size(), count - done));
    if (!writer->append_column(0, part)) {
      return {};
    }
  }
  return writer && writer->finish() ? path : std::filesystem::path{};
}

/// Anonymous memory of this process [kB], mapped files not counted.
std::size_t anonymous_kb() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "RssAnon:") {
      std::size_t kb = 0;
      status >> kb;
      return kb;
    }
  }
  return 0;
}

void OctavesOfAFile(benchmark::State& state) {  // NOLINT(readability-identifier-naming): benchmark names are stable
  const std::filesystem::path path = make_file(rows());
  auto file = path.empty() ? Result<ColumnFile>(fail(ErrorCode::Io, "")) : ColumnFile::open(path);
  if (!file) {
    state.SkipWithError("no column file could be written");
    return;
  }
  const std::span<const double> column = file->column(0);
  const std::size_t before = anonymous_kb();
  std::atomic<std::size_t> most{0};
  std::jthread watch([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      most = std::max(most.load(), anonymous_kb());
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  });
  for (auto _ : state) {
    benchmark::DoNotOptimize(haar_variance(column, 0.0));
  }
  watch.request_stop();
  watch.join();
  state.counters["ns_per_sample"] =
      benchmark::Counter(static_cast<double>(column.size()) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["held_MB"] = static_cast<double>(most - std::min(before, most.load())) / 1024.0;
  std::filesystem::remove(path);
}

BENCHMARK(OctavesOfAFile)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
}  // namespace driftlab
