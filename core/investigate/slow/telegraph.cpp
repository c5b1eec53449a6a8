#include "core/investigate/slow/telegraph.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace driftlab::investigate {
namespace {

/// Slow states that are carried on both sides; a model has eight processes at most.
constexpr std::size_t kMostStates = 16;

/// Estimate of the slow states, under one side.
struct Belief {
  double chance = 0.5;
  std::array<double, kMostStates> mean{};
  std::array<std::array<double, kMostStates>, kMostStates> covariance{};
};

/// The filter over the blocks of one recording.
class SidedFilter {
 public:
  SidedFilter(const BlockStates& states, const Telegraph& telegraph, double block_s)
      : states_(states),
        width_(std::min(states.phi.size(), kMostStates)),
        telegraph_(telegraph),
        turn_(0.5 * (1.0 - std::exp(-2.0 * block_s / telegraph.dwell_s))) {
    for (Belief& belief : belief_) {
      for (std::size_t k = 0; k < width_; ++k) {
        belief.covariance[k][k] = states.p0[k];
      }
    }
  }

  /// Chance of the upper side before the next block is seen.
  [[nodiscard]] double upper() const { return belief_[0].chance; }

  /// Log likelihood of one block, then on to the next. `filled` 0: nothing was seen.
  double take(double seen, double filled) {
    double log_likelihood = 0.0;
    if (filled > 0.0) {
      const double noise = std::max(states_.white / filled + states_.remainder, 1e-6 * states_.white);
      std::array<double, 2> log_density{};
      for (std::size_t side = 0; side < 2; ++side) {
        log_density.at(side) =
            update(belief_.at(side),
                   seen - telegraph_.offset - (side == 0 ? telegraph_.amplitude : -telegraph_.amplitude), noise);
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
    return -0.5 * (std::log(variance) + innovation * innovation / variance);
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
      for (std::size_t i = 0; i < width_; ++i) {
        belief.mean[i] *= states_.phi[i];
        for (std::size_t j = 0; j < width_; ++j) {
          belief.covariance[i][j] *= states_.phi[i] * states_.phi[j];
        }
        belief.covariance[i][i] += states_.q[i];
      }
    }
  }

  const BlockStates& states_;
  std::size_t width_;
  Telegraph telegraph_;
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

/// Between which dwell times are sought: shorter ones are hardly seen by blocks, of longer ones a record holds few.
struct Dwells {
  double log_least = 0.0;
  double log_most = 0.0;
};

Dwells dwells_of(const BlockSeries& series) {
  return {std::log(6.0 * series.block_s()), std::log(0.2 * series.longest_s())};
}

/// Climbs from a place by steps along each axis, forward and back, which are halved where none leads up.
template <std::size_t N, class Value>
double climb(std::array<double, N>& at, std::array<double, N> step, int rounds, double best, const Value& value) {
  for (int round = 0; round < rounds; ++round) {
    bool up = false;
    for (std::size_t k = 0; k < N; ++k) {
      for (const double way : {1.0, -1.0}) {
        std::array<double, N> there = at;
        there[k] += way * step[k];
        const double here = value(there);
        if (here > best) {
          best = here;
          at = there;
          up = true;
          break;
        }
      }
    }
    for (double& s : step) {
      s *= up ? 1.0 : 0.5;
    }
  }
  return best;
}

}  // namespace

double telegraph_log_likelihood(const BlockSeries& series, const SlowModel& model, const Telegraph& telegraph) {
  double sum = 0.0;
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    const BlockStates states = block_states(model, series, r);
    SidedFilter filter(states, telegraph, series.block_s());
    const BlockRecording& recording = series.recordings[r];
    for (std::size_t b = 0; b < recording.mean.size(); ++b) {
      sum += filter.take(recording.mean[b], recording.filled[b]);
    }
  }
  return sum;
}

Telegraph with_best_offset(const BlockSeries& series, const SlowModel& model, Telegraph telegraph) {
  // Of the climb at most; it ends by itself before. Chosen, not measured.
  constexpr int kRounds = 10;
  std::array<double, 1> at{telegraph.offset};
  const auto value = [&](const std::array<double, 1>& offset) {
    return telegraph_log_likelihood(series, model, {telegraph.amplitude, telegraph.dwell_s, offset[0]});
  };
  (void)climb(at, {0.3 * telegraph.amplitude}, kRounds, value(at), value);
  telegraph.offset = at[0];
  return telegraph;
}

TelegraphFit coarse_telegraph(const BlockSeries& series, const SlowModel& model) {
  // Starts along amplitude and along dwell, each. Chosen, not measured.
  constexpr int kSteps = 5;
  const Spread spread = spread_of(series);
  const double scale = std::sqrt(spread.variance);
  const Dwells dwells = dwells_of(series);
  TelegraphFit best;
  best.log_likelihood = -1e300;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = 0; j < kSteps; ++j) {
      const double amplitude = scale * 0.15 * std::pow(8.0, static_cast<double>(i) / (kSteps - 1));
      const double log_dwell = dwells.log_least + j * (dwells.log_most - dwells.log_least) / (kSteps - 1);
      const Telegraph telegraph{amplitude, std::exp(log_dwell), spread.mean};
      const double here = telegraph_log_likelihood(series, model, telegraph);
      if (here > best.log_likelihood) {
        best = {telegraph, here, 0.0, 0.0};
      }
    }
  }
  return best;
}

TelegraphFit fit_telegraph(const BlockSeries& series, const SlowModel& model) {
  const TelegraphFit start = coarse_telegraph(series, model);
  const Dwells dwells = dwells_of(series);
  // Of the climb at most, as above. Chosen, not measured.
  constexpr int kRounds = 12;
  const double unit = start.telegraph.amplitude;  // of the offset
  const auto telegraph_at = [&](const std::array<double, 3>& at) {
    return Telegraph{std::exp(at[0]), std::exp(at[1]), at[2] * unit};
  };
  const auto value = [&](const std::array<double, 3>& at) {
    return telegraph_log_likelihood(series, model, telegraph_at(at));
  };
  std::array<double, 3> at{std::log(unit), std::log(start.telegraph.dwell_s), start.telegraph.offset / unit};
  const double best =
      climb(at, {0.25, 0.12 * (dwells.log_most - dwells.log_least), 0.3}, kRounds, start.log_likelihood, value);
  const auto sd = [&](std::size_t k, double step) {
    std::array<double, 3> above = at;
    std::array<double, 3> below = at;
    above[k] += step;
    below[k] -= step;
    const double curve = (2.0 * best - value(above) - value(below)) / (step * step);
    return curve > 0.0 ? 1.0 / std::sqrt(curve) : 1.0;
  };
  return {telegraph_at(at), best, sd(0, 0.05), sd(1, 0.1)};
}

std::vector<double> telegraph_sides(const BlockSeries& series, const SlowModel& model, const Telegraph& telegraph,
                                    std::size_t r) {
  const BlockStates states = block_states(model, series, r);
  const BlockRecording& recording = series.recordings[r];
  const std::size_t n = recording.mean.size();
  SidedFilter forward(states, telegraph, series.block_s());
  SidedFilter backward(states, telegraph, series.block_s());
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
