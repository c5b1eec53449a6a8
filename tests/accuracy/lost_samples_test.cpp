// Files that lost or repeated rows: is the noise that is read back that of the sensor, and do the intervals hold it?
// Series are simulated, written to files with their stamps, decoded and characterised as a user's file would be.
#include "core/fit/characterise.hpp"
#include "core/read/column_file.hpp"
#include "core/read/format.hpp"
#include "core/signal/recording_view.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>

namespace driftlab::accuracy {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSamples = 30000;

enum class Form {
  Csv,  ///< decimal stamps
  Npy   ///< 64-bit numbers without names
};

struct Case {
  const char* name;
  double lost = 0.0;
  double burst = 1.0;     ///< mean length of a gap
  double jitter = 0.0;    ///< of a stamp, in intervals
  double tick_s = 1e-6;   ///< stamps are whole multiples of this; 0: numbers of single precision
  double repeated = 0.0;  ///< of the rows are there twice
  double rate_hz = 100.0;
  Form form = Form::Csv;
};

constexpr std::array kCases{
    Case{.name = "nothing"},
    Case{.name = "2 % at random", .lost = 0.02},
    Case{.name = "5 % at random", .lost = 0.05},
    Case{.name = "20 % at random", .lost = 0.2},
    Case{.name = "50 % at random", .lost = 0.5},
    Case{.name = "20 % in gaps of 10", .lost = 0.2, .burst = 10.0},
    Case{.name = "20 % at random, stamps err by 0.1 intervals", .lost = 0.2, .jitter = 0.1},
    Case{.name = "20 % at random, 400 Hz in whole ms", .lost = 0.2, .tick_s = 1e-3, .rate_hz = 400.0},
    Case{.name = "20 % at random, seconds in single precision", .lost = 0.2, .tick_s = 0.0},
    Case{.name = "20 % at random, .npy", .lost = 0.2, .form = Form::Npy},
    Case{.name = "5 % of rows twice", .repeated = 0.05},
    Case{.name = "20 % at random, 5 % of rows twice", .lost = 0.2, .repeated = 0.05},
};

struct Row {
  double stamp = 0.0;
  double value = 0.0;
};

std::vector<Row> rows_of(const std::vector<double>& x, const Case& one, Random& random) {
  const double dt = 1.0 / one.rate_hz;
  const double start = one.lost / one.burst / (1.0 - one.lost);
  std::vector<Row> rows;
  bool away = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double draw = random.uniform();
    away = one.burst > 1.0 ? (away ? draw > 1.0 / one.burst : draw < start) : draw < one.lost;
    if (away) {
      continue;
    }
    double stamp = 12.5 + dt * (static_cast<double>(i) + one.jitter * random.normal());
    stamp =
        one.tick_s > 0.0 ? one.tick_s * std::round(stamp / one.tick_s) : static_cast<double>(static_cast<float>(stamp));
    const int copies = one.repeated > 0.0 && random.uniform() < one.repeated ? 2 : 1;
    rows.insert(rows.end(), static_cast<std::size_t>(copies), {stamp, x[i]});
  }
  return rows;
}

void write(const fs::path& path, const std::vector<Row>& rows, Form form) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  ASSERT_NE(file, nullptr);
  if (form == Form::Csv) {
    (void)std::fputs("time (s),gz (rad/s)\n", file);
    for (const Row& row : rows) {
      (void)std::fprintf(file, "%.9f,%.9g\n", row.stamp, row.value);
    }
  } else {
    std::string header =
        "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(rows.size()) + ", 2), }";
    header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 10 - 1, ' ');
    header += '\n';
    (void)std::fwrite("\x93NUMPY\x01\x00", 1, 8, file);
    (void)std::fputc(static_cast<int>(header.size() & 0xFFU), file);
    (void)std::fputc(static_cast<int>(header.size() >> 8U), file);
    (void)std::fwrite(header.data(), 1, header.size(), file);
    static_assert(sizeof(Row) == 16);
    (void)std::fwrite(rows.data(), sizeof(Row), rows.size(), file);
  }
  (void)std::fclose(file);
}

Result<ChannelCharacterisation> read_back(const fs::path& path, const fs::path& scratch, const Case& one,
                                          const std::string& model, std::uint64_t seed) {
  auto decoded = decode_file(path, scratch);
  if (!decoded) {
    return fail(decoded.error());
  }
  auto columns = ColumnFile::open(scratch);
  if (!columns) {
    return fail(columns.error());
  }
  RecordingSpec spec;
  if (one.form == Form::Npy) {
    spec.columns = {{"0", {Quantity::Time, "", *parse_unit("s")}},
                    {"1", {Quantity::AngularRate, "z", *parse_unit("rad/s")}}};
  }
  auto view =
      view_recording(spec, columns->names(), columns->rows(), [&](std::size_t i) { return columns->column(i); });
  if (!view) {
    return fail(view.error());
  }
  const ChannelView& channel = view->channels.front();
  CharacteriseOptions options;
  options.models = {model};
  options.seed = seed;
  return characterise_channel({channel.values, view->window.time.dt_s, 1.0, channel.gaps}, options);
}

}  // namespace

