/// The tables of a simulated drive: readings, fixes and truth, in the units of their column names.
#include "core/analysis/simulate.hpp"
#include "core/navigate/outage_runs.hpp"
#include "core/signal/angle.hpp"

namespace driftlab {
namespace {

SampleTable imu_table(const Trajectory& truth, const ImuRun& run) {
  SampleTable table;
  table.columns = {"t [s]", "gx [deg/s]", "gy [deg/s]", "gz [deg/s]", "fx [m/s^2]", "fy [m/s^2]", "fz [m/s^2]"};
  table.decimals = {6, 9, 9, 9, 9, 9, 9};
  table.values.reserve(run.readings.size() * table.columns.size());
  for (std::size_t row = 0; row < run.readings.size(); ++row) {
    const ImuSample& reading = run.readings[row];
    table.values.push_back(static_cast<double>(row + 1) * truth.dt_s);
    for (std::size_t channel = 0; channel < kImuChannels; ++channel) {
      table.values.push_back(channel < 3 ? reading[channel] / kDegree : reading[channel]);
    }
  }
  return table;
}

SampleTable fixes_table(const std::vector<GnssFix>& fixes) {
  SampleTable table;
  table.columns = {"t [s]",    "validity [s]", "lat [deg]", "lon [deg]", "height [m]", "vn [m/s]",  "ve [m/s]",
                   "vd [m/s]", "sn [m]",       "se [m]",    "sd [m]",    "svn [m/s]",  "sve [m/s]", "svd [m/s]"};
  table.decimals = {6, 6, 10, 10, 4, 5, 5, 5, 3, 3, 3, 4, 4, 4};
  for (const GnssFix& fix : fixes) {
    const Geodetic place = to_geodetic(fix.position_ecef_m);
    const Vector3 v =
        ned_axes(place.latitude_rad, place.longitude_rad).transpose() * fix.velocity_ecef_m_s.value_or(Vector3::Zero());
    table.values.insert(
        table.values.end(),
        {fix.arrival_s, fix.validity_s, place.latitude_rad / kDegree, place.longitude_rad / kDegree, place.height_m,
         v.x(), v.y(), v.z(), fix.position_sd_m.x(), fix.position_sd_m.y(), fix.position_sd_m.z(),
         fix.velocity_sd_m_s.x(), fix.velocity_sd_m_s.y(), fix.velocity_sd_m_s.z()});
  }
  return table;
}

SampleTable truth_table(const Trajectory& truth) {
  SampleTable table;
  table.columns = {"t [s]",    "lat [deg]", "lon [deg]",  "height [m]",  "vn [m/s]",
                   "ve [m/s]", "vd [m/s]",  "roll [deg]", "pitch [deg]", "yaw [deg]"};
  table.decimals = {6, 11, 11, 5, 6, 6, 6, 7, 7, 7};
  for (std::size_t row = 0; row < truth.states.size(); ++row) {
    const NavigationState& state = truth.states[row];
    const Geodetic place = to_geodetic(state.position_ecef_m);
    const Matrix3 axes = ned_axes(place.latitude_rad, place.longitude_rad);
    const Vector3 v = axes.transpose() * state.velocity_ecef_m_s;
    const EulerAngles angles = to_euler(Quaternion(axes).conjugate() * state.attitude);
    table.values.insert(table.values.end(),
                        {static_cast<double>(row) * truth.dt_s, place.latitude_rad / kDegree,
                         place.longitude_rad / kDegree, place.height_m, v.x(), v.y(), v.z(), angles.roll_rad / kDegree,
                         angles.pitch_rad / kDegree, angles.heading_rad / kDegree});
  }
  return table;
}

}  // namespace

Result<SimulatedDrive> simulate_drive(const DriveSimulation& wanted) {
  const OutageScenario& scenario = wanted.scenario;
  auto experiment = OutageExperiment::make(scenario);
  if (!experiment) {
    return fail(experiment.error());
  }
  const Trajectory& truth = experiment->truth();
  SimulatedDrive drive;
  drive.imu =
      imu_table(truth, simulate_imu(truth.imu, truth.dt_s, scenario.truth, scenario.hardware, wanted.seed, wanted.run));
  if (wanted.fixes) {
    drive.fixes = fixes_table(experiment->fixes(wanted.seed, wanted.run));
  }
  if (wanted.truth) {
    drive.truth = truth_table(truth);
  }
  return drive;
}

}  // namespace driftlab
