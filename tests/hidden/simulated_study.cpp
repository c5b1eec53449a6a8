#include "tests/hidden/simulated_study.hpp"

#include "core/investigate/slow/slow_fit.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace driftlab::hidden {
namespace {

using investigate::ChannelGroup;
using investigate::Draft;
using investigate::SlowComponent;
using investigate::StudyRecording;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Motion {
  std::string id;
  Condition condition;
  std::vector<double> rate;  ///< about z, for a profile
  std::vector<double> temperature;
  std::array<std::vector<double>, 3> force;
};

Condition constant_rate(double deg_s) {
  Condition condition;
  condition.kind = ConditionKind::ConstantRate;
  condition.axis = "z";
  condition.value = deg_s * kDegree;
  condition.unit = "deg/s";
  return condition;
}

Condition of_kind(ConditionKind kind) {
  Condition condition;
  condition.kind = kind;
  return condition;
}

/// A smooth turn of several sinusoids up to 200 deg/s.
std::vector<double> draw_profile(Random& random, std::size_t samples, double dt) {
  std::vector<double> rate(samples, 0.0);
  for (int k = 0; k < 6; ++k) {
    const double f = 0.005 * std::pow(60.0, random.uniform());
    const double phase = 2.0 * std::numbers::pi * random.uniform();
    const double level = (20.0 + 30.0 * random.uniform()) * kDegree;
    for (std::size_t i = 0; i < samples; ++i) {
      const double t = static_cast<double>(i) * dt;
      rate[i] += level * (std::sin(2.0 * std::numbers::pi * f * t + phase) - std::sin(phase));
    }
  }
  return rate;
}

std::vector<Motion> draw_motions(const World& world, Random& random) {
  const auto samples = static_cast<std::size_t>(world.duration_s * world.rate_hz);
  const double dt = 1.0 / world.rate_hz;
  std::vector<Motion> motions;
  const auto add = [&](std::string id, Condition condition) -> Motion& {
    motions.push_back({std::move(id), std::move(condition), {}, {}, {}});
    return motions.back();
  };
  add("static-1", of_kind(ConditionKind::Static));
  switch (world.scenario) {
    case Scenario::Static:
      add("static-2", of_kind(ConditionKind::Static));
      if (random.uniform() < 0.5) {
        add("static-3", of_kind(ConditionKind::Static));
      }
      break;
    case Scenario::Rates:
    case Scenario::TwoAxes:
    case Scenario::Turning: {
      for (const double rate : {18.0, -36.0, 72.0, 120.0}) {
        add("rate-" + std::to_string(static_cast<int>(rate)), constant_rate(rate));
      }
      Condition ramp = constant_rate(0.0);
      ramp.kind = ConditionKind::ConstantAngularAcceleration;
      ramp.value = 1.0 * kDegree;
      ramp.unit = "deg/s^2";
      add("ramp-1", ramp);
      break;
    }
    case Scenario::Profile:
      for (int k = 1; k < 3; ++k) {
        add("profile-" + std::to_string(k), of_kind(ConditionKind::Profile)).rate = draw_profile(random, samples, dt);
      }
      break;
    case Scenario::Shake: {
      Motion& shake = add("shake-1", of_kind(ConditionKind::Profile));
      shake.rate.assign(samples, 0.0);
      for (Motion& motion : motions) {
        auto& f = motion.force[2];
        f.resize(samples);
        for (std::size_t i = 0; i < samples; ++i) {
          const double burst =
              &motion == &motions[1]
                  ? 2.0 * std::pow(std::max(0.0, std::sin(0.02 * dt * static_cast<double>(i) * 2.0 * std::numbers::pi)),
                                   2.0)
                  : 0.0;
          f[i] = kStandardGravity + (0.03 + burst) * random.normal();
        }
      }
      break;
    }
    case Scenario::SixPosition:
      motions.clear();
      for (int k = 0; k < 6; ++k) {
        Condition condition = of_kind(ConditionKind::SixPosition);
        condition.axis = std::string(1, static_cast<char>('x' + k / 2));
        condition.up = k % 2 == 0;
        Motion& motion = add("six-" + condition.axis + (k % 2 == 0 ? "-up" : "-down"), condition);
        for (int axis = 0; axis < 3; ++axis) {
          auto& f = motion.force[static_cast<std::size_t>(axis)];
          f.resize(samples);
          for (double& v : f) {
            v = (axis == k / 2 ? (k % 2 == 0 ? 1.0 : -1.0) * kStandardGravity : 0.0) + 0.03 * random.normal();
          }
        }
      }
      break;
    case Scenario::Temperature:
      add("static-2", of_kind(ConditionKind::Static));
      for (Motion& motion : motions) {
        motion.temperature.resize(samples);
        const double period = (0.5 + random.uniform()) * world.duration_s;
        const double phase = 6.28 * random.uniform();
        for (std::size_t i = 0; i < samples; ++i) {
          const double t = static_cast<double>(i) * dt;
          motion.temperature[i] =
              300.0 + 6.0 * std::sin(2.0 * std::numbers::pi * t / period + phase) + 4.0 * t / world.duration_s;
        }
      }
      break;
    case Scenario::Headings:
      for (int k = 1; k < 6; ++k) {
        add("static-" + std::to_string(k + 1), of_kind(ConditionKind::Static));
      }
      for (std::size_t k = 0; k < motions.size(); ++k) {
        motions[k].condition.heading_deg = 60.0 * static_cast<double>(k);
      }
      break;
    case Scenario::Axes:
      break;
  }
  return motions;
}

std::vector<std::string> axes_of(const World& world) {
  switch (world.scenario) {
    case Scenario::Axes:
      return {"x", "y", "z"};
    case Scenario::TwoAxes:
      return {"x", "z"};
    case Scenario::Turning:
      return {"x", "y"};
    default:
      return {"z"};
  }
}

/// Writes the columns of one recording and reads them as the product does.
StudyRecording write_and_read(const World& world, const Motion& motion, const std::vector<std::string>& axes,
                              const std::vector<std::vector<double>>& output, const Draft& timing,
                              std::deque<std::vector<double>>& memory) {
  const bool accelerometer = world.accelerometer || world.scenario == Scenario::Turning;
  RecordingSpec spec;
  spec.id = motion.id;
  spec.rate_hz = world.rate_hz;
  spec.condition = motion.condition;
  ColumnNames names;
  std::vector<std::size_t> place;
  const auto add = [&](const std::string& name, Quantity quantity, const std::string& axis, const char* unit,
                       const std::vector<double>& si) {
    const Unit u = *parse_unit(unit);
    std::vector<double> column;
    for (std::size_t i = 0; i < si.size(); ++i) {
      if (timing.present.empty() || timing.present[i] != 0) {
        column.push_back(u.from_si(si[i]));
      }
    }
    names.push_back(name);
    spec.columns[name] = {quantity, axis, u};
    place.push_back(memory.size());
    memory.push_back(std::move(column));
  };
  std::vector<double> stamps(output[0].size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    stamps[i] = static_cast<double>(i) / world.rate_hz + (timing.stamp_error_s.empty() ? 0.0 : timing.stamp_error_s[i]);
    stamps[i] = std::max(stamps[i], i > 0 ? stamps[i - 1] : stamps[i]);
  }
  add("t", Quantity::Time, "", "s", stamps);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    add((accelerometer ? "f" : "g") + axes[a], accelerometer ? Quantity::SpecificForce : Quantity::AngularRate, axes[a],
        accelerometer ? "m/s^2" : "deg/s", output[a]);
  }
  if (!motion.rate.empty()) {
    std::vector<double> told = motion.rate;
    for (std::size_t i = 0; i < timing.reference.size(); ++i) {
      told[i] += timing.reference[i];
    }
    add("rz", Quantity::ReferenceAngularRate, "z", "deg/s", told);
  }
  if (!motion.temperature.empty()) {
    add("temp", Quantity::Temperature, "", "degC", motion.temperature);
  }
  for (std::size_t k = 0; k < 3 && !accelerometer; ++k) {
    if (!motion.force[k].empty()) {
      const std::string axis(1, static_cast<char>('x' + k));
      add("f" + axis, Quantity::SpecificForce, axis, "m/s^2", motion.force[k]);
    }
  }
  auto recording = investigate::make_study_recording(
      spec, names, memory[place[0]].size(), [&](std::size_t i) { return std::span<const double>(memory[place[i]]); });
  return recording ? std::move(*recording) : StudyRecording{};
}

}  // namespace

