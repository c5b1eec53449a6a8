/// Parameters, intervals and held-out gains of what the slow search has accepted.
#include "core/investigate/full_rate.hpp"
#include "core/investigate/slow_search.hpp"
#include "core/investigate/step_scan.hpp"
#include "core/process/dense.hpp"

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

/// Residual square of `test` at amplitudes fitted to `train`, over the first `width` columns.
double tested(const Eigen::MatrixXd& train, const Eigen::MatrixXd& test, Eigen::Index width) {
  const Eigen::Index p = width - 1;
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

void SlowSearch::describe(Evidence& evidence) const {
  if (evidence.cause->mean != nullptr) {
    describe_mean(evidence);
  } else {
    describe_slow(evidence);
  }
}

void SlowSearch::hold_out(Evidence& evidence) const {
  if (evidence.cause->mean != nullptr) {
    hold_out_mean(evidence);
  } else {
    hold_out_slow(evidence);
  }
}

/// The widest base that a given or automatic baseline allows, none of its processes at rest. The search keeps a process
/// only where it pays; an interval that took the chosen base for certain would be too short where slow noise hides
/// below that price, and for recorded noise it always does.
SlowModel SlowSearch::widest_base(const BlockColumns& columns) const {
  SlowModel model = null_.model;
  if (given_ || !extra_.empty() || orders_.empty()) {
    return model;
  }
  const auto richer = [](const SlowFit& a, const SlowFit& b) { return a.log_likelihood < b.log_likelihood; };
  model = std::max_element(orders_.begin(), orders_.end(), richer)->model;
  const double level = model.white / series_.block_s();
  if (model.count(SlowKind::RandomWalk) == 0) {
    model.components.push_back({SlowKind::RandomWalk, 0.0, 0.0, {}});
  }
  for (SlowComponent& component : model.components) {
    const bool walk = component.kind == SlowKind::RandomWalk;
    component.level = std::max(component.level, walk ? 0.003 * level / series_.longest_s() : 0.003 * level);
  }
  return fit_slow(series_, columns, model, freedom()).model;
}

void SlowSearch::describe_mean(Evidence& evidence) const {
  const auto position = regressor_of(evidence);
  const auto mine = std::find_if(accepted_.begin(), accepted_.end(), [&](const Regressor& r) {
    return r.cause == evidence.cause && r.members == evidence.members;
  });
  if (!position || mine == accepted_.end()) {
    return;
  }
  const Cause& cause = *evidence.cause;
  const MeanEffect& effect = *cause.mean;
  evidence.shape = mine->shape;
  BlockColumns columns = columns_with(accepted_);
  // The shape is uncertain too: its derivative is one more regressor while the amplitude's interval is sought.
  if (effect.continuous) {
    const double step = std::max(0.02 * mine->shape, 0.05);
    std::vector<Regressor> moved = accepted_;
    moved[static_cast<std::size_t>(mine - accepted_.begin())].shape += step;
    const BlockColumns there = columns_with(moved);
    BlockColumns wider = BlockColumns::zeros(series_, columns.width + 1);
    for (std::size_t r = 0; r < columns.rows.size(); ++r) {
      for (std::size_t b = 0; b * columns.width < columns.rows[r].size(); ++b) {
        for (std::size_t c = 0; c < columns.width; ++c) {
          wider.rows[r][b * wider.width + c] = columns.rows[r][b * columns.width + c];
        }
        const std::size_t at = b * columns.width + *position + 1;
        wider.rows[r][b * wider.width + columns.width] = (there.rows[r][at] - columns.rows[r][at]) / step;
      }
    }
    columns = std::move(wider);
  }
  const SlowFit here = evaluate_slow(series_, columns, null_.model);
  const SlowFit fit = evaluate_slow(series_, columns, widest_base(columns));
  const Unit& unit = group_.unit;
  const auto index = static_cast<Eigen::Index>(*position);
  if (effect.free_phase) {
    // One amplitude from the moduli of all recordings, each less the noise's share: A ~ m - var/(2 m).
    double weight = 0.0;
    double mean = 0.0;
    double count = 0.0;
    for (Eigen::Index k = index; k + 1 < index + mine->columns; k += 2) {
      const double variance = 0.5 * (fit.amplitude_covariance(k, k) + fit.amplitude_covariance(k + 1, k + 1));
      const double modulus = std::hypot(fit.amplitude[k], fit.amplitude[k + 1]);
      const bool seen = modulus * modulus > 0.0 && variance < 1e6 * modulus * modulus;
      if (seen && variance > 0.0) {
        weight += 1.0 / variance;
        mean += modulus / variance;
        count += 1.0;
      }
    }
    mean /= weight;
    const double value = mean - 0.5 * count / weight / mean;
    const double half = 1.959964 / std::sqrt(weight);
    evidence.parameters = {{std::string(cause.parameters[0].name),
                            {value, {std::max(0.0, value - half), value + half}},
                            cause.parameters[0].unit(unit)}};
    return;
  }
  Interval interval = profile_amplitude(series_, columns, fit, *position + 1, freedom());
  const double value = here.amplitude[index];
  interval = {std::min(interval.low, value), std::max(interval.high, value)};
  const CauseParameter& first =
      cause.name == "scale_factor_nonlinearity" && evidence.shape > 2.5 ? cause.parameters[1] : cause.parameters[0];
  evidence.parameters = {{std::string(first.name), {value, interval}, first.unit(unit)}};
  if (effect.change_point) {
    place_step(evidence);
  } else if (effect.continuous) {
    const auto which = static_cast<std::size_t>(mine - accepted_.begin());
    const auto at = [&](double shape) {
      std::vector<Regressor> moved = accepted_;
      moved[which].shape = std::max(0.0, shape);
      SlowFreedom quick = freedom();
      quick.iterations = 3;
      return fit_slow(series_, columns_with(moved), fit.model, quick).log_likelihood;
    };
    const double top = at(evidence.shape);
    const double sd = std::max(0.5, 0.15 * evidence.shape);
    const Interval place{evidence.shape > 0.0 ? profile_end(evidence.shape, -sd, top, 3.8415, 0.0, at) : 0.0,
                         profile_end(evidence.shape, sd, top, 3.8415, 1e5, at)};
    evidence.parameters.push_back(
        {std::string(cause.parameters[1].name), {evidence.shape, place}, cause.parameters[1].unit(unit)});
  }
}

/// The time of a step at single samples: posterior under a flat prior, equal tails of 2.5 %.
void SlowSearch::place_step(Evidence& evidence) const {
  const std::size_t r = evidence.members.front();
  const StudyRecording& recording = *group_.members[r].recording;
  const auto position = regressor_of(evidence);
  const BlockSeries samples = average_blocks(group_, mask_, true);
  std::vector<std::vector<double>> rest = residuals(error_);
  const double amplitude = null_.amplitude[static_cast<Eigen::Index>(position.value_or(0))];
  const SlowModel& model = null_.model;
  const SingleRecording single = take_recording(samples, model, r);
  BlockColumns columns = BlockColumns::zeros(single.series, 2);
  const auto start = static_cast<std::size_t>(std::max(0.0, std::ceil(evidence.shape / recording.dt_s - 1e-6)));
  for (std::size_t i = 0; i < rest[r].size(); ++i) {
    columns.rows[0][2 * i] = rest[r][i] + (recording.begin + i >= start ? amplitude : 0.0);
    columns.rows[0][2 * i + 1] = 1e-9;  // the bias is known from all recordings
  }
  const StepScan scan(single.series, single.model, columns);
  std::vector<double> gain = scan.steps_in(0).gain;
  // Only the neighbourhood of the block found: elsewhere another step would have been accepted.
  const double reach = 40.0 / recording.dt_s;
  double top = 0.0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (std::fabs(static_cast<double>(recording.begin + i) - static_cast<double>(start)) > reach) {
      gain[i] = 0.0;
    }
    top = std::max(top, gain[i]);
  }
  double total = 0.0;
  for (const double g : gain) {
    total += g > 0.0 ? std::exp(0.5 * (g - top)) : 0.0;
  }
  double run = 0.0;
  std::size_t best = 0;
  std::size_t low = 0;
  std::size_t high = 0;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    run += gain[i] > 0.0 ? std::exp(0.5 * (gain[i] - top)) : 0.0;
    low = run < 0.025 * total ? i + 1 : low;
    high = run < 0.975 * total ? i + 1 : high;
    best = gain[i] >= top ? i : best;
  }
  const auto time = [&](std::size_t i) { return recording.time_s(recording.begin + i); };
  // A step between two samples is seen at the later one.
  evidence.parameters.push_back({"t0_s",
                                 {time(best) - 0.5 * recording.dt_s, {time(low) - 1.01 * recording.dt_s, time(high)}},
                                 evidence.cause->parameters[1].unit(group_.unit)});
}

