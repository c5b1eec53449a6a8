/// Decoding speed from memory on one core: bytes per second of text, without the disk.
#include "core/read/decimal.hpp"
#include "core/read/format.hpp"
#include "tests/bench/dropping_sink.hpp"

#include <benchmark/benchmark.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

namespace {

using driftlab::testing::DroppingSink;

/// A six-axis recording with a time column, each value with `digits` significant digits in the notation of `format`.
std::string make_csv(std::chars_format format, int precision) {
  std::mt19937_64 random(20260801);
  std::normal_distribution<double> noise(0.0, 0.02);
  std::string text = "t,gx,gy,gz,fx,fy,fz\n";
  const auto put = [&text](double value, std::chars_format how, int digits, char after) {
    char buffer[64];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, how, digits);
    text.append(buffer, end.ptr);
    text += after;
  };
  for (int row = 0; row < 200000; ++row) {
    put(row * 0.01, std::chars_format::fixed, 2, ',');
    for (int column = 0; column < 6; ++column) {
      put(noise(random), format, precision, column == 5 ? '\n' : ',');
    }
  }
  return text;
}

void decode(benchmark::State& state, const std::string& text) {
  for (auto _ : state) {
    DroppingSink sink;
    const auto decoded = driftlab::decode_stream(driftlab::make_memory_reader(text), sink);
    if (!decoded || decoded->rows != 200000) {
      state.SkipWithError("decoding failed");
    }
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations() * text.size()));
}

void csv_six_decimals(benchmark::State& state) { decode(state, make_csv(std::chars_format::fixed, 6)); }
void csv_nine_decimals(benchmark::State& state) { decode(state, make_csv(std::chars_format::fixed, 9)); }
void csv_seventeen_digits(benchmark::State& state) { decode(state, make_csv(std::chars_format::scientific, 16)); }
void csv_savetxt_default(benchmark::State& state) { decode(state, make_csv(std::chars_format::scientific, 18)); }

/// The same table between other separators, with a decimal comma where one is asked for.
std::string in_dialect(std::string text, char separator, bool decimal_comma) {
  for (char& c : text) {
    c = c == ',' ? separator : c == '.' && decimal_comma ? ',' : c;
  }
  return text;
}

void csv_decimal_comma(benchmark::State& state) {
  decode(state, in_dialect(make_csv(std::chars_format::fixed, 6), ';', true));
}
void csv_blanks(benchmark::State& state) {
  decode(state, in_dialect(make_csv(std::chars_format::fixed, 6), ' ', false));
}

BENCHMARK(csv_six_decimals)->Unit(benchmark::kMillisecond);
BENCHMARK(csv_nine_decimals)->Unit(benchmark::kMillisecond);
BENCHMARK(csv_seventeen_digits)->Unit(benchmark::kMillisecond);
BENCHMARK(csv_savetxt_default)->Unit(benchmark::kMillisecond);
BENCHMARK(csv_decimal_comma)->Unit(benchmark::kMillisecond);
BENCHMARK(csv_blanks)->Unit(benchmark::kMillisecond);

}  // namespace
