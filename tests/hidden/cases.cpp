/// Sizes of effects: what an oracle that knows base and template would see at about z standard deviations.
#include "core/investigate/fullrate/full_rate.hpp"
#include "core/investigate/slow/slow_fit.hpp"
#include "tests/hidden/simulated_study.hpp"

#include <cmath>

namespace driftlab::hidden {
namespace {

using namespace investigate;

bool acts_in(Acting acting, std::size_t r) {
  return acting == Acting::SecondAlone ? r == 1 : acting == Acting::AllButFirst ? r > 0 : true;
}

/// Standard deviation of the amplitude an oracle would estimate.
double oracle_deviation(const SimulatedStudy& clean, const Cause& cause, double shape) {
  double information = 0.0;
  for (const ChannelGroup& group : group_channels(clean.study)) {
    if (!cause.showing.axis.empty() && group.role.axis != cause.showing.axis) {
      continue;
    }
    const BlockSeries series =
        average_blocks(group, std::vector<std::vector<unsigned char>>(group.members.size()), false);
    BlockColumns columns = BlockColumns::zeros(series, 2);
    std::vector<std::vector<double>> built;
    for (std::size_t r = 0; r < group.members.size(); ++r) {
      const bool here = acts_in(cause.showing.acting, r);
      const bool works = cause.as<MeanEffect>()->build(*group.members[r].recording, group, shape, built);
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
double oracle_level(const SimulatedStudy& clean, const ProcessKind& kind, double beta, double z) {
  const StudyRecording& recording = clean.study.recordings.front();
  SlowModel base;
  base.white = clean.base.n * clean.base.n;
  base.components = clean.base.slow;
  SlowModel unit;
  unit.components.push_back(slow_component(kind, 1.0, beta));
  const auto n = static_cast<double>(recording.count());
  std::vector<double> ratio;  // of the added density at level 1 to the base
  for (double k = 1.0; k < 0.5 * n; k += 1.0) {
    const double f = k / n / recording.dt_s;
    ratio.push_back(slow_density(unit, 0, f, recording.dt_s, n) /
                    (base.white + slow_density(base, 0, f, recording.dt_s, n)));
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

/// The values of a mean effect or a slow process whose amplitude an oracle sees at z standard deviations.
std::vector<double> oracle_values(const Cause& cause, const SimulatedStudy& clean, const Stage& stage, double sign,
                                  Random& random) {
  const double shape = cause.showing.shape != nullptr ? cause.showing.shape(stage, random) : 0.0;
  if (const SlowNoise* const slow = cause.as<SlowNoise>()) {
    std::vector<double> values{std::sqrt(oracle_level(clean, *slow->kind, shape, stage.z))};
    if (cause.parameters.size() > 1) {
      values.push_back(shape);
    }
    return values;
  }
  const MeanEffect& mean = *cause.as<MeanEffect>();
  std::vector<double> values{(mean.free_phase || mean.refinement.turns() ? 1.0 : sign) * stage.z *
                             oracle_deviation(clean, cause, shape)};
  if (mean.shapes != nullptr || mean.change_point) {
    values.push_back(shape);
  }
  return values;
}

}  // namespace

Case make_case(const std::string& name, double z, std::uint64_t seed) {
  Random random(seed, 77);
  const Cause& cause = *find_cause(name);
  const Showing& showing = cause.showing;
  Case made;
  made.world.scenario = showing.scenario;
  made.world.given = showing.given || random.uniform() < 0.4;
  made.world.rate_hz = showing.scenario == Scenario::Static ? 50.0 : 25.0;
  made.world.duration_s = 600.0;
  made.world.seed = seed;
  made.effect.cause = name;
  const SimulatedStudy clean = simulate_study(made.world, {});
  for (std::size_t r = 0; showing.acting != Acting::Everywhere && r < clean.study.recordings.size(); ++r) {
    if (acts_in(showing.acting, r)) {
      made.effect.recordings.push_back(r);
    }
  }
  const Stage stage{clean.study, z, made.world.given, clean.base.n, made.world.rate_hz, made.world.duration_s};
  const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
  made.effect.values =
      showing.values != nullptr ? showing.values(stage, random) : oracle_values(cause, clean, stage, sign, random);
  return made;
}

}  // namespace driftlab::hidden
