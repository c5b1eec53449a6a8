/// Sizes of effects: what an oracle that knows base and template would see at about z standard deviations.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace driftlab::hidden {
namespace {

using namespace investigate;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Plan {
  Scenario scenario = Scenario::Static;
  bool given = false;
  bool single = false;  ///< acts in recording 1 only
  bool moving = false;  ///< acts in all but recording 0
};

/// Where each cause can be seen.
Plan plan_of(const std::string& cause, Random& random) {
  static const std::map<std::string, Plan> plans{
      {"white_noise_level", {Scenario::Rates, false, false, true}},
      {"gauss_markov", {Scenario::Static, true, false, false}},
      {"random_walk", {Scenario::Static, true, false, false}},
      {"flicker_noise", {Scenario::Static, true, false, false}},
      {"linear_drift", {Scenario::Static, false, true, false}},
      {"warm_up_transient", {Scenario::Static, false, false, false}},
      {"bias_step", {Scenario::Static, false, true, false}},
      {"quantization_noise", {Scenario::Static, true, false, false}},
      {"noise_level_change", {Scenario::Static, false, true, false}},
      {"turn_on_bias", {Scenario::Rates, false, false, false}},
      {"temperature_bias", {Scenario::Temperature, false, false, false}},
      {"saturation", {Scenario::Profile, false, false, false}},
      {"rate_dependent_noise", {Scenario::Rates, false, false, false}},
      {"acceleration_dependent_noise", {Scenario::Profile, false, false, false}},
      {"scale_factor_error", {Scenario::Rates, false, false, false}},
      {"scale_factor_asymmetry", {Scenario::Profile, false, false, false}},
      {"scale_factor_nonlinearity", {Scenario::Profile, false, false, false}},
      {"axis_misalignment", {Scenario::TwoAxes, false, false, false}},
      {"reference_time_offset", {Scenario::Profile, false, false, false}},
      {"reference_clock_drift", {Scenario::Profile, false, false, false}},
      {"once_per_revolution", {Scenario::Rates, false, false, false}},
      {"g_sensitivity", {Scenario::SixPosition, false, false, false}},
      {"vibration_rectification", {Scenario::Shake, false, false, false}},
      {"lever_arm", {Scenario::Turning, false, false, false}},
      {"common_mode_noise", {Scenario::Axes, false, false, false}},
  };
  const auto it = plans.find(cause);
  Plan plan = it == plans.end() ? Plan{} : it->second;
  if (!plan.given && random.uniform() < 0.4) {
    plan.given = true;
  }
  return plan;
}

/// Standard deviation of the amplitude an oracle would estimate.
double oracle_deviation(const SimulatedStudy& clean, const Cause& cause, double shape, const Plan& plan) {
  double information = 0.0;
  for (const ChannelGroup& group : group_channels(clean.study)) {
    if (cause.name == "axis_misalignment" && group.role.axis != "x") {
      continue;
    }
    const BlockSeries series =
        average_blocks(group, std::vector<std::vector<unsigned char>>(group.members.size()), false);
    BlockColumns columns = BlockColumns::zeros(series, 2);
    std::vector<std::vector<double>> built;
    for (std::size_t r = 0; r < group.members.size(); ++r) {
      const bool here = plan.single ? r == 1 : plan.moving ? r > 0 : true;
      const bool works = cause.mean->build(*group.members[r].recording, group, shape, built);
      const std::vector<double> x = works && here ? average_like(series, r, built[0]) : std::vector<double>{};
      for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
        columns.rows[r][2 * b] = x.empty() ? 0.0 : x[b];
        columns.rows[r][2 * b + 1] = 1.0;
      }
    }
    SlowModel model;
    model.white = clean.base.n * clean.base.n;
    model.components = clean.base.slow;
    information += solve_whitened(whiten(series, model, columns).columns).residual;
  }
  return 1.0 / std::sqrt(information);
}

/// Level of a slow process that an oracle sees at z: 2 E log(p1/p0) = z^2, which for Gaussian series is the sum of
/// 2 (r - 1 - ln r) over the Fourier frequencies of all recordings, r the ratio of the densities with it and without.
double oracle_level(const SimulatedStudy& clean, SlowKind kind, double beta, double z) {
  const StudyRecording& recording = clean.study.recordings.front();
  SlowModel base;
  base.white = clean.base.n * clean.base.n;
  base.components = clean.base.slow;
  SlowModel unit;
  unit.components.push_back({kind, 1.0, beta, {}});
  const auto n = static_cast<double>(recording.count());
  std::vector<double> ratio;  // of the added density at level 1 to the base
  for (double k = 1.0; k < 0.5 * n; k += 1.0) {
    const double f = k / n / recording.dt_s;
    ratio.push_back(slow_density(unit, {}, 0, f, recording.dt_s, n) /
                    (base.white + slow_density(base, {}, 0, f, recording.dt_s, n)));
  }
  const auto seen = [&](double level) {
    double sum = 0.0;
    for (const double r : ratio) {
      sum += 2.0 * (level * r - std::log1p(level * r));
    }
    return sum * static_cast<double>(clean.study.recordings.size());
  };
  double low = -60.0;
  double high = 10.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (seen(std::exp(middle)) < z * z ? low : high) = middle;
  }
  return std::exp(low);
}

