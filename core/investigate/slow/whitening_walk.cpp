#include "core/investigate/slow/whitening_walk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// `States`: how many there are where they are few, else 0.
template <std::size_t States>
void whiten_block(std::size_t states, std::size_t width, const double* __restrict in, const double* __restrict phi,
                  const double* __restrict gain, double inv_sd, double* __restrict state, double* __restrict out) {
  const std::size_t m = States > 0 ? States : states;
  for (std::size_t c = 0; c < width; ++c) {
    double v = in[c];
    for (std::size_t i = 0; i < m; ++i) {
      v -= state[i * width + c];
    }
    v = inv_sd > 0.0 ? v : 0.0;
    out[c] = v * inv_sd;
    for (std::size_t i = 0; i < m; ++i) {
      state[i * width + c] = phi[i] * (state[i * width + c] + gain[i] * v);
    }
  }
}

}  // namespace

BlockWhitening block_whitening(std::size_t states) {
  constexpr std::array<BlockWhitening, 5> kFew{whiten_block<0>, whiten_block<1>, whiten_block<2>, whiten_block<3>,
                                               whiten_block<4>};
  return states < kFew.size() ? kFew[states] : kFew[0];
}

WhiteningWalk::WhiteningWalk(const BlockStates& states, bool uniform, std::size_t width)
    : states_(states), uniform_(uniform), width_(width), whiten_(block_whitening(states.phi.size())) {
  const std::size_t m = states.phi.size();
  covariance_.assign(m * m, 0.0);
  for (std::size_t i = 0; i < m; ++i) {
    covariance_[i * m + i] = states.p0[i];
  }
  sum_.resize(m);
  gain_.resize(m);
  state_.assign(m * width, 0.0);
}

void WhiteningWalk::next(double filled) {
  if (settled_) {
    return;
  }
  switch (gain_.size()) {
    case 1:
      return advance<1>(filled);
    case 2:
      return advance<2>(filled);
    case 3:
      return advance<3>(filled);
    default:
      return advance<0>(filled);
  }
}

template <std::size_t States>
void WhiteningWalk::advance(double filled) {
  const std::size_t m = States > 0 ? States : gain_.size();
  const auto p = [&](std::size_t i, std::size_t j) -> double& { return covariance_[i * m + j]; };
  std::fill(sum_.begin(), sum_.end(), 0.0);
  double s = 0.0;
  if (filled > 0.0) {
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j < m; ++j) {
        sum_[i] += p(i, j);
      }
      s += sum_[i];
    }
    // A remainder more negative than the white part would be no variance at all; the floor keeps S positive.
    s += std::max(states_.white / filled + states_.remainder, 1e-6 * states_.white);
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        p(i, j) -= sum_[i] * sum_[j] / s;
        p(j, i) = p(i, j);
      }
    }
  }
  double change = 0.0;
  for (std::size_t i = 0; i < m; ++i) {
    const double gain = s > 0.0 ? sum_[i] / s : 0.0;
    change = std::max(change, std::fabs(gain - gain_[i]));
    gain_[i] = gain;
  }
  variance_ = s;
  inv_sd_ = s > 0.0 ? 1.0 / std::sqrt(s) : 0.0;
  for (std::size_t i = 0; i < m; ++i) {
    for (std::size_t j = 0; j < m; ++j) {
      p(i, j) *= states_.phi[i] * states_.phi[j];
    }
    p(i, i) += states_.q[i];
  }
  same_ = !first_ && change < 1e-9 ? same_ + 1 : 0;
  first_ = false;
  settled_ = uniform_ && same_ > 8;
}

}  // namespace driftlab::investigate
