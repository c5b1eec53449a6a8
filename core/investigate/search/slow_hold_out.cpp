/// Held-out gains of what the slow search has accepted.
#include "core/investigate/search/slow_search.hpp"
#include "core/process/dense.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/random_walk.hpp"
#include "core/process/registry.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

/// Segments that take turns in being held out: short ones, so that each fold sees what passes within a minute.
constexpr std::size_t kSegments = 64;

std::size_t fold_of(std::size_t block, std::size_t blocks) {
  return (block * kSegments / std::max<std::size_t>(1, blocks)) % 2;
}

/// Gram matrices of whitened columns over one fold.
Eigen::MatrixXd fold_gram(const BlockColumns& whitened, std::size_t fold) {
  const auto w = static_cast<Eigen::Index>(whitened.width);
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(w, w);
  for (const auto& rows : whitened.rows) {
    const std::size_t blocks = rows.size() / whitened.width;
    for (std::size_t b = 0; b < blocks; ++b) {
      if (fold_of(b, blocks) == fold) {
        const Eigen::Map<const Eigen::VectorXd> row(rows.data() + b * whitened.width, w);
        gram.noalias() += row * row.transpose();
      }
    }
  }
  return gram;
}

/// Residual square of `test` at amplitudes fitted to `train`.
double tested(const Eigen::MatrixXd& train, const Eigen::MatrixXd& test) {
  const Eigen::Index p = train.rows() - 1;
  Eigen::MatrixXd normal = train.block(1, 1, p, p);
  normal.diagonal() *= 1.0 + 1e-9;
  normal.diagonal().array() += 1e-300;
  const Eigen::VectorXd a = solve_symmetric(normal, Eigen::VectorXd(train.col(0).segment(1, p)));
  return test(0, 0) - 2.0 * a.dot(test.col(0).segment(1, p)) + a.dot(test.block(1, 1, p, p) * a);
}

BlockSeries half_of(const BlockSeries& series, std::size_t half) {
  BlockSeries result = series;
  for (std::size_t r = 0; r < result.recordings.size(); ++r) {
    BlockRecording& blocks = result.recordings[r];
    const std::size_t middle = blocks.mean.size() / 2;
    const std::size_t from = half == 0 ? 0 : middle;
    const std::size_t to = half == 0 ? middle : blocks.mean.size();
    blocks.mean = {blocks.mean.begin() + static_cast<std::ptrdiff_t>(from),
                   blocks.mean.begin() + static_cast<std::ptrdiff_t>(to)};
    blocks.filled = {blocks.filled.begin() + static_cast<std::ptrdiff_t>(from),
                     blocks.filled.begin() + static_cast<std::ptrdiff_t>(to)};
    blocks.start_s += static_cast<double>(from) * series.block_s();
    blocks.pattern = r;
  }
  return result;
}

}  // namespace

void SlowSearch::hold_out(Evidence& evidence) const {
  if (evidence.cause->as<MeanEffect>() != nullptr) {
    hold_out_mean(evidence);
  } else {
    hold_out_slow(evidence);
  }
}

double SlowSearch::score_across_folds(const BlockColumns& columns, const SlowModel& noise) const {
  const Whitened whitened = whiten(series_, noise, columns);
  const Eigen::MatrixXd even = fold_gram(whitened.columns, 0);
  const Eigen::MatrixXd odd = fold_gram(whitened.columns, 1);
  return -0.5 * (tested(even, odd) + tested(odd, even) + whitened.sum_log_var);
}

SlowModel SlowSearch::noise_without(const BlockColumns& columns) const {
  if (given_) {
    return null_.model;
  }
  // Whatever a mean effect is, a slow process can follow it: both kinds are offered a large share of the variance.
  const double level = null_.model.white / series_.block_s();
  std::vector<SlowModel> starts{widest_base(columns)};
  if (extra_.empty()) {
    SlowModel walking = null_.model;
    walking.components.push_back(
        slow_component(registered<RandomWalk>(), first_level(registered<RandomWalk>(), 0.3, 0.3, level)));
    SlowModel wandering = null_.model;
    wandering.components.push_back(slow_component(registered<GaussMarkov>(), 0.3 * level, 2.5 / series_.longest_s()));
    starts.push_back(std::move(walking));
    starts.push_back(std::move(wandering));
  }
  SlowFit best;
  for (const SlowModel& start : starts) {
    SlowFit fit = fit_slow(series_, columns, start, freedom());
    if (fit.log_likelihood > best.log_likelihood) {
      best = std::move(fit);
    }
  }
  return best.model;
}

