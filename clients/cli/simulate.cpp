#include "clients/cli/cli.hpp"
#include "clients/cli/scenario_input.hpp"
#include "clients/cli/simulate_model.hpp"
#include "clients/cli/table_file.hpp"
#include "core/navigate/outage_runs.hpp"
#include "core/process/published_models.hpp"
#include "core/signal/angle.hpp"
#include "core/signal/number.hpp"
#include "core/signal/unit.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace driftlab::cli {
namespace {

struct Flags {
  std::string preset = "iphone5s-z";
  std::string condition = "static";
  std::string model;
  std::string channel;
  double rate_hz = 100.0;
  double duration_s = 900.0;
  std::uint64_t seed = 1;
  std::string out;
  std::string scenario;
  std::uint64_t run = 0;
  std::string gnss;
  std::string truth;
};

/// What the sensor would read besides its error: 0, the constant rate, or the ramp from rest [rad/s].
double reference(const Condition& condition, double t_s) {
  const double value = condition.value.value_or(0.0);
  switch (condition.kind) {
    case ConditionKind::ConstantRate:
      return value;
    case ConditionKind::ConstantAngularAcceleration:
      return value * t_s;
    default:
      return 0.0;
  }
}

std::string provenance(const Flags& flags) {
  std::string text = "Simulated by driftlab " DRIFTLAB_VERSION ", ";
  if (!flags.scenario.empty()) {
    text.append("scenario ").append(flags.scenario).append(", run ").append(std::to_string(flags.run));
    return text.append(", seed ").append(std::to_string(flags.seed));
  }
  text.append("preset ")
      .append(flags.preset)
      .append(", condition ")
      .append(flags.condition)
      .append(", seed ")
      .append(std::to_string(flags.seed));
  text.append(", ").append(to_text(flags.rate_hz)).append(" Hz");
  return text.append("; see core/process/published_models.hpp");
}

/// One axis at one condition.
Exit simulate_axis_file(const Flags& flags) {
  auto condition = parse_condition(flags.condition);
  if (!condition) {
    return complain(condition.error());
  }
  auto model = published_model(flags.preset, *condition);
  if (!model) {
    return complain(model.error());
  }
  const double dt_s = 1.0 / flags.rate_hz;
  Random random(flags.seed);
  TableFile table;
  table.comment = provenance(flags);
  table.columns = {"gz [deg/s]"};
  table.decimals = {6};
  table.rows = static_cast<std::size_t>(flags.duration_s * flags.rate_hz);
  const std::vector<double> error = simulate(*model, random, dt_s, table.rows);
  const Unit unit = *parse_unit("deg/s");
  table.cell = [&](std::size_t row, std::size_t) {
    return unit.from_si(reference(*condition, static_cast<double>(row) * dt_s) + error[row]);
  };
  const Status written = write_table(flags.out, table);
  return written ? Exit::Success : complain(written.error());
}

Status write_imu(const Flags& flags, const Trajectory& truth, const ImuRun& run) {
  TableFile table;
  table.comment = provenance(flags) + "; each row is the mean over the interval that ends at t";
  table.columns = {"t [s]", "gx [deg/s]", "gy [deg/s]", "gz [deg/s]", "fx [m/s^2]", "fy [m/s^2]", "fz [m/s^2]"};
  table.decimals = {6, 9, 9, 9, 9, 9, 9};
  table.rows = run.readings.size();
  table.cell = [&](std::size_t row, std::size_t column) {
    if (column == 0) {
      return static_cast<double>(row + 1) * truth.dt_s;
    }
    const double value = run.readings[row][column - 1];
    return column <= 3 ? value / kDegree : value;
  };
  return write_table(flags.out, table);
}

Status write_gnss(const Flags& flags, const std::vector<GnssFix>& fixes) {
  TableFile table;
  table.comment = provenance(flags) + "; fixes; t is when one arrives, validity the moment it describes";
  table.columns = {"t [s]",    "validity [s]", "lat [deg]", "lon [deg]", "height [m]", "vn [m/s]",  "ve [m/s]",
                   "vd [m/s]", "sn [m]",       "se [m]",    "sd [m]",    "svn [m/s]",  "sve [m/s]", "svd [m/s]"};
  table.decimals = {6, 6, 10, 10, 4, 5, 5, 5, 3, 3, 3, 4, 4, 4};
  table.rows = fixes.size();
  table.cell = [&](std::size_t row, std::size_t column) {
    const GnssFix& fix = fixes[row];
    const Geodetic place = to_geodetic(fix.position_ecef_m);
    const Vector3 v =
        ned_axes(place.latitude_rad, place.longitude_rad).transpose() * fix.velocity_ecef_m_s.value_or(Vector3::Zero());
    const double cells[] = {fix.arrival_s,
                            fix.validity_s,
                            place.latitude_rad / kDegree,
                            place.longitude_rad / kDegree,
                            place.height_m,
                            v.x(),
                            v.y(),
                            v.z(),
                            fix.position_sd_m.x(),
                            fix.position_sd_m.y(),
                            fix.position_sd_m.z(),
                            fix.velocity_sd_m_s.x(),
                            fix.velocity_sd_m_s.y(),
                            fix.velocity_sd_m_s.z()};
    return cells[column];
  };
  return write_table(flags.gnss, table);
}

Status write_truth(const Flags& flags, const Trajectory& truth) {
  TableFile table;
  table.comment = provenance(flags) + "; truth";
  table.columns = {"t [s]",    "lat [deg]", "lon [deg]",  "height [m]",  "vn [m/s]",
                   "ve [m/s]", "vd [m/s]",  "roll [deg]", "pitch [deg]", "yaw [deg]"};
  table.decimals = {6, 11, 11, 5, 6, 6, 6, 7, 7, 7};
  table.rows = truth.states.size();
  table.cell = [&](std::size_t row, std::size_t column) {
    const NavigationState& state = truth.states[row];
    const Geodetic place = to_geodetic(state.position_ecef_m);
    const Matrix3 axes = ned_axes(place.latitude_rad, place.longitude_rad);
    const Vector3 v = axes.transpose() * state.velocity_ecef_m_s;
    const EulerAngles angles = to_euler(Quaternion(axes).conjugate() * state.attitude);
    const double cells[] = {static_cast<double>(row) * truth.dt_s,
                            place.latitude_rad / kDegree,
                            place.longitude_rad / kDegree,
                            place.height_m,
                            v.x(),
                            v.y(),
                            v.z(),
                            angles.roll_rad / kDegree,
                            angles.pitch_rad / kDegree,
                            angles.heading_rad / kDegree};
    return cells[column];
  };
  return write_table(flags.truth, table);
}

/// All axes along a drive, with fixes and truth.
Exit simulate_drive(const Flags& flags) {
  auto scenario = read_scenario(flags.scenario);
  if (!scenario) {
    return complain(scenario.error());
  }
  auto experiment = OutageExperiment::make(*scenario);
  if (!experiment) {
    return complain(experiment.error());
  }
  const Trajectory& truth = experiment->truth();
  Status written = write_imu(
      flags, truth, simulate_imu(truth.imu, truth.dt_s, scenario->truth, scenario->hardware, flags.seed, flags.run));
  if (written && !flags.gnss.empty()) {
    written = write_gnss(flags, experiment->fixes(flags.seed, flags.run));
  }
  if (written && !flags.truth.empty()) {
    written = write_truth(flags, truth);
  }
  return written ? Exit::Success : complain(written.error());
}

Exit run(const Flags& flags) {
  if (!flags.scenario.empty()) {
    return simulate_drive(flags);
  }
  if (!flags.model.empty()) {
    return simulate_model(
        {flags.model, flags.channel, flags.condition, flags.rate_hz, flags.duration_s, flags.seed, flags.out});
  }
  return simulate_axis_file(flags);
}

}  // namespace

