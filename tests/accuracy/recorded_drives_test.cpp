// Causes put into a recorded drive and sought again; what arm and clock a search finds where both are known.
#include "core/navigate/drive/profile.hpp"
#include "core/navigate/drive/simulation.hpp"
#include "tests/accuracy/section.hpp"
#include "tests/unit/navigate/recorded_car.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace driftlab::accuracy {
namespace {

using drive::Drive;
using drive::FilterOptions;
using drive::Fix;

/// The options that the recording's own search ends at, from the delay that the fixes show.
FilterOptions refitted(const Drive& recorded, bool constraint) {
  FilterOptions options = options_of(recorded.document);
  if (constraint) {
    options.constraint.emplace();
  }
  if (const auto delay = drive::delay_from_fixes(recorded.fixes)) {
    options.velocity_latency_s = delay->delay_s;
  }
  const auto found = drive::search_causes(recorded, options, 10);
  EXPECT_TRUE(found) << found.error().message;
  return found ? found->options : options;
}

/// The velocity of the fixes at a moment: cubic between four of them.
std::optional<Vector3> velocity_at(const std::vector<Fix>& fixes, double time_s) {
  const auto after = std::find_if(fixes.begin(), fixes.end(), [&](const Fix& fix) { return fix.time_s >= time_s; });
  const auto i = after - fixes.begin();
  if (i < 2 || i + 1 >= static_cast<std::ptrdiff_t>(fixes.size())) {
    return std::nullopt;
  }
  Vector3 sum = Vector3::Zero();
  for (std::ptrdiff_t j = i - 2; j < i + 2; ++j) {
    const Fix& own = fixes[static_cast<std::size_t>(j)];
    if (!own.velocity_ned_m_s || std::abs(own.time_s - time_s) > 1.6) {
      return std::nullopt;
    }
    double weight = 1.0;
    for (std::ptrdiff_t k = i - 2; k < i + 2; ++k) {
      const double other = fixes[static_cast<std::size_t>(k)].time_s;
      weight *= k == j ? 1.0 : (time_s - other) / (own.time_s - other);
    }
    sum += weight * *own.velocity_ned_m_s;
  }
  return sum;
}

void delay_velocities(Drive& changed, double by_s) {
  const std::vector<Fix> recorded = changed.fixes;
  for (Fix& fix : changed.fixes) {
    if (const auto earlier = velocity_at(recorded, fix.time_s - by_s)) {
      fix.velocity_ned_m_s = *earlier;
    }
  }
}

/// The antenna `arm` further from the unit, by the attitude that the filter finds and the rate that the unit reads.
void move_antenna(Drive& changed, const FilterOptions& options, const Vector3& arm) {
  const auto prepared = drive::PreparedDrive::make(changed, options);
  ASSERT_TRUE(prepared);
  drive::FilterTask task;
  task.keep_poses = true;
  const auto poses = prepared->run(0, task).poses;
  const drive::UniformRun& run = changed.runs.front();
  for (Fix& fix : changed.fixes) {
    const double own_s = fix.time_s - options.imu_offset_s;
    const auto pose = std::min_element(poses.begin(), poses.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.time_s - own_s) < std::abs(b.time_s - own_s);
    });
    const Quaternion attitude = from_euler(pose->attitude);
    const auto rate_at = [&](double time_s) {
      const auto middle = static_cast<std::ptrdiff_t>((time_s - options.imu_offset_s - run.start_s) / run.dt_s);
      Vector3 mean = Vector3::Zero();
      for (std::ptrdiff_t i = middle - 5; i < middle + 5; ++i) {
        const auto at = static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(i, 0, static_cast<std::ptrdiff_t>(run.readings.size()) - 1));
        mean += 0.1 * Vector3(run.readings[at][0], run.readings[at][1], run.readings[at][2]);
      }
      return mean;
    };
    fix.position_ecef_m += ned_axes(fix.position_ecef_m) * (attitude * arm);
    if (fix.velocity_ned_m_s) {
      *fix.velocity_ned_m_s += attitude * rate_at(fix.time_s - options.velocity_latency_s).cross(arm);
    }
  }
}

void turn_unit(Drive& changed, const Matrix3& by, const Matrix3& gyroscope, const Matrix3& accelerometer) {
  for (drive::UniformRun& run : changed.runs) {
    for (ImuSample& sample : run.readings) {
      const Vector3 rate =
          by * (Vector3(sample[0], sample[1], sample[2]) + gyroscope * Vector3(sample[0], sample[1], sample[2]));
      const Vector3 force =
          by * (Vector3(sample[3], sample[4], sample[5]) + accelerometer * Vector3(sample[3], sample[4], sample[5]));
      sample = {rate.x(), rate.y(), rate.z(), force.x(), force.y(), force.z()};
    }
  }
}

Matrix3 single(int row, int column, double value) {
  Matrix3 matrix = Matrix3::Zero();
  matrix(row, column) = value;
  return matrix;
}

