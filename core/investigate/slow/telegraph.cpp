#include "core/investigate/slow/telegraph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kMostStates = 16;

/// Estimate of the slow states and the bias, under one side.
struct Belief {
  double chance = 0.5;
  std::array<double, kMostStates> mean{};
  std::array<std::array<double, kMostStates>, kMostStates> covariance{};
};

/// The filter over the blocks of one recording.
class SidedFilter {
 public:
  SidedFilter(const BlockStates& states, double bias, double bias_variance, const Telegraph& telegraph, double block_s)
      : states_(states),
        width_(std::min(states.phi.size(), kMostStates - 1) + 1),
        amplitude_(telegraph.amplitude),
        turn_(0.5 * (1.0 - std::exp(-2.0 * block_s / telegraph.dwell_s))) {
    for (Belief& belief : belief_) {
      for (std::size_t k = 0; k + 1 < width_; ++k) {
        belief.covariance[k][k] = states.p0[k];
      }
      belief.mean[width_ - 1] = bias;
      belief.covariance[width_ - 1][width_ - 1] = bias_variance;
    }
  }

  /// Chance of the upper side before the next block is seen.
  [[nodiscard]] double upper() const { return belief_[0].chance; }

  /// Log likelihood of one block, then on to the next. `filled` 0: nothing was seen.
  double take(double seen, double filled) {
    double log_likelihood = 0.0;
    if (filled > 0.0) {
      const double noise = std::max(1e-300, states_.white / filled + std::max(states_.remainder, -0.9 * states_.white));
      std::array<double, 2> log_density{};
      for (std::size_t side = 0; side < 2; ++side) {
        log_density.at(side) = update(belief_.at(side), seen - (side == 0 ? amplitude_ : -amplitude_), noise);
      }
      const double top = std::max(log_density[0], log_density[1]);
      const double sum =
          belief_[0].chance * std::exp(log_density[0] - top) + belief_[1].chance * std::exp(log_density[1] - top);
      log_likelihood = top + std::log(std::max(sum, 1e-300));
      for (std::size_t side = 0; side < 2; ++side) {
        belief_.at(side).chance = std::clamp(
            belief_.at(side).chance * std::exp(log_density.at(side) - top) / std::max(sum, 1e-300), 1e-12, 1.0);
      }
    }
    mix();
    predict();
    return log_likelihood;
  }

 private:
  double update(Belief& belief, double innovation, double noise) const {
    std::array<double, kMostStates> to_state{};
    double variance = noise;
    for (std::size_t i = 0; i < width_; ++i) {
      innovation -= belief.mean[i];
      for (std::size_t j = 0; j < width_; ++j) {
        to_state[i] += belief.covariance[i][j];
      }
      variance += to_state[i];
    }
    for (std::size_t i = 0; i < width_; ++i) {
      belief.mean[i] += to_state[i] / variance * innovation;
      for (std::size_t j = 0; j < width_; ++j) {
        belief.covariance[i][j] -= to_state[i] * to_state[j] / variance;
      }
    }
    return -0.5 * (std::log(2.0 * std::numbers::pi * variance) + innovation * innovation / variance);
  }

  /// Each side takes over what comes to it from both.
  void mix() {
    const std::array<Belief, 2> old = belief_;
    for (std::size_t to = 0; to < 2; ++to) {
      const double stays = (1.0 - turn_) * old.at(to).chance;
      const double comes = turn_ * old.at(1 - to).chance;
      const double share = stays / (stays + comes);
      Belief& belief = belief_.at(to);
      const Belief& same = old.at(to);
      const Belief& other = old.at(1 - to);
      belief.chance = stays + comes;
      for (std::size_t i = 0; i < width_; ++i) {
        belief.mean[i] = share * same.mean[i] + (1.0 - share) * other.mean[i];
      }
      for (std::size_t i = 0; i < width_; ++i) {
        for (std::size_t j = 0; j < width_; ++j) {
          const double apart = (same.mean[i] - other.mean[i]) * (same.mean[j] - other.mean[j]);
          belief.covariance[i][j] =
              share * same.covariance[i][j] + (1.0 - share) * other.covariance[i][j] + share * (1.0 - share) * apart;
        }
      }
    }
  }

  void predict() {
    for (Belief& belief : belief_) {
      for (std::size_t i = 0; i + 1 < width_; ++i) {
        belief.mean[i] *= states_.phi[i];
        for (std::size_t j = 0; j < width_; ++j) {
          const double other = j + 1 < width_ ? states_.phi[j] : 1.0;
          belief.covariance[i][j] *= states_.phi[i] * other;
          belief.covariance[j][i] = belief.covariance[i][j];
        }
        belief.covariance[i][i] += states_.q[i];
      }
    }
  }

