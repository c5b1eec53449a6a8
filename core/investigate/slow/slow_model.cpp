#include "core/investigate/slow/slow_model.hpp"

#include "core/investigate/slow/whitening_walk.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace driftlab::investigate {
namespace {

/// Kalman gains over the blocks of one pattern; the last entry holds for all blocks after it where `steady`.
struct Gains {
  std::size_t states = 0;
  std::vector<double> gain;      ///< blocks x states
  std::vector<double> inv_sd;    ///< 1/sqrt(S); 0 for an empty block
  std::vector<double> variance;  ///< S
  [[nodiscard]] std::size_t at(std::size_t b) const { return std::min(b, inv_sd.size() - 1); }
};

Gains compute_gains(const BlockStates& states, const BlockRecording& blocks) {
  Gains gains;
  gains.states = states.phi.size();
  const std::size_t count = blocks.filled.size();
  gains.gain.reserve(std::min<std::size_t>(count, 1024) * gains.states);
  const bool uniform =
      std::all_of(blocks.filled.begin(), blocks.filled.end(), [&](double f) { return f == blocks.filled[0]; });
  WhiteningWalk walk(states, uniform, 0);
  for (std::size_t b = 0; b < count && !walk.settled(); ++b) {
    walk.next(blocks.filled[b]);
    gains.gain.insert(gains.gain.end(), walk.gain().begin(), walk.gain().end());
    gains.variance.push_back(walk.variance());
    gains.inv_sd.push_back(walk.inv_sd());
  }
  return gains;
}

}  // namespace

SlowComponent slow_component(const ProcessKind& kind, double square, double shape, std::vector<unsigned char> in) {
  Process process{&kind, {std::sqrt(square)}};
  if (kind.has_shape()) {
    process.parameters.push_back(shape);
  }
  return {std::move(process), std::move(in)};
}

void raise_square(SlowComponent& component, double square) {
  double& level = component.process.parameters[0];
  level = std::max(level, std::sqrt(square));
}

double at_record_length(const ProcessKind& kind, double variance, double longest_s) {
  double square = variance;
  for (int halves = kind.parameters[0].second_power_halves; halves < 0; ++halves) {
    square /= longest_s;
  }
  return square;
}

std::size_t SlowModel::count(const ProcessKind& kind) const {
  return static_cast<std::size_t>(std::count_if(components.begin(), components.end(),
                                                [&](const SlowComponent& c) { return c.process.kind == &kind; }));
}

BlockColumns BlockColumns::zeros(const BlockSeries& series, std::size_t width) {
  BlockColumns columns;
  columns.width = width;
  for (const BlockRecording& recording : series.recordings) {
    columns.rows.emplace_back(recording.mean.size() * width, 0.0);
  }
  return columns;
}

Eigen::MatrixXd gram_of(const BlockColumns& columns, std::size_t r) {
  const auto width = static_cast<Eigen::Index>(columns.width);
  const std::vector<double>& rows = columns.rows[r];
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> m(
      rows.data(), static_cast<Eigen::Index>(rows.size()) / width, width);
  return m.transpose() * m;
}

BlockStates block_states(const SlowModel& model, const Blocks& blocks, std::size_t r) {
  BlockStates states;
  states.white = model.white * (model.white_scale.empty() ? 1.0 : model.white_scale[r]) / blocks.block_s();
  for (const SlowComponent& component : model.components) {
    if (component.acts_in(r) && component.process.square() > 0.0) {
      component.kind().add_block_states(component.process.square(), component.process.only_shape(), blocks, states);
    }
  }
  return states;
}

BlockStates block_states(const SlowModel& model, const BlockSeries& series, std::size_t r) {
  return block_states(model, Blocks{series.dt_s, series.block, series.recordings[r].start_s, series.longest_s()}, r);
}

Whitened whiten(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns) {
  Whitened result;
  const std::size_t width = columns.width;
  result.columns.width = width;
  result.columns.rows.resize(series.recordings.size());
  result.log_var.reserve(series.blocks());
  struct Known {
    std::size_t pattern;
    BlockStates states;
    std::unique_ptr<Gains> gains;
  };
  std::vector<Known> known;
  std::vector<double> state;
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
    const BlockRecording& blocks = series.recordings[r];
    BlockStates states = block_states(model, series, r);
    const Gains* gains = nullptr;
    for (const Known& k : known) {
      if (k.pattern == blocks.pattern && k.states.phi == states.phi && k.states.q == states.q &&
          k.states.p0 == states.p0 && k.states.white == states.white) {
        gains = k.gains.get();
      }
    }
    if (gains == nullptr) {
      known.push_back({blocks.pattern, states, std::make_unique<Gains>(compute_gains(states, blocks))});
      gains = known.back().gains.get();
    }
    const std::size_t m = states.phi.size();
    state.assign(m * width, 0.0);
    std::vector<double>& out = result.columns.rows[r];
    out.assign(blocks.mean.size() * width, 0.0);
    const double* in = columns.rows[r].data();
    const BlockWhitening whiten_one = block_whitening(m);
    double last_log = 0.0;
    std::size_t last_at = static_cast<std::size_t>(-1);
    for (std::size_t b = 0; b < blocks.mean.size(); ++b) {
      const std::size_t at = gains->at(b);
      const double inv_sd = gains->inv_sd[at];
      whiten_one(m, width, in + b * width, states.phi.data(), gains->gain.data() + at * m, inv_sd, state.data(),
                 out.data() + b * width);
      if (inv_sd > 0.0) {
        if (at != last_at) {
          last_log = std::log(gains->variance[at]);
          last_at = at;
        }
        result.sum_log_var += last_log;
        ++result.used;
      }
      result.log_var.push_back(inv_sd > 0.0 ? last_log : 0.0);
    }
  }
  return result;
}

std::vector<double> whiten_transposed(const BlockSeries& series, const SlowModel& model, std::size_t r,
                                      std::span<const double> whitened) {
  const BlockRecording& blocks = series.recordings[r];
  const BlockStates states = block_states(model, series, r);
  const Gains gains = compute_gains(states, blocks);
  const std::size_t m = states.phi.size();
  // x_{b+1} = phi (x_b + K_b v_b), v_b = y_b - 1'x_b, z_b = v_b / sd_b. Adjoint, backwards with l = d/dx_{b+1}:
  // d/dv_b = z*_b / sd_b + K_b' phi l;  d/dy_b = that;  d/dx_b = phi l - 1 d/dv_b.
  std::vector<double> result(whitened.size());
  std::vector<double> adjoint(m, 0.0);
  for (std::size_t b = whitened.size(); b-- > 0;) {
    const std::size_t at = gains.at(b);
    const double* k = gains.gain.data() + at * m;
    double dv = 0.0;
    if (gains.inv_sd[at] > 0.0) {
      dv = whitened[b] * gains.inv_sd[at];
      for (std::size_t i = 0; i < m; ++i) {
        dv += k[i] * states.phi[i] * adjoint[i];
      }
    }
    result[b] = dv;
    for (std::size_t i = 0; i < m; ++i) {
      adjoint[i] = states.phi[i] * adjoint[i] - dv;
    }
  }
  return result;
}

}  // namespace driftlab::investigate