struct Injected {
  const char* cause;
  const char* parameter;
  double size;  ///< SI
  bool constraint;
  std::function<void(Drive& changed, const FilterOptions& options, double size)> put;
};

std::vector<Injected> injections() {
  const Matrix3 one = Matrix3::Identity();
  const Matrix3 none = Matrix3::Zero();
  return {
      {"imu_time_offset", "delta_s", 0.030, false,
       [](Drive& d, const FilterOptions&, double by) { d.runs.front().start_s -= by; }},
      {"gnss_velocity_latency", "delay_s", 0.060, false,
       [](Drive& d, const FilterOptions&, double by) { delay_velocities(d, by); }},
      {"gnss_lever_arm", "x", 0.4, false,
       [](Drive& d, const FilterOptions& o, double by) { move_antenna(d, o, {by, 0.0, 0.0}); }},
      {"gnss_lever_arm", "y", 0.4, false,
       [](Drive& d, const FilterOptions& o, double by) { move_antenna(d, o, {0.0, by, 0.0}); }},
      {"gyro_scale_factor_error", "z", 0.02, false,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, single(2, 2, by), none); }},
      {"gyro_axis_misalignment", "xz", 0.02, false,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, single(0, 2, by), none); }},
      {"accelerometer_scale_factor_error", "x", 0.04, false,
       [=](Drive& d, const FilterOptions&, double by) { turn_unit(d, one, none, single(0, 0, by)); }},
      {"mounting_angles", "yaw", 2.0 * kDegree, true,
       [=](Drive& d, const FilterOptions&, double by) {
         turn_unit(d, Eigen::AngleAxisd(by, Vector3::UnitZ()).toRotationMatrix(), none, none);
       }},
      {"mounting_angles", "pitch", 2.0 * kDegree, true,
       [=](Drive& d, const FilterOptions&, double by) {
         turn_unit(d, Eigen::AngleAxisd(by, Vector3::UnitY()).toRotationMatrix(), none, none);
       }},
  };
}

}  // namespace

TEST(Accuracy, CausesPutIntoARecordedDriveAreNamedFirst) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_drives");
  section.print(
      "\n## Causes put into a recorded drive\n\nrtk-car-0708 with the values that its own search ends at; one cause is "
      "put into readings or fixes, and the search goes on from there.\n\n| put in | found first | value | se | score "
      "|\n|---|---|---|---|---|\n");
  for (const bool constraint : {false, true}) {
    const FilterOptions base = refitted(*recorded, constraint);
    const auto nothing = drive::search_causes(*recorded, base, 1);
    ASSERT_TRUE(nothing);
    const std::string suffix = constraint ? " (velocity constraints)" : "";
    if (nothing->findings.empty()) {
      section.print("| nothing%s | nothing | | | |\n", suffix.c_str());
    } else {
      const auto& first = nothing->findings.front();
      section.print("| nothing%s | %s (%s) | | %.3g %s | %.0f |\n", suffix.c_str(), first.cause.c_str(),
                    first.parameter.c_str(), first.se, first.unit.c_str(), first.score);
    }
    for (const Injected& one : injections()) {
      if (one.constraint != constraint) {
        continue;
      }
      Drive changed = *recorded;
      one.put(changed, base, one.size);
      const auto found = drive::search_causes(changed, base, 1);
      ASSERT_TRUE(found);
      const drive::Knob* const knob = drive::find_knob(one.cause, one.parameter);
      ASSERT_NE(knob, nullptr) << one.cause;
      const double put = one.size * knob->per_si;
      if (found->findings.empty()) {
        section.print("| %s (%s) %.3g %s%s | nothing | | | |\n", one.cause, one.parameter, put,
                      std::string(knob->unit).c_str(), suffix.c_str());
        ADD_FAILURE() << one.cause << " " << one.parameter;
        continue;
      }
      const auto& first = found->findings.front();
      const drive::Knob* const named = drive::find_knob(first.cause, first.parameter);
      const double change = first.value - named->value(base) * named->per_si;
      section.print("| %s (%s) %.3g %s%s | %s (%s)%s | %.3g %s | %.2g | %.0f |\n", one.cause, one.parameter, put,
                    std::string(knob->unit).c_str(), suffix.c_str(), first.cause.c_str(), first.parameter.c_str(),
                    first.pair.empty() ? "" : (" or " + first.pair).c_str(), change, first.unit.c_str(), first.se,
                    first.score);
      EXPECT_TRUE(first.cause == one.cause && first.parameter == one.parameter)
          << one.cause << " " << one.parameter << " came out as " << first.cause << " " << first.parameter;
      EXPECT_LT(std::abs(change - put), std::max(0.2 * put, 3.0 * first.se)) << one.cause << " " << one.parameter;
    }
  }
}