  const BlockStates& states_;
  std::size_t width_;
  double amplitude_;
  double turn_;
  std::array<Belief, 2> belief_;
};

struct Spread {
  double mean = 0.0;
  double variance = 0.0;
};

Spread spread_of(const BlockSeries& series) {
  double sum = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (const BlockRecording& recording : series.recordings) {
    for (std::size_t b = 0; b < recording.mean.size(); ++b) {
      if (recording.filled[b] > 0.0) {
        sum += recording.mean[b];
        square += recording.mean[b] * recording.mean[b];
        count += 1.0;
      }
    }
  }
  const double mean = sum / std::max(1.0, count);
  return {mean, std::max(0.0, square / std::max(1.0, count) - mean * mean)};
}

}  // namespace

double telegraph_log_likelihood(const BlockSeries& series, const SlowModel& model, const Telegraph& telegraph,
                                std::size_t r) {
  const Spread spread = spread_of(series);
  const BlockStates states = block_states(model, series, r);
  SidedFilter filter(states, spread.mean, 4.0 * spread.variance, telegraph, series.block_s());
  const BlockRecording& recording = series.recordings[r];
  double sum = 0.0;
  for (std::size_t b = 0; b < recording.mean.size(); ++b) {
    sum += filter.take(recording.mean[b], recording.filled[b]);
  }
  return sum;
}

double telegraph_log_likelihood(const BlockSeries& series, const SlowModel& model, const Telegraph& telegraph) {
  double sum = 0.0;
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    sum += telegraph_log_likelihood(series, model, telegraph, r);
  }
  return sum;
}

TelegraphFit fit_telegraph(const BlockSeries& series, const SlowModel& model) {
  const double scale = std::sqrt(spread_of(series).variance);
  const double shortest = std::log(6.0 * series.block_s());
  const double longest = std::log(0.2 * series.longest_s());
  const auto value = [&](double log_a, double log_t) {
    return telegraph_log_likelihood(series, model, {std::exp(log_a), std::exp(log_t)});
  };
  double best = -1e300;
  double a = std::log(scale);
  double t = 0.5 * (shortest + longest);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const double log_a = std::log(scale) + std::log(0.15) + i * std::log(8.0) / 5.0;
      const double log_t = shortest + j * (longest - shortest) / 5.0;
      const double here = value(log_a, log_t);
      if (here > best) {
        best = here;
        a = log_a;
        t = log_t;
      }
    }
  }
  double step_a = 0.2;
  double step_t = 0.1 * (longest - shortest);
  for (int round = 0; round < 14; ++round) {
    const double before = best;
    const std::array<std::pair<double, double>, 4> moves{
        {{step_a, 0.0}, {-step_a, 0.0}, {0.0, step_t}, {0.0, -step_t}}};
    for (const auto& [da, dt] : moves) {
      const double here = value(a + da, t + dt);
      if (here > best) {
        best = here;
        a += da;
        t += dt;
        break;
      }
    }
    if (best == before) {
      step_a *= 0.5;
      step_t *= 0.5;
    }
  }
  const auto sd = [&](double da, double dt) {
    const double curve = (2.0 * best - value(a + da, t + dt) - value(a - da, t - dt)) / (da * da + dt * dt);
    return curve > 0.0 ? 1.0 / std::sqrt(curve) : 1.0;
  };
  return {{std::exp(a), std::exp(t)}, best, sd(0.05, 0.0), sd(0.0, 0.1)};
}

std::vector<double> telegraph_sides(const BlockSeries& series, const SlowModel& model, const Telegraph& telegraph,
                                    std::size_t r) {
  const Spread spread = spread_of(series);
  const BlockStates states = block_states(model, series, r);
  const BlockRecording& recording = series.recordings[r];
  const std::size_t n = recording.mean.size();
  SidedFilter forward(states, spread.mean, 4.0 * spread.variance, telegraph, series.block_s());
  SidedFilter backward(states, spread.mean, 4.0 * spread.variance, telegraph, series.block_s());
  std::vector<double> before(n);
  std::vector<double> after(n);
  const auto odds = [](double upper) { return std::log(upper / std::max(1e-12, 1.0 - upper)); };
  for (std::size_t b = 0; b < n; ++b) {
    before[b] = odds(forward.upper());
    (void)forward.take(recording.mean[b], recording.filled[b]);
    const std::size_t back = n - 1 - b;
    after[back] = odds(backward.upper());
    (void)backward.take(recording.mean[back], recording.filled[back]);
  }
  // What the block itself says, once the slow part is seen from both sides, is in its neighbours nearly: sides last
  // many blocks.
  std::vector<double> side(n);
  for (std::size_t b = 0; b < n; ++b) {
    side[b] = std::tanh(0.5 * (before[b] + after[b]));
  }
  return side;
}

}  // namespace driftlab::investigate
