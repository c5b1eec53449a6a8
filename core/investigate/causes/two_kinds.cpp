#include "core/investigate/causes/two_kinds.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Chances to go from one kind to the other at the next frame.
struct Turns {
  double leave = 1.0;  ///< the loud kind
  double enter = 0.0;  ///< the loud kind

  explicit Turns(const TwoKinds& kinds)
      : leave(1.0 / std::max(1.0, kinds.length)),
        enter(std::min(0.9, kinds.fraction / (1.0 - kinds.fraction) * leave)) {}
};

/// Filter over one recording. Densities are those of the loud kind relative to the other's.
struct Filtered {
  double log_likelihood = 0.0;
  std::vector<double> chance;    ///< of the loud kind, with the frames so far
  std::vector<double> relative;  ///< density of the loud kind over that of the other
};

Filtered filter(const FrameLaw& law, const std::vector<double>& frames, const TwoKinds& kinds) {
  constexpr double kMost = 600.0;  // of an exponent
  const Turns turns(kinds);
  Filtered filtered;
  filtered.chance.reserve(frames.size());
  filtered.relative.reserve(frames.size());
  double before = kinds.fraction;
  for (const double x : frames) {
    const double rest = law.log_density(x, kinds.scale);
    const double relative = std::exp(std::min(kMost, law.log_density(x, kinds.scale * kinds.ratio) - rest));
    const double sum = 1.0 - before + before * relative;
    const double now = before * relative / sum;
    filtered.log_likelihood += rest + std::log(sum);
    filtered.chance.push_back(now);
    filtered.relative.push_back(relative);
    before = now * (1.0 - turns.leave) + (1.0 - now) * turns.enter;
  }
  return filtered;
}

std::vector<double> smoothed(const FrameLaw& law, const std::vector<double>& frames, const TwoKinds& kinds) {
  const Turns turns(kinds);
  const Filtered filtered = filter(law, frames, kinds);
  std::vector<double> chance = filtered.chance;
  // What the frames after it say of a loud one, relative to what they say of another.
  double after = 1.0;
  for (std::size_t f = frames.size(); f-- > 0;) {
    const double loud = filtered.chance[f] * after;
    chance[f] = loud / (loud + 1.0 - filtered.chance[f]);
    const double next = filtered.relative[f] * after;
    const double from_loud = (1.0 - turns.leave) * next + turns.leave;
    const double from_rest = turns.enter * next + 1.0 - turns.enter;
    after = from_loud / from_rest;
  }
  return chance;
}

/// One step of expectation and maximisation: given who is loud, x / (1 + m x / (M s)) has the mean s M / (m + M).
TwoKinds step(const FrameLaw& law, const FrameRuns& runs, const TwoKinds& kinds) {
  double loud = 0.0;
  double frames = 0.0;
  double loud_sum = 0.0;
  double rest_sum = 0.0;
  for (const std::vector<double>& run : runs) {
    const std::vector<double> chance = smoothed(law, run, kinds);
    for (std::size_t f = 0; f < run.size(); ++f) {
      const double x = run[f];
      frames += 1.0;
      loud += chance[f];
      loud_sum += chance[f] * x / (1.0 + law.m / law.others * x / (kinds.scale * kinds.ratio));
      rest_sum += (1.0 - chance[f]) * x / (1.0 + law.m / law.others * x / kinds.scale);
    }
  }
  const double correction = (law.m + law.others) / law.others;
  TwoKinds next = kinds;
  next.scale = std::clamp(correction * rest_sum / std::max(1e-9, frames - loud), 0.02, 50.0);
  next.ratio = std::clamp(correction * loud_sum / std::max(1e-9, loud) / next.scale, 1.2, 1e5);
  next.fraction = std::clamp(loud / std::max(1.0, frames), 1e-4, 0.5);
  return next;
}

}  // namespace

double FrameLaw::log_density(double x, double scale) const {
  return -m * std::log(scale) - (m + others) * std::log1p(m / others * x / scale);
}

double best_scale(const FrameLaw& law, const FrameRuns& runs) {
  double low = std::log(0.1);
  double high = std::log(10.0);
  const auto value = [&](double log_scale) {
    return log_likelihood(law, runs, TwoKinds{.scale = std::exp(log_scale)});
  };
  for (int i = 0; i < 30; ++i) {  // one maximum in ln s
    const double third = (high - low) / 3.0;
    if (value(low + third) < value(high - third)) {
      low += third;
    } else {
      high -= third;
    }
  }
  return std::exp(0.5 * (low + high));
}

double log_likelihood(const FrameLaw& law, const FrameRuns& runs, const TwoKinds& kinds) {
  double sum = 0.0;
  for (const std::vector<double>& run : runs) {
    if (kinds.fraction > 0.0) {
      sum += filter(law, run, kinds).log_likelihood;
      continue;
    }
    for (const double x : run) {
      sum += law.log_density(x, kinds.scale);
    }
  }
  return sum;
}

FrameRuns loud_chances(const FrameLaw& law, const FrameRuns& runs, const TwoKinds& kinds) {
  FrameRuns chances;
  for (const std::vector<double>& run : runs) {
    chances.push_back(kinds.fraction > 0.0 ? smoothed(law, run, kinds) : std::vector<double>(run.size(), 0.0));
  }
  return chances;
}

TwoKinds fit_two_kinds(const FrameLaw& law, const FrameRuns& runs) {
  // Of expectation and maximisation at most, from each start; and when ratio and fraction count as settled. Chosen, not
  // measured.
  constexpr int kRounds = 40;
  constexpr double kSettled = 1e-3;
  TwoKinds best;
  best.scale = best_scale(law, runs);
  const double plain = log_likelihood(law, runs, best);
  const double one = best.scale;
  for (const double length : {2.0, 6.0, 18.0}) {
    TwoKinds kinds{one, 4.0, 0.1, length, 0.0};
    for (int round = 0; round < kRounds; ++round) {
      const TwoKinds next = step(law, runs, kinds);
      const bool settled = std::fabs(next.ratio / kinds.ratio - 1.0) < kSettled &&
                           std::fabs(next.fraction / kinds.fraction - 1.0) < kSettled;
      kinds = next;
      if (settled) {
        break;
      }
    }
    kinds.gain = 2.0 * (log_likelihood(law, runs, kinds) - plain);
    best = kinds.gain > best.gain ? kinds : best;
  }
  return best;
}

}  // namespace driftlab::investigate