/// What a search for clock, velocities' delay and arm ends at, on drives simulated along the recording's path with an
/// arm of 0.59 m, and with what a filter could mistake for another arm.
TEST(Accuracy, TheArmOfADriveAlongTheRecordedPathIsFound) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_arm");
  FilterOptions base = refitted(*recorded, false);
  base.imu_offset_s = -0.133;
  base.lever_arm_m = Vector3(0.59, 0.0, 0.0);
  const auto prepared = drive::PreparedDrive::make(*recorded, base);
  ASSERT_TRUE(prepared);
  const auto world = drive::SimulatedWorld::make(*prepared, 0);
  ASSERT_TRUE(world) << world.error().message;
  section.print(
      "\n| simulated along the path, arm 0.59 m, clock 0 s | arm x [m] | se | clock [s] | se "
      "|\n|---|---|---|---|---|\n");
  const std::vector<const drive::Knob*> knobs{
      drive::find_knob("imu_time_offset", "delta_s"), drive::find_knob("gnss_lever_arm", "x"),
      drive::find_knob("gnss_lever_arm", "y"), drive::find_knob("gnss_velocity_latency", "delay_s")};
  struct Case {
    const char* name;
    double gyro_late_s, mean_velocity_s;
    bool must_find;
  };
  for (const Case& one :
       {Case{"as the filter believes", 0.0, 0.0, true}, Case{"velocities are means over 0.25 s", 0.0, 0.25, false},
        Case{"gyroscope 50 ms later than accelerometer", 0.05, 0.0, false},
        Case{"gyroscope 50 ms earlier", -0.05, 0.0, false}}) {
    auto drawn = world->draw(7, 0);
    Drive simulated = std::move(drawn.drive);
    drive::UniformRun& run = simulated.runs.front();
    if (one.gyro_late_s != 0.0) {
      const auto shift = static_cast<std::ptrdiff_t>(std::lround(one.gyro_late_s / run.dt_s));
      const auto readings = run.readings;
      for (std::ptrdiff_t i = 0; i < static_cast<std::ptrdiff_t>(readings.size()); ++i) {
        const auto from = std::clamp<std::ptrdiff_t>(i - shift, 0, static_cast<std::ptrdiff_t>(readings.size()) - 1);
        for (std::size_t c = 0; c < 3; ++c) {
          run.readings[static_cast<std::size_t>(i)][c] = readings[static_cast<std::size_t>(from)][c];
        }
      }
    }
    if (one.mean_velocity_s > 0.0) {
      const std::vector<Fix> exact = simulated.fixes;
      for (Fix& fix : simulated.fixes) {
        Vector3 sum = Vector3::Zero();
        int count = 0;
        for (int k = 0; k < 5; ++k) {
          if (const auto at = velocity_at(exact, fix.time_s - one.mean_velocity_s * (k + 0.5) / 5.0)) {
            sum += *at;
            ++count;
          }
        }
        if (count == 5) {
          fix.velocity_ned_m_s = sum / 5.0;
        }
      }
    }
    FilterOptions options = world->options();
    options.lever_arm_m.setZero();
    const RunControl control;
    const drive::Profile profile(simulated, {true, true}, control);
    options = profile.refitted(options, knobs, 6);
    const auto last = profile.estimates(options, knobs).knobs;
    section.print("| %s | %.3f | %.3f | %.4f | %.4f |\n", one.name, options.lever_arm_m.x(), last[1].se,
                  options.imu_offset_s, last[0].se);
    if (one.must_find) {
      EXPECT_NEAR(options.lever_arm_m.x(), 0.59, 0.06);
      EXPECT_NEAR(options.imu_offset_s, 0.0, 0.01);
    }
  }
}

// How long a gate that believes the receiver again remembers those that disagreed (core/navigate/drive/fix_gate.hpp).
TEST(Accuracy, TheGatesMemoryDecidesLittleOnARecordedDrive) {
  const auto recorded = drive::recorded_car();
  if (!recorded) {
    GTEST_SKIP();
  }
  Section section("recorded_drives");
  section.print(
      "\n## Memory of the gate\n\nrtk-car-0708, the data sheet's model, gate 25.\n\n| fixes remembered | rejected | "
      "rms "
      "after 10, 30, 60 s [m] |\n|---|---|---|\n");
  double least = std::numeric_limits<double>::infinity();
  double own = 0.0;
  for (const int memory : {5, 15, 60, 240, 1000}) {
    FilterOptions options = drive::options_of(recorded->document);
    options.gate = 25.0;
    options.gate_memory = memory;
    const auto evaluation = drive::evaluate_drive(*recorded, options, {.resamples = 0});
    ASSERT_TRUE(evaluation) << evaluation.error().message;
    const double ten = evaluation->durations.front().rms_m.value;
    section.print("| %d | %zu | %.2f; %.1f; %.0f |\n", memory, evaluation->rejected, ten,
                  evaluation->durations[1].rms_m.value, evaluation->durations[2].rms_m.value);
    least = std::min(least, ten);
    own = memory == FilterOptions{}.gate_memory ? ten : own;
  }
  EXPECT_LT(own, 1.1 * least);
}

}  // namespace driftlab::accuracy