void SlowSearch::describe_slow(Evidence& evidence) const {
  const auto it = std::find(extra_cause_.begin(), extra_cause_.end(), evidence.cause);
  if (it == extra_cause_.end()) {
    return;
  }
  const std::size_t component = base_count_ + static_cast<std::size_t>(it - extra_cause_.begin());
  const SlowComponent& extra = null_.model.components[component];
  const BlockColumns columns = columns_with(accepted_);
  const Interval level = profile_parameter(series_, columns, null_, {component, false}, freedom());
  const Cause& cause = *evidence.cause;
  evidence.parameters = {{std::string(cause.parameters[0].name),
                          {std::sqrt(extra.level), {std::sqrt(level.low), std::sqrt(level.high)}},
                          cause.parameters[0].unit(group_.unit)}};
  if (extra.kind == SlowKind::GaussMarkov) {
    const Interval beta = profile_parameter(series_, columns, null_, {component, true}, freedom());
    evidence.parameters.push_back(
        {std::string(cause.parameters[1].name), {extra.beta, beta}, cause.parameters[1].unit(group_.unit)});
  }
}

/// What the last `mine` columns gain in each fold of the whitened rows, fitted to the other.
double SlowSearch::gain_across_folds(const BlockColumns& columns, const SlowModel& noise, int mine) const {
  const Whitened whitened = whiten(series_, noise, columns);
  const Eigen::MatrixXd even = fold_gram(whitened.columns, 0);
  const Eigen::MatrixXd odd = fold_gram(whitened.columns, 1);
  const auto full = static_cast<Eigen::Index>(columns.width);
  const Eigen::Index without = full - mine;
  return 0.5 * (tested(even, odd, without) - tested(even, odd, full)) +
         0.5 * (tested(odd, even, without) - tested(odd, even, full));
}

