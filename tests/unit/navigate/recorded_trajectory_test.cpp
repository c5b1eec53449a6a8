// A recorded trajectory, which is not part of the repository, as the truth of a scenario.
#include "core/navigate/outage_prediction.hpp"
#include "tests/shared_folder.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace driftlab {
namespace {

std::optional<std::filesystem::path> data_folder() {
  const auto shared = shared_folder();
  return shared ? std::optional(*shared / "data") : std::nullopt;
}

/// Rows of a CSV file with one line of names.
std::vector<std::vector<double>> read_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) {
      row.push_back(std::stod(cell));
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

TEST(RecordedTrajectory, ARealDriveThroughTownIsAScenario) {
  // A car's reference trajectory (once a second, with attitude) in place of segments: simulated sensors along it, and a
  // filter that believes the truth knows how good it is on real roads too.
  const auto data = data_folder();
  if (!data) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const auto rows = read_csv(*data / "nav" / "navego_turin" / "ref.csv");
  OutageScenario scenario = prediction_scenario();
  scenario.drive.start = {rows[0][1], rows[0][2], rows[0][3]};
  for (std::size_t i = 0; i <= 600; ++i) {
    scenario.recorded.push_back(
        {rows[i][0], {rows[i][4], rows[i][5], rows[i][6]}, {rows[i][7], rows[i][8], rows[i][9]}});
  }
  scenario.drive.duration_s = 600.0;
  scenario.outages.clear();
  for (double begin = 60.0; begin < 580.0; begin += 60.0) {
    scenario.outages.push_back({begin, 10.0});
  }
  scenario.filters.front().settings.imu = scenario.truth;
  OutageOptions options;
  options.runs = 20;
  const OutageEvaluation found = *evaluate_outages(scenario, options);
  // The path is the integral of the velocities: after ten minutes within 1 % of its 1.8 km of where the reference is.
  const Vector3 end =
      ned_axes(rows[0][1], rows[0][2]).transpose() *
      (to_ecef({rows[600][1], rows[600][2], rows[600][3]}) - to_ecef({rows[0][1], rows[0][2], rows[0][3]}));
  EXPECT_NEAR(found.truth.north_m.back(), end.x(), 18.0);
  EXPECT_NEAR(found.truth.east_m.back(), end.y(), 18.0);
  const FilterEvaluation& filter = found.filters.front();
  std::cout << "town: " << filter.mean_error_m.value << " m after 10 s, NEES " << filter.nees.value << " ["
            << filter.nees.ci95.low << ", " << filter.nees.ci95.high << "]\n";
  // Twice the half-width of the interval: one seed in 10 000 would fail a filter that is right.
  EXPECT_NEAR(filter.nees.value, 2.0, 2.0 * (filter.nees.ci95.high - filter.nees.value));
}

}  // namespace
}  // namespace driftlab
