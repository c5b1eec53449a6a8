#include "core/investigate/slow/step_scan.hpp"

#include "core/investigate/slow/whitening_walk.hpp"
#include "core/process/dense.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace driftlab::investigate {
namespace {

/// At which norms are computed; they are interpolated between, for they are smooth. Chosen, not measured.
constexpr std::size_t kPlaces = 24;
constexpr std::size_t kMargin = 5;  ///< blocks at either end where a step is not sought

/// Squared norms of a whitened step and of a whitened impulse at any block, between those of a few places.
class Norms {
 public:
  /// The recording has two blocks or more.
  Norms(const SingleRecording& single, const std::stop_token& stop) {
    const std::vector<double>& filled = single.series.recordings[0].filled;
    const std::size_t blocks = filled.size();
    std::array<std::size_t, kPlaces> from{};
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double share = static_cast<double>(k) / (kPlaces - 1.0);
      // Denser towards both ends, where the norm changes fastest.
      const double wanted = (0.5 - 0.5 * std::cos(share * std::numbers::pi)) * static_cast<double>(blocks - 1);
      from[k] = static_cast<std::size_t>(std::round(wanted));
      while (from[k] + 1 < blocks && filled[from[k]] == 0.0) {
        ++from[k];
      }
      place_[k] = static_cast<double>(from[k]);
    }
    const BlockStates states = block_states(single.model, single.series, 0);
    WhiteningWalk walk(states, std::equal(filled.begin() + 1, filled.end(), filled.begin()), 2 * kPlaces);
    for (std::size_t i = 0; i < blocks && !polled(stop, i); ++i) {
      walk.next(filled[i]);
      std::array<double, 2 * kPlaces> both{};
      std::array<double, 2 * kPlaces> whitened{};
      for (std::size_t k = 0; k < kPlaces; ++k) {
        both[k] = i >= from[k] ? 1.0 : 0.0;
        both[kPlaces + k] = i == from[k] ? 1.0 : 0.0;
      }
      walk.whiten_all(both.data(), whitened.data());
      for (std::size_t k = 0; k < kPlaces; ++k) {
        step_[k] += whitened[k] * whitened[k];
        impulse_[k] += whitened[kPlaces + k] * whitened[kPlaces + k];
      }
    }
  }
  [[nodiscard]] double of_step(std::size_t block) const { return between(step_, block); }
  [[nodiscard]] double of_impulse(std::size_t block) const { return between(impulse_, block); }

 private:
  [[nodiscard]] double between(const std::array<double, kPlaces>& norm, std::size_t block) const {
    const auto at = static_cast<double>(block);
    const auto above = std::upper_bound(place_.begin() + 1, place_.end() - 1, at);
    const auto k = static_cast<std::size_t>(above - place_.begin()) - 1;
    const double width = std::max(1.0, place_[k + 1] - place_[k]);
    return norm[k] + (norm[k + 1] - norm[k]) * (at - place_[k]) / width;
  }
  std::array<double, kPlaces> place_{}, step_{}, impulse_{};
};

}  // namespace

SingleRecording take_recording(const BlockSeries& series, const SlowModel& model, std::size_t r) {
  SingleRecording single;
  single.series.dt_s = series.dt_s;
  single.series.block = series.block;
  single.series.recordings = {series.recordings[r]};
  single.series.recordings[0].pattern = 0;
  single.model.white = model.white * (model.white_scale.empty() ? 1.0 : model.white_scale[r]);
  for (const SlowComponent& component : model.components) {
    if (component.acts_in(r)) {
      single.model.components.push_back(component);
      single.model.components.back().in.clear();
    }
  }
  return single;
}