/// A gain goes as one over the noise level, whose estimate scatters: with s^2 the variance of the logarithm of the gain
/// that the uncertain noise parameters cause, its mean is too large by exp(s^2), of which half is the curvature of 1/x
/// and half the bias of a maximum-likelihood level. Parameters that the data hardly know count with one unit of the
/// logarithm.
double SlowSearch::overstated(const BlockColumns& columns, const SlowFit& noise, int mine, double gain) const {
  if (noise.parameters.empty() || noise.information.rows() == 0 || !(gain > 0.0)) {
    return 1.0;
  }
  constexpr double kStep = 0.1;
  Eigen::VectorXd slope(static_cast<Eigen::Index>(noise.parameters.size()));
  for (std::size_t k = 0; k < noise.parameters.size(); ++k) {
    SlowModel moved = noise.model;
    const SlowParameter& parameter = noise.parameters[k];
    double& value = parameter.component == SlowParameter::kWhite ? moved.white
                    : parameter.beta                             ? moved.components[parameter.component].beta
                                                                 : moved.components[parameter.component].level;
    value *= std::exp(kStep);
    const double there = gain_across_folds(columns, moved, mine);
    slope[static_cast<Eigen::Index>(k)] = there > 0.0 ? std::log(there / gain) / kStep : 0.0;
  }
  const Eigen::MatrixXd information =
      noise.information + Eigen::MatrixXd::Identity(noise.information.rows(), noise.information.cols());
  return std::exp(std::min(1.0, slope.dot(information.ldlt().solve(slope))));
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
  order.push_back(mine);
  const BlockColumns columns = columns_with(order);
  const SlowFit noise = given_ ? null_ : fit_slow(series_, columns, widest_base(columns), freedom());
  evidence.heldout_gain = gain_across_folds(columns, noise.model, mine.columns);
  if (!given_) {
    evidence.heldout_gain /= overstated(columns, noise, mine.columns, evidence.heldout_gain);
  }
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
    SlowFreedom last;
    last.white = false;
    last.first_free = start.components.size() - 1;
    const SlowModel extended = fit_slow(train, train_columns, start, last).model;
    SlowModel plain = extended;
    plain.components.pop_back();
    gain += evaluate_slow(test, test_columns, extended).log_likelihood -
            evaluate_slow(test, test_columns, plain).log_likelihood;
    samples += static_cast<double>(test.blocks() * test.block);
  }
  evidence.heldout_gain = gain;
  evidence.heldout_samples = samples;
  evidence.heldout = true;
}

}  // namespace driftlab::investigate
