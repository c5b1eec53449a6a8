#pragma once
/// The use case "simulate": an error model in, a table of readings out, as a sensor would have written it.
///
/// Three things can be simulated: one axis from a published model, one channel of a simulation model with its effects,
/// and a whole inertial unit along the drive of an outage scenario, with its GNSS fixes and its truth. The same request
/// gives the same bits.
#include "core/investigate/study/study.hpp"
#include "core/navigate/outage_scenario.hpp"
#include "core/signal/condition.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace driftlab {

/// A table as a file holds it: in the units of its column names.
struct SampleTable {
  std::vector<std::string> columns;  ///< `gx [deg/s]`
  std::vector<int> decimals;         ///< how many a text file needs, per column
  std::vector<double> values;        ///< row after row

  [[nodiscard]] std::size_t rows() const { return values.size() / columns.size(); }
  [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * columns.size() + column]; }
};

/// How long, how often and under which motion one axis is simulated. What it reads besides its error: 0, the constant
/// rate, or the ramp from rest of the condition.
struct AxisSimulation {
  Condition condition;
  double rate_hz = 100.0;
  double duration_s = 900.0;
  std::uint64_t seed = 1;
};

/// One column, the rate about z [deg/s], from a published model (core/process/published_models.hpp). Errors: NotFound
/// (no such preset, or not under this condition).
[[nodiscard]] Result<SampleTable> simulate_preset(const std::string& preset, const AxisSimulation& wanted);

/// One channel of a simulation model.
struct ChannelSimulation {
  SampleTable table;  ///< time and reading; samples that are absent have no row, false stamps are as given
  std::vector<std::string> left_out;  ///< effects that the condition or the model cannot bring about, each with why
};

/// `channel` is a column of the model; empty: its first, or the z axis of a model that does not tell channels apart.
/// Its last letter names the axis. Errors: NotFound (no such channel); those of make_study_recording (too short).
[[nodiscard]] Result<ChannelSimulation> simulate_model(const investigate::Baseline& model, const std::string& channel,
                                                       const AxisSimulation& wanted);

struct DriveSimulation {
  OutageScenario scenario;
  std::uint64_t seed = 1;
  std::uint64_t run = 0;  ///< which Monte Carlo run of the scenario
  bool fixes = false;     ///< also the GNSS fixes of the run
  bool truth = false;     ///< also the true trajectory
};

struct SimulatedDrive {
  SampleTable imu;  ///< each row is the mean over the interval that ends at its time
  std::optional<SampleTable> fixes;
  std::optional<SampleTable> truth;
};

/// Errors: those of OutageExperiment::make.
[[nodiscard]] Result<SimulatedDrive> simulate_drive(const DriveSimulation& wanted);

}  // namespace driftlab