StepScan::StepScan(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns, std::stop_token stop)
    : series_(series), model_(model), stop_(std::move(stop)) {
  if (stop_.stop_requested()) {
    return;
  }
  const Whitened whitened = whiten(series, model, columns);
  const auto p = static_cast<Eigen::Index>(columns.width) - 1;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(p + 1, p + 1);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    gram += gram_of(whitened.columns, r);
  }
  Eigen::MatrixXd b = gram.bottomRightCorner(p, p);
  b.diagonal() *= 1.0 + 1e-12;
  for (Eigen::Index k = 0; k < p; ++k) {
    b(k, k) = b(k, k) > 0.0 ? b(k, k) : 1.0;  // a regressor without input
  }
  inverse_ = inverse(b);
  const Eigen::VectorXd amplitude = inverse_ * gram.col(0).tail(p);
  for (std::size_t r = 0; r < series.recordings.size() && !stop_.stop_requested(); ++r) {
    const auto& rows = whitened.columns.rows[r];
    const std::size_t blocks = rows.size() / columns.width;
    std::vector<std::vector<double>> sums;
    for (std::size_t c = 0; c < columns.width; ++c) {
      std::vector<double> z(blocks);
      for (std::size_t i = 0; i < blocks; ++i) {
        z[i] = rows[i * columns.width + c];
        if (c == 0) {
          for (Eigen::Index k = 0; k < p; ++k) {
            z[i] -= amplitude[k] * rows[i * columns.width + static_cast<std::size_t>(k) + 1];
          }
        }
      }
      std::vector<double> back = whiten_transposed(series, model, r, z);
      for (std::size_t i = blocks - 1; i-- > 0;) {
        back[i] += back[i + 1];
      }
      sums.push_back(std::move(back));
    }
    tail_sum_.push_back(std::move(sums));
  }
}

StepScan::Steps StepScan::steps_in(std::size_t r) const {
  const std::size_t blocks = series_.recordings[r].mean.size();
  Steps result;
  result.gain.assign(blocks, 0.0);
  result.turnover.assign(blocks, 0.0);
  if (blocks < 4 * kMargin || stop_.stop_requested() || tail_sum_.size() <= r) {
    return result;
  }
  const Norms norms(take_recording(series_, model_, r), stop_);
  const auto p = inverse_.rows();
  Eigen::VectorXd cross(p);
  for (std::size_t i = kMargin; i + kMargin < blocks && !polled(stop_, i); ++i) {
    for (Eigen::Index c = 0; c < p; ++c) {
      cross[c] = tail_sum_[r][static_cast<std::size_t>(c) + 1][i];
    }
    const double own = norms.of_step(i);
    const double d = own - cross.dot(inverse_ * cross);
    if (d > 1e-6 * own && d > 0.0) {
      const double n = tail_sum_[r][0][i];
      result.gain[i] = n * n / d;
      result.turnover[i] = std::min(1.0, 0.5 * norms.of_impulse(i) / d);
    }
  }
  return result;
}

StepScan::Best StepScan::best_in(std::size_t r) const {
  const Steps steps = steps_in(r);
  const auto top = std::max_element(steps.gain.begin(), steps.gain.end());
  if (top == steps.gain.end()) {
    return {};
  }
  return {static_cast<std::size_t>(top - steps.gain.begin()), *top, cost_of_search(steps.turnover, *top)};
}

double cost_of_search(const std::vector<double>& turnover, double gain) {
  // Phi(x) - 1/2 = erf(x / sqrt 2) / 2.
  const auto nu = [](double x) {
    if (x < 1e-6) {
      return 1.0;
    }
    const double half = 0.5 * x;
    const double above = 0.5 * std::erf(half / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * half * half) / std::sqrt(2.0 * std::numbers::pi);
    return above / half / (half * (0.5 + above) + density);
  };
  double places = 0.0;
  for (const double t : turnover) {
    places += t * nu(std::sqrt(2.0 * gain * t));
  }
  double cost = 0.0;
  for (int i = 0; i < 4; ++i) {  // v depends on the cost, by its logarithm
    const double v = std::sqrt(std::max(1.0, gain - cost));
    cost = 2.0 * std::log(std::max(1.0, std::sqrt(gain) * v * places));
  }
  return cost;
}

}  // namespace driftlab::investigate
