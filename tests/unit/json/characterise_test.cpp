#include "schema/json/characterise.hpp"

#include "core/process/model.hpp"
#include "schema/json/calibration.hpp"

#include <gmock/gmock.h>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// WN+RW of 20000 samples at 100 Hz; after every 4000 samples 2 s are lost.
struct Recorded {
  std::vector<double> time;
  std::vector<double> values;
};

Recorded with_gaps() {
  Random random(12, 0);
  const std::vector<double> x =
      simulate({*make_process("white_noise", {0.02}), *make_process("random_walk", {0.01})}, random, kDt, 20000);
  Recorded recorded;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 4000 < 3800) {
      recorded.time.push_back(kDt * static_cast<double>(i));
      recorded.values.push_back(x[i]);
    }
  }
  return recorded;
}

TEST(CharacteriseRecording, GapsCostOnlyWhatTouchesThem) {
  const Recorded recorded = with_gaps();
  const RecordingSpec spec;
  auto view = view_recording(spec, {"time (s)", "gz (rad/s)"}, recorded.time.size(), [&](std::size_t i) {
    return std::span<const double>(i == 0 ? recorded.time : recorded.values);
  });
  ASSERT_TRUE(view) << view.error().message;
  const auto prepared = PreparedRecording::make(spec, std::move(*view), {});
  ASSERT_TRUE(prepared) << prepared.error().message;
  const auto found = characterise_recording(*prepared, {.models = {"WN+RW"}}, {});
  ASSERT_TRUE(found) << found.error().message;
  const Json document = to_json(*found);
  const Json& channel = document["channels"][0];
  EXPECT_EQ(channel["samples"], 19000);
  EXPECT_EQ(channel["missing"], 800);  // the last gap is the end of the recording
  EXPECT_NEAR(document["duration_s"].get<double>(), 198.0, 1e-9);
  // Scales to half of 19800 samples; the longest whole stretch, 3800 samples, would end at 2048.
  EXPECT_EQ(channel["haar"]["scale"].back(), 16384);
  EXPECT_EQ(channel["haar"]["efficiency_by_scale"].size(), channel["haar"]["scale"].size());
  const Json& params = channel["fits"][0]["processes"];
  // 0.02 rad/sqrt(s) to 1 %, the random walk to 25 %: 200 s hold so much.
  EXPECT_NEAR(params[0]["params"]["N"]["value"].get<double>(), 0.02 * 180.0 / 3.14159265358979 * 60.0, 1.5);
  EXPECT_FALSE(params[1]["params"]["K"].is_null());
}

TEST(CharacteriseRecording, IsTheSameForAnyNumberOfThreads) {
  const Recorded recorded = with_gaps();
  std::vector<std::vector<double>> axes(3, recorded.values);
  for (std::size_t i = 0; i < recorded.values.size(); ++i) {
    axes[1][i] = 0.5 * recorded.values[i] * recorded.values[i];
    axes[2][i] += 1e-3 * static_cast<double>(i % 7);
  }
  const RecordingSpec spec;
  auto view =
      view_recording(spec, {"time (s)", "gx (rad/s)", "gy (rad/s)", "gz (rad/s)"}, recorded.time.size(),
                     [&](std::size_t i) { return std::span<const double>(i == 0 ? recorded.time : axes[i - 1]); });
  ASSERT_TRUE(view) << view.error().message;
  const auto prepared = PreparedRecording::make(spec, std::move(*view), {});
  ASSERT_TRUE(prepared);
  const std::string one = to_text(to_json(*characterise_recording(*prepared, {}, {})));
  Executor executor(4);
  RunControl control;
  control.threads.executor = &executor;
  double last = 0.0;
  control.progress = [&last](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  EXPECT_EQ(to_text(to_json(*characterise_recording(*prepared, {}, control))), one);
  std::stop_source stopped;
  stopped.request_stop();
  control.stop = stopped.get_token();
  const auto cancelled = characterise_recording(*prepared, {}, control);
  ASSERT_FALSE(cancelled);
  EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
}

TEST(Calibration, IsReadAsItIsWritten) {
  TriadCalibration made;
  made.law.matrix = {Triple{1.1, 0.01, 0.0}, Triple{0.0, 0.9, 0.02}, Triple{0.03, 0.0, 1.05}};
  made.law.bias = {0.1, -0.2, 0.3};
  Json document;
  document["gyroscope"] = to_json(made, *parse_unit("rad/s"));
  Faults faults;
  const Calibration read = calibration_from_json(*parse_json(to_text(document)), "", faults);
  ASSERT_TRUE(faults.none());
  ASSERT_TRUE(read.gyroscope);
  EXPECT_FALSE(read.accelerometer);
  const Triple truth{0.4, -1.2, 2.0};
  Triple reading{};
  for (std::size_t i = 0; i < 3; ++i) {
    reading[i] = made.law.bias[i];
    for (std::size_t j = 0; j < 3; ++j) {
      reading[i] += made.law.matrix[i][j] * truth[j];
    }
  }
  const Triple corrected = read.gyroscope->correct(reading);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(corrected[i], truth[i], 1e-12);
  }
}

TEST(Calibration, NamesWhatIsWrongInIt) {
  for (
      const char* const text :
      {"[]", "{}", R"({"gyroscope": {}})", R"({"gyroscope": {"apply": {"reading_unit": "ell", "bias": [0,0,0]}}})",
       R"({"accelerometer": {"apply": {"reading_unit": "g", "bias": [0,0], "correction": [[1,0,0],[0,1,0],[0,0,1]]}}})"}) {
    Faults faults;
    (void)calibration_from_json(*parse_json(text), "", faults);
    EXPECT_FALSE(faults.none()) << text;
  }
}

}  // namespace
}  // namespace driftlab