void SlowSearch::hold_out_mean(Evidence& evidence) const {
  const auto position = regressor_of(evidence);
  if (!position) {
    return;
  }
  // The effect's columns last; rows of the whitened series are independent, so folds are sets of rows.
  std::vector<Regressor> order;
  Regressor mine;
  for (const Regressor& regressor : accepted_) {
    if (regressor.cause == evidence.cause && regressor.members == evidence.members) {
      mine = regressor;
    } else {
      order.push_back(regressor);
    }
  }
  const BlockColumns without = columns_with(order);
  order.push_back(mine);
  const BlockColumns with = columns_with(order);
  const SlowModel noise = given_ ? null_.model : fit_slow(series_, with, widest_base(with), freedom()).model;
  evidence.heldout_gain = score_across_folds(with, noise) - score_across_folds(without, noise_without(without));
  std::size_t used = 0;
  for (const BlockRecording& recording : series_.recordings) {
    used += static_cast<std::size_t>(
        std::count_if(recording.filled.begin(), recording.filled.end(), [](double share) { return share > 0.0; }));
  }
  evidence.heldout_samples = static_cast<double>(used * series_.block);
  evidence.heldout = true;
}

void SlowSearch::hold_out_slow(Evidence& evidence) const {
  const auto it = std::find(extra_cause_.begin(), extra_cause_.end(), evidence.cause);
  if (it == extra_cause_.end()) {
    return;
  }
  const std::size_t component = base_count_ + static_cast<std::size_t>(it - extra_cause_.begin());
  const std::vector<std::vector<double>> rest = [&] {
    std::vector<std::vector<double>> result;
    const BlockColumns columns = columns_with(accepted_);
    for (const auto& rows : columns.rows) {
      std::vector<double> e(rows.size() / columns.width);
      for (std::size_t b = 0; b < e.size(); ++b) {
        e[b] = rows[b * columns.width];
        for (std::size_t c = 1; c < columns.width; ++c) {
          e[b] -= null_.amplitude[static_cast<Eigen::Index>(c - 1)] * rows[b * columns.width + c];
        }
      }
      result.push_back(std::move(e));
    }
    return result;
  }();
  double gain = 0.0;
  double samples = 0.0;
  for (std::size_t half = 0; half < 2; ++half) {
    const auto part = [&](std::size_t which) {
      BlockSeries series = half_of(series_, which);
      BlockColumns columns = BlockColumns::zeros(series, 1);
      for (std::size_t r = 0; r < series.recordings.size(); ++r) {
        const std::size_t from = which == 0 ? 0 : rest[r].size() - series.recordings[r].mean.size();
        for (std::size_t b = 0; b < series.recordings[r].mean.size(); ++b) {
          columns.rows[r][b] = rest[r][from + b];
        }
      }
      return std::pair{std::move(series), std::move(columns)};
    };
    const auto [train, train_columns] = part(half);
    const auto [test, test_columns] = part(1 - half);
    SlowModel start = null_.model;
    std::rotate(start.components.begin() + static_cast<std::ptrdiff_t>(component),
                start.components.begin() + static_cast<std::ptrdiff_t>(component) + 1, start.components.end());
    SlowFreedom last = freedom();
    if (given_) {
      last.first_free = start.components.size() - 1;
    }
    const SlowModel extended = fit_slow(train, train_columns, start, last).model;
    SlowModel plain = extended;
    plain.components.pop_back();
    if (!given_) {  // the base follows the recordings as far as it can without the process
      plain = fit_slow(train, train_columns, plain, freedom()).model;
    }
    gain += evaluate_slow(test, test_columns, extended).log_likelihood -
            evaluate_slow(test, test_columns, plain).log_likelihood;
    samples += static_cast<double>(test.blocks() * test.block);
  }
  evidence.heldout_gain = gain;
  evidence.heldout_samples = samples;
  evidence.heldout = true;
}

}  // namespace driftlab::investigate