void add_simulate(CLI::App& app, Command& chosen) {
  CLI::App* const command = app.add_subcommand(
      "simulate", "Write a recording simulated from an error model, of one axis or of a whole drive");
  const auto flags = std::make_shared<Flags>();
  command->add_option("--preset", flags->preset, "Published model: iphone5s-z (Radi et al. 2017, Table 4)")
      ->capture_default_str();
  command->add_option("--model", flags->model,
                      "JSON file in place of a preset: a model with its effects, an investigation's report, a fit");
  command->add_option("--channel", flags->channel, "Column of the model (its first)");
  command->add_option("--condition", flags->condition, "Dynamic condition of the source's table")
      ->capture_default_str();
  command->add_option("--rate-hz", flags->rate_hz, "Sampling rate")->check(CLI::Range(0.1, 1e5))->capture_default_str();
  command->add_option("--duration-s", flags->duration_s, "Length")->check(CLI::Range(1.0, 1e6))->capture_default_str();
  command->add_option("--seed", flags->seed, "Same seed, same recording")->capture_default_str();
  command->add_option("--out", flags->out, "File to write: .npy, or else CSV")->required();
  command->add_option("--scenario", flags->scenario,
                      "Inertial unit along the drive of a scenario (see outages) in place of one axis");
  command->add_option("--run", flags->run, "Which Monte Carlo run of the scenario")->capture_default_str();
  command->add_option("--gnss", flags->gnss, "File for the scenario's fixes");
  command->add_option("--truth", flags->truth, "File for the scenario's true trajectory");
  command->callback([flags, &chosen] { chosen = [flags] { return run(*flags); }; });
}

}  // namespace driftlab::cli
