#pragma once
/// One channel of a simulation model as a file: what a report's extended model or a stored revision says a sensor does.
#include "clients/cli/cli.hpp"

#include <cstdint>
#include <string>

namespace driftlab::cli {

struct ModelSimulation {
  std::string model;  ///< file: a model, an investigation's report (its extended model), a fit, or a list of processes
  std::string channel;    ///< column of the model; empty: its first
  std::string condition;  ///< as `parse_condition` takes it
  double rate_hz = 100.0;
  double duration_s = 900.0;
  std::uint64_t seed = 1;
  std::string out;
};

/// Writes time and reading, absent samples left out, false stamps as they were given. Effects that the condition or the
/// model cannot bring about are named on standard error and in the file.
[[nodiscard]] Exit simulate_model(const ModelSimulation& wanted);

}  // namespace driftlab::cli