TEST(Accuracy, FilesThatLostRowsHaveTheNoiseOfTheirSensor) {
  Section section("lost_samples");
  section.print(
      "\n## Files that lost or repeated rows\n\nSeries of %zu samples, written to a CSV file (or .npy) with stamps in "
      "microseconds, decoded, characterised with the true model: error of the sample interval (largest), samples read "
      "as lost against those that were (largest difference), mean error of the estimate of N with its standard error, "
      "and coverage of the 95 %% intervals of the parameters [%%].\n\n| truth | lost or repeated | runs | interval "
      "[ppm] | lost | N [%%] | coverage |\n|---|---|---|---|---|---|---|\n",
      kSamples);
  struct Truth {
    const char* name;
    Model model;
  };
  const std::vector<Truth> truths{{"WN+RW", model_of({{"white_noise", {0.0172}}, {"random_walk", {0.0024}}})},
                                  {"WN+GM", model_of({{"white_noise", {0.0172}}, {"gauss_markov", {0.0442, 1.71}}})}};
  const fs::path folder = fs::temp_directory_path() / ("driftlab_lost_samples_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  std::uint64_t seed = 91'000'000;
  for (const Truth& truth : truths) {
    for (const Case& one : kCases) {
      const std::size_t runs = repetitions(100);
      const double dt = 1.0 / one.rate_hz;
      double interval = 0.0;
      double miscounted = 0.0;
      double sum = 0.0;
      double squares = 0.0;
      std::vector<std::pair<std::string, std::size_t>> held;
      ++seed;
      for (std::size_t run = 0; run < runs; ++run) {
        Random random(seed, run);
        const std::vector<Row> rows = rows_of(simulate(truth.model, random, dt, kSamples), one, random);
        const fs::path path = folder / (one.form == Form::Csv ? "lost.csv" : "lost.npy");
        write(path, rows, one.form);
        const auto found = read_back(path, folder / "columns", one, truth.name, run + 1);
        ASSERT_TRUE(found) << one.name << ": " << found.error().message;
        std::size_t distinct = 1;
        for (std::size_t i = 1; i < rows.size(); ++i) {
          distinct += rows[i].stamp != rows[i - 1].stamp || rows[i].value != rows[i - 1].value ? 1 : 0;
        }
        EXPECT_EQ(found->samples, distinct) << one.name;
        const double places = std::round((rows.back().stamp - rows.front().stamp) / dt) + 1.0;
        const double lost = places - static_cast<double>(distinct);
        interval = std::max(interval, std::abs(found->dt_s / dt - 1.0) * 1e6);
        miscounted = std::max(miscounted, std::abs(static_cast<double>(found->missing) - lost));
        std::size_t k = 0;
        for (std::size_t p = 0; p < truth.model.size(); ++p) {
          for (std::size_t i = 0; i < truth.model[p].parameters.size(); ++i, ++k) {
            const FittedParameter& parameter = found->fits[0].processes[p].parameters[i];
            held.resize(std::max(held.size(), k + 1));
            held[k].first = parameter.declared->name;
            const double value = truth.model[p].parameters[i];
            held[k].second +=
                (parameter.estimate ? parameter.estimate->ci95.contains(value) : value <= parameter.upper_limit) ? 1
                                                                                                                 : 0;
            if (k == 0 && parameter.estimate) {
              const double error = 100.0 * (parameter.estimate->value / value - 1.0);
              sum += error;
              squares += error * error;
            }
          }
        }
      }
      const auto n = static_cast<double>(runs);
      const double mean = sum / n;
      const double error = std::sqrt((squares / n - mean * mean) / n);
      section.print("| %s | %s | %zu | %.1f | %.0f | %+.2f +- %.2f |", truth.name, one.name, runs, interval, miscounted,
                    mean, error);
      EXPECT_LT(std::abs(mean), 1.0 + 3.0 * error) << truth.name << ", " << one.name;
      for (const auto& [name, inside] : held) {
        section.print(" %s %.0f", name.c_str(), 100.0 * static_cast<double>(inside) / n);
        // 93 % less three and a half standard errors, but where half is lost: that is tabled, not promised.
        EXPECT_TRUE(one.lost > 0.3 || static_cast<double>(inside) / n > 0.93 - 3.5 * std::sqrt(0.05 * 0.95 / n))
            << truth.name << ", " << one.name << ": " << name;
      }
      section.print(" |\n");
    }
  }
  fs::remove_all(folder);
}

}  // namespace driftlab::accuracy
