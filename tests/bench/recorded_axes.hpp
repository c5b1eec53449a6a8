#pragma once
/// What recordings cost beside simulated series: the six axes of an ADIS16405 at rest, 10^6 samples of 100 Hz each,
/// from the folder of recordings that are not part of the repository (DRIFTLAB_SHARED, default ../shared). A sensor
/// that no model of the classical class describes takes the searches and the sample-wise estimator further than any
/// simulated one.
#include "tests/unit/fit/shared_data.hpp"

#include <benchmark/benchmark.h>

#include <vector>

namespace driftlab::recorded_axes {

/// Gyroscopes x, y, z [deg/s] and accelerometers x, y, z [g]; empty without the folder, and the benchmark says so.
inline const std::vector<std::vector<double>>& adis(benchmark::State& state) {
  static const std::vector<std::vector<double>> columns = [] {
    const auto shared = shared_data::folder();
    return shared ? shared_data::read_npy_xz(*shared / "data" / "adis_16405_imu1.npy.xz", 6)
                  : std::vector<std::vector<double>>{};
  }();
  if (columns.empty()) {
    state.SkipWithError("no recordings; set DRIFTLAB_SHARED to the folder that holds data/");
  }
  return columns;
}

}  // namespace driftlab::recorded_axes
