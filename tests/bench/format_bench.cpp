/// Decoding speed of recordings from memory on one core, in bytes of the file a second: made logs of 100 000 samples,
/// and where DRIFTLAB_SHARED names the folder of real recordings, those. HDF5 is read by a process of its own, whose
/// time counts (UseRealTime).
#include "core/read/format.hpp"
#include "tests/bench/dropping_sink.hpp"
#include "tests/unit/read/archives.hpp"
#include "tests/unit/read/inertial_samples.hpp"
#include "tests/unit/read/ros_samples.hpp"
#include "tests/unit/read/samples.hpp"

#include <benchmark/benchmark.h>

#include <cmath>
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

/// Six columns of numbers that compression cannot shorten much.
std::vector<double> six_columns() {
  std::vector<double> values(6 * kRows);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = std::sin(0.37 * static_cast<double>(i)) + 1e-3 * static_cast<double>(i % 7);
  }
  return values;
}

std::string npy_of(const std::string& descr, const std::vector<double>& values) {
  const std::string data = descr == "<f8" ? number_bytes<double>(values) : number_bytes<float>(values);
  return npy(npy_dictionary(descr, false, "(" + std::to_string(values.size() / 6) + ", 6)"), data);
}

std::string mat5_of(bool compressed) {
  return mat_file({mat_matrix("imu", static_cast<std::uint32_t>(kRows), 6, six_columns())}, compressed);
}

void npy_doubles(benchmark::State& state) { decode(state, npy_of("<f8", six_columns())); }
void npy_floats(benchmark::State& state) { decode(state, npy_of("<f4", six_columns())); }
void npz_deflated(benchmark::State& state) { decode(state, zip({{"imu.npy", npy_of("<f8", six_columns())}})); }
void mat5_plain(benchmark::State& state) { decode(state, mat5_of(false)); }
void mat5_deflated(benchmark::State& state) { decode(state, mat5_of(true)); }
void ubx_log(benchmark::State& state) { decode(state, ubx_pvt(static_cast<int>(kRows))); }
void rostopic_text(benchmark::State& state) { decode(state, rostopic(inertial_rows(kRows))); }
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

void decode_file_at(benchmark::State& state, const std::filesystem::path& file, const char* otherwise) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) {
    state.SkipWithError(otherwise);
    return;
  }
  decode(state, std::string(std::istreambuf_iterator<char>(stream), {}));
}

/// The largest real recording of each format.
void real(benchmark::State& state, const char* path) {
  const char* const shared = std::getenv("DRIFTLAB_SHARED");  // NOLINT(concurrency-mt-unsafe): one thread
  decode_file_at(state, std::filesystem::path(shared == nullptr ? "" : shared) / "data" / path,
                 "not there; DRIFTLAB_SHARED names the folder that holds data/");
}

/// Any recording, as one of HDF5 that h5py wrote.
void named(benchmark::State& state) {
  const char* const file = std::getenv("DRIFTLAB_BENCH_FILE");  // NOLINT(concurrency-mt-unsafe): one thread
  decode_file_at(state, file == nullptr ? "" : file, "DRIFTLAB_BENCH_FILE names no file");
}

BENCHMARK(npy_doubles)->Unit(benchmark::kMillisecond);
BENCHMARK(npy_floats)->Unit(benchmark::kMillisecond);
BENCHMARK(npz_deflated)->Unit(benchmark::kMillisecond);
BENCHMARK(mat5_plain)->Unit(benchmark::kMillisecond);
BENCHMARK(mat5_deflated)->Unit(benchmark::kMillisecond);
BENCHMARK(ubx_log)->Unit(benchmark::kMillisecond);
BENCHMARK(rostopic_text)->Unit(benchmark::kMillisecond);
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
BENCHMARK(named)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK_CAPTURE(real, ulog, "px4-ulog/sample_log_small.ulg")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, rosbag_bz2, "rosbag1-imu/phidgets_imu_upside_down.bag")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, rosbag2, "rosbag2-db3-fixture/rosbag2_test_0.db3")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, cwa, "axivity-ax6/ax6_testfile.cwa")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, mat5, "mpu6050-turntable-encoder/raw_roll_slow.mat")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(real, hdf5, "broad-optical-reference/05_undisturbed_slow_rotation_with_breaks_B.hdf5")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(real, mat73,
                  "mpu6050-static-10min-temp/set-2__unmoved-with-x-pointing-forward-10min/mpu6050_gyroscope.mat")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
