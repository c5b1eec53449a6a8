#pragma once
/// One run of the navigation filter over a recorded drive, with outages.
///
/// Every fix is dated to its own moment: position and velocity of a fix are two measurements, each applied at the first
/// sample that ends after the moment it describes and carried back by the time between. (Fixes that are applied at the
/// end of the sample, as if taken then, are up to one sample late: 15 cm at 15 m/s and 100 Hz, a sawtooth that doubles
/// the uncertainty of everything that is found from the innovations.)
///
/// A fix is withheld from an outage if its stamp or a moment that it describes lies in [start, end). A withheld fix has
/// no effect: the result is the same to the bit as with a file that lacks it.
///
/// At the end of an outage, before the first returning fix, the antenna's estimate is compared with the reference.
#include "core/navigate/drive/drive_outage.hpp"
#include "core/navigate/drive/filter_options.hpp"
#include "core/navigate/drive/start.hpp"
#include "core/navigate/drive/vibration.hpp"
#include "core/navigate/recorded_motion.hpp"

#include <array>
#include <functional>

namespace driftlab::drive {

enum class MeasurementKind { Position, Velocity, Constraint, ZeroVelocity, Odometer, ZeroTurn };

/// The innovations of one measurement: scalars, each given those before it.
struct Innovation {
  double time_s = 0.0;  ///< of the moment described, on the drive's clock
  MeasurementKind kind = MeasurementKind::Position;
  int count = 0;
  std::array<ScalarInnovation, 3> scalar{};  ///< north, east, down; right, down
  bool accepted = true;
};

struct FilterRun {
  std::vector<DriveOutage> outages;
  std::vector<Innovation> innovations;
  std::vector<RecordedPose> poses;        ///< after every fix; empty unless asked for
  std::optional<double> heading_known_s;  ///< when the heading's standard deviation fell below 1 deg
  std::size_t rejected = 0;
};

/// Values that a constraint measures in place of zero, for simulated drives: (right, down) by reading.
using SideSlip = std::function<std::array<double, 2>(std::size_t reading)>;

class FilterTape;

struct FilterTask {
  std::vector<Outage> outages;  ///< by time, apart
  std::size_t phase = 0;
  bool keep_innovations = false;
  bool keep_poses = false;
  const SideSlip* slip = nullptr;
  FilterTape* tape = nullptr;            ///< for the way back (smoother.hpp)
  const Vibration* vibration = nullptr;  ///< of the readings, where the options know that noise follows it
};

/// A filter design for a drive's model under the options. Errors: those of FilterDesign::make.
[[nodiscard]] Result<FilterDesign> make_design(const Document& document, double dt_s, const Start& start,
                                               const FilterOptions& options);

/// Runs the filter from `start` to the end of its run. `readings` are those of the run with the options' errors taken
/// off (corrected_readings). Deterministic. About a microsecond a reading.
[[nodiscard]] FilterRun run_filter(const Drive& drive, const Start& start, std::span<const ImuSample> readings,
                                   const FilterDesign& design, const FilterOptions& options, const FilterTask& task);

}  // namespace driftlab::drive