BaseModel draw_base(Random& random, bool accelerometer) {
  const double unit = accelerometer ? 0.05 : kDegree;
  BaseModel base;
  base.n = (0.015 + 0.035 * random.uniform()) * unit;
  const auto kinds = random.below(5);
  base.name = "WN";
  if (kinds >= 1) {
    const double sigma = (0.02 + 0.02 * random.uniform()) * unit;
    base.slow.push_back({{&registered<GaussMarkov>(), {sigma, 0.02 * std::pow(80.0, random.uniform())}}, {}});
    base.name += "+GM";
  }
  if (kinds >= 3) {
    const double sigma = (0.02 + 0.02 * random.uniform()) * unit;
    base.slow.push_back({{&registered<GaussMarkov>(), {sigma, 0.01 + 0.02 * random.uniform()}}, {}});
    base.name = "WN+2GM";
  }
  if (kinds == 2 || kinds == 4) {
    base.slow.push_back({{&registered<RandomWalk>(), {(2e-4 + 6e-4 * random.uniform()) * unit}}, {}});
    base.name += "+RW";
  }
  return base;
}

SimulatedStudy simulate_study(const World& world, const std::vector<Hidden>& effects) {
  SimulatedStudy result;
  Random random(world.seed, 0);
  const bool accelerometer = world.accelerometer || world.scenario == Scenario::Turning;
  result.base = draw_base(random, accelerometer);
  const std::vector<Motion> motions = draw_motions(world, random);
  const std::vector<std::string> axes = axes_of(world);
  const double dt = 1.0 / world.rate_hz;
  const double bias = 0.3 * random.normal() * (accelerometer ? 0.05 : kDegree);
  if (world.replicate != 0) {
    random = Random(world.seed, world.replicate);
  }
  for (std::size_t m = 0; m < motions.size(); ++m) {
    const Motion& motion = motions[m];
    const auto samples = static_cast<std::size_t>(world.duration_s * world.rate_hz);
    std::vector<std::vector<double>> blank(axes.size(), std::vector<double>(samples, 0.0));
    std::deque<std::vector<double>> scratch;
    Draft timing;
    StudyRecording truth = write_and_read(world, motion, axes, blank, timing, scratch);
    std::vector<double> shared(samples);
    for (double& v : shared) {
      v = random.normal();
    }
    std::vector<std::vector<double>> output;
    for (const std::string& axis : axes) {
      ChannelGroup group;
      group.role.axis = axis;
      group.role.quantity = accelerometer ? Quantity::SpecificForce : Quantity::AngularRate;
      Draft draft;
      draft.recording = &truth;
      draft.group = &group;
      draft.number = m;
      draft.shared = shared;
      draft.white.resize(samples);
      draft.slow.assign(samples, 0.0);
      draft.mean.assign(samples, bias);
      for (double& v : draft.white) {
        v = result.base.n / std::sqrt(dt) * random.normal();
      }
      for (const SlowComponent& component : result.base.slow) {
        component.process.add_path(random, dt, draft.slow);
      }
      for (const Hidden& effect : effects) {
        const bool here = effect.recordings.empty() ||
                          std::find(effect.recordings.begin(), effect.recordings.end(), m) != effect.recordings.end();
        const investigate::Cause& cause = *investigate::find_cause(effect.cause);
        const bool this_axis = cause.showing.axis.empty() || axis == cause.showing.axis;
        if (here && this_axis) {
          investigate::inject(cause, draft, effect.values, random);
        }
      }
      const auto k = investigate::axis_index(axis).value_or(2);
      std::vector<double> out(samples);
      for (std::size_t i = 0; i < samples; ++i) {
        out[i] = draft.white[i] + draft.slow[i] + draft.mean[i] +
                 (accelerometer           ? 0.0
                  : truth.rate[k].empty() ? 0.0
                                          : truth.rate[k][i]);
      }
      for (const auto& step : draft.output) {
        step(out);
      }
      // Decimals as a file has them: far below the noise.
      const double decimals = accelerometer ? 1e-5 : 1e-5 * kDegree;
      for (double& v : out) {
        v = decimals * std::round(v / decimals);
      }
      output.push_back(std::move(out));
      timing.present = draft.present;
      timing.stamp_error_s = draft.stamp_error_s;
      timing.reference = draft.reference;
    }
    result.study.recordings.push_back(write_and_read(world, motion, axes, output, timing, result.memory));
  }
  result.study.id = "simulated";
  if (world.given) {
    result.study.baseline.automatic = false;
    result.study.baseline.quantity = accelerometer ? Quantity::SpecificForce : Quantity::AngularRate;
    auto& processes = result.study.baseline.processes;
    processes.push_back(*make_process("white_noise", {result.base.n}));
    for (const SlowComponent& component : result.base.slow) {
      processes.push_back(component.process);
    }
  }
  investigate::settle_channels(result.study);
  return result;
}

}  // namespace driftlab::hidden
