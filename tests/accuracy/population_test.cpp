// Populations: how often the interval of the mean and the prediction hold, and how often a line without an outlier
// shows a flag.
#include "core/campaign/population.hpp"

#include "core/process/distributions.hpp"
#include "core/process/random.hpp"
#include "tests/accuracy/section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace driftlab::accuracy {
namespace {

constexpr double kTruth = 1.0;  ///< mean of ln value
constexpr double kError = 0.05;

/// k devices about the truth with the spread tau, measured with deviations about 5 % (a factor 1.65 among them).
std::vector<DeviceEstimate> draw_line(Random& random, std::size_t k, double tau) {
  std::vector<DeviceEstimate> devices;
  for (std::size_t i = 0; i < k; ++i) {
    const double s = kError * std::exp(0.5 * random.normal());
    const double y = kTruth + tau * random.normal() + s * random.normal();
    const double half = kNormal975 * s;
    devices.push_back({"d" + std::to_string(i), {std::exp(y), std::exp(y - half), std::exp(y + half), "deg/h", ""}});
  }
  return devices;
}

struct Held {
  double mean = 0.0;
  double prediction = 0.0;
  double flagged = 0.0;
};

Held measure(std::size_t k, double tau, std::size_t runs) {
  Held held;
  const double share = 100.0 / static_cast<double>(runs);
  const double truth = std::exp(kTruth);
  for (std::size_t run = 0; run < runs; ++run) {
    Random random(130, run);
    const auto found = describe_population(draw_line(random, k, tau));
    const double further = std::exp(kTruth + tau * random.normal());
    held.mean += found->mean.low.value() <= truth && truth <= found->mean.high.value() ? share : 0.0;
    held.prediction += *found->predicted_low <= further && further <= *found->predicted_high ? share : 0.0;
    held.flagged +=
        std::any_of(found->places.begin(), found->places.end(), [](const DevicePlace& place) { return place.outlying; })
            ? share
            : 0.0;
  }
  return held;
}

}  // namespace

TEST(Accuracy, PopulationsHoldWhatTheySay) {
  Section section("populations");
  section.print(
      "\n## Populations: intervals and flags\n\nDevices measured with errors about 5 %% that differ among themselves "
      "by "
      "so much; %zu populations a row, %zu of 40 devices, seed 130. Shares [%%]: the 95 %% interval of the mean holds "
      "it, the prediction holds a further device, a population without an outlier shows a flag.\n\n| devices | differ "
      "by | mean | prediction | flag |\n|---|---|---|---|---|\n",
      repetitions(4000), repetitions(1000));
  for (const std::size_t k : {std::size_t{5}, std::size_t{8}, std::size_t{15}, std::size_t{40}}) {
    const std::size_t runs = repetitions(k == 40 ? 1000 : 4000);
    const double two_se = 2.0 * std::sqrt(95.0 * 5.0 / static_cast<double>(runs));
    for (const double tau : {0.0, 0.02, 0.05, 0.1, 0.3}) {
      const Held held = measure(k, tau, runs);
      section.print("| %zu | %.0f %% | %.1f | %.1f | %.1f |\n", k, 100.0 * tau, held.mean, held.prediction,
                    held.flagged);
      EXPECT_GE(held.mean, 93.0 - two_se) << k << " " << tau;
      EXPECT_LE(held.mean, 97.0 + two_se) << k << " " << tau;
      EXPECT_GE(held.prediction, 93.0 - two_se) << k << " " << tau;
      EXPECT_LE(held.flagged, 6.0 + two_se) << k << " " << tau;  // asked: 5; 6.1 at 15 devices that differ by 10 %
    }
  }
}

}  // namespace driftlab::accuracy