double squares_of_driver(const SimulatedStudy& clean, bool acceleration, bool about_mean) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const StudyRecording& recording : clean.study.recordings) {
    for (const double v : acceleration ? recording.acceleration[2] : recording.rate[2]) {
      sum += std::fabs(v);
      square += v * v;
      count += 1.0;
    }
  }
  return about_mean ? square - sum * sum / count : square;
}

}  // namespace

Case make_case(const std::string& name, double z, std::uint64_t seed) {
  Random random(seed, 77);
  const Cause& cause = *find_cause(name);
  const Plan plan = plan_of(name, random);
  Case made;
  made.world.scenario = plan.scenario;
  made.world.given = plan.given;
  made.world.rate_hz = plan.scenario == Scenario::Static ? 50.0 : 25.0;
  made.world.duration_s = 600.0;
  made.world.seed = seed;
  made.effect.cause = name;
  const SimulatedStudy clean = simulate_study(made.world, {});
  const double dt = 1.0 / made.world.rate_hz;
  const auto recordings = clean.study.recordings.size();
  const double each = made.world.duration_s * made.world.rate_hz;
  const double all = each * static_cast<double>(recordings);
  const double sd = clean.base.n / std::sqrt(dt);
  if (plan.single) {
    made.effect.recordings = {1};
  } else if (plan.moving) {
    for (std::size_t r = 1; r < recordings; ++r) {
      made.effect.recordings.push_back(r);
    }
  }
  std::vector<double>& v = made.effect.values;
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  const double duration = made.world.duration_s;
  if (cause.mean != nullptr) {
    double shape = 0.0;
    if (name == "warm_up_transient") {
      shape = 40.0 + 80.0 * random.uniform();
    } else if (name == "bias_step") {
      shape = duration * (0.2 + 0.6 * random.uniform());
    } else if (name == "temperature_bias") {
      shape = 20.0 + 40.0 * random.uniform();
    } else if (name == "scale_factor_nonlinearity" || name == "axis_misalignment") {
      shape = 2.0;
    }
    v = {(cause.mean->free_phase ? 1.0 : sign) * z * oracle_deviation(clean, cause, shape, plan)};
    if (cause.mean->shapes != nullptr || cause.mean->change_point) {
      v.push_back(shape);
    }
  } else if (name == "white_noise_level") {
    v = {clean.base.n *
         (1.0 + z * std::sqrt(0.5 / (each * static_cast<double>(recordings - 1)) + (plan.given ? 0.0 : 0.5 / each)))};
  } else if (name == "gauss_markov") {
    const double beta = 0.2 + 0.3 * random.uniform();
    v = {std::sqrt(oracle_level(clean, SlowKind::GaussMarkov, beta, z)), beta};
  } else if (name == "random_walk") {
    v = {std::sqrt(oracle_level(clean, SlowKind::RandomWalk, 0.0, z))};
  } else if (name == "flicker_noise") {
    v = {std::sqrt(oracle_level(clean, SlowKind::Flicker, 0.0, z))};
  } else if (name == "turn_on_bias") {
    v = {0.003 * z * kDegree};
  } else if (name == "quantization_noise") {
    v = {std::sqrt(z * std::sqrt(1.0 / all)) * sd * dt};
  } else if (name == "rate_dependent_noise" || name == "acceleration_dependent_noise") {
    v = {z / std::sqrt(2.0 * squares_of_driver(clean, name[0] == 'a', !plan.given))};
  } else if (name == "noise_level_change") {
    v = {1.0 + z * std::sqrt(1.0 / each), duration * (0.3 + 0.4 * random.uniform())};
  } else if (name == "heavy_tailed_noise") {
    v = {4.0 + 6.0 / (z * std::sqrt(24.0 / all))};
  } else if (name == "outliers") {
    v = {0.1 * z * z / all, 6.0 * sd};
  } else if (name == "common_mode_noise") {
    v = {z / std::sqrt(3.0 * all)};
  } else if (name == "periodic_disturbance") {
    v = {z * sd * std::sqrt(2.0 / all), 1.0 + 8.0 * random.uniform()};
  } else if (name == "band_limited_noise") {
    v = {made.world.rate_hz * (0.2 + 0.1 * random.uniform())};
  } else if (name == "output_resolution") {
    v = {sd * (0.4 + 0.02 * z)};
  } else if (name == "missing_samples" || name == "stuck_samples") {
    v = {0.002 * z};
    if (name == "stuck_samples") {
      v.push_back(6.0);
    }
  } else if (name == "timestamp_jitter") {
    v = {0.003 * z * dt};
  } else if (name == "saturation") {
    double top = 0.0;
    for (const StudyRecording& recording : clean.study.recordings) {
      for (const double w : recording.rate[2]) {
        top = std::max(top, std::fabs(w));
      }
    }
    v = {top * (1.0 - 0.005 * z)};
  }
  return made;
}

}  // namespace driftlab::hidden
