/// Decoding speed of the binary recordings from memory on one core, in bytes of the file a second: made logs of 100 000
/// samples, and where DRIFTLAB_SHARED names the folder of real recordings, those.
#include "core/read/format.hpp"
#include "tests/bench/dropping_sink.hpp"
#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/ros_samples.hpp"

#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace {

using namespace driftlab;
using namespace driftlab::testing;

constexpr std::size_t kRows = 100'000;

void decode(benchmark::State& state, const std::string& bytes) {
  for (auto _ : state) {
    DroppingSink sink;
    const auto decoded = decode_stream(make_memory_reader(bytes), sink);
    if (!decoded) {
      state.SkipWithError(decoded.error().message.c_str());
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * bytes.size()));
}

std::string long_cwa() {
  std::string file = cwa_header();
  std::vector<int> values(240, 1000);
  for (std::uint32_t i = 0; i < kRows / 40; ++i) {
    file += cwa_block({i, i % 60}, 40, words_of(values));
  }
  return file;
}

std::string long_geneactiv() {
  std::string file = geneactiv_header();
  std::string page;
  for (int i = 0; i < 300; ++i) {
    page += "100080F00000";
  }
  for (int i = 0; i < static_cast<int>(kRows / 300); ++i) {
    file += geneactiv_page(i, "2023-05-09 10:11:12:500", page);
  }
  return file;
}

void ulog_log(benchmark::State& state) { decode(state, ulog(inertial_rows(kRows))); }
void mcap_plain(benchmark::State& state) { decode(state, mcap(inertial_rows(kRows))); }
void mcap_lz4(benchmark::State& state) { decode(state, mcap(inertial_rows(kRows), "lz4")); }
void mcap_zstd(benchmark::State& state) { decode(state, mcap(inertial_rows(kRows), "zstd")); }
void rosbag_plain(benchmark::State& state) { decode(state, rosbag(inertial_rows(kRows))); }
void rosbag_lz4(benchmark::State& state) { decode(state, rosbag(inertial_rows(kRows), "lz4")); }
void rosbag_bz2(benchmark::State& state) { decode(state, rosbag(inertial_rows(kRows), "bz2")); }
void rosbag2_database(benchmark::State& state) { decode(state, rosbag2(inertial_rows(kRows / 4))); }
void dataflash_log(benchmark::State& state) { decode(state, dataflash(inertial_rows(kRows))); }
void cwa_file(benchmark::State& state) { decode(state, long_cwa()); }
void geneactiv_text(benchmark::State& state) { decode(state, long_geneactiv()); }
void euroc_text(benchmark::State& state) { decode(state, euroc(inertial_rows(kRows))); }
void kf_gins_text(benchmark::State& state) { decode(state, kf_gins(inertial_rows(kRows))); }

/// The largest real recording of each format.
void real(benchmark::State& state, const char* path) {
  const char* const shared = std::getenv("DRIFTLAB_SHARED");  // NOLINT(concurrency-mt-unsafe): one thread
  const auto file = std::filesystem::path(shared == nullptr ? "" : shared) / "data" / path;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    state.SkipWithError("not there; DRIFTLAB_SHARED names the folder that holds data/");
    return;
  }
  decode(state, std::string(std::istreambuf_iterator<char>(stream), {}));
}

BENCHMARK(ulog_log)->Unit(benchmark::kMillisecond);
BENCHMARK(mcap_plain)->Unit(benchmark::kMillisecond);
BENCHMARK(mcap_lz4)->Unit(benchmark::kMillisecond);
BENCHMARK(mcap_zstd)->Unit(benchmark::kMillisecond);
BENCHMARK(rosbag_plain)->Unit(benchmark::kMillisecond);
BENCHMARK(rosbag_lz4)->Unit(benchmark::kMillisecond);
BENCHMARK(rosbag_bz2)->Unit(benchmark::kMillisecond);
BENCHMARK(rosbag2_database)->Unit(benchmark::kMillisecond);
BENCHMARK(dataflash_log)->Unit(benchmark::kMillisecond);
BENCHMARK(cwa_file)->Unit(benchmark::kMillisecond);
BENCHMARK(geneactiv_text)->Unit(benchmark::kMillisecond);
BENCHMARK(euroc_text)->Unit(benchmark::kMillisecond);
BENCHMARK(kf_gins_text)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, ulog, "px4-ulog/sample_log_small.ulg")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, rosbag_bz2, "rosbag1-imu/phidgets_imu_upside_down.bag")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, rosbag2, "rosbag2-db3-fixture/rosbag2_test_0.db3")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, cwa, "axivity-ax6/ax6_testfile.cwa")->Unit(benchmark::kMillisecond);

}  // namespace
