#include "core/investigate/screening.hpp"

#include "core/process/dense.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {
namespace {

constexpr std::size_t kPlaces = 24;
constexpr std::size_t kMargin = 5;  ///< blocks at either end where a step is not sought

Eigen::MatrixXd gram_of(const std::vector<double>& rows, std::size_t width) {
  const auto w = static_cast<Eigen::Index>(width);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> m(
      rows.data(), static_cast<Eigen::Index>(rows.size()) / w, w);
  return m.transpose() * m;
}

}  // namespace

ScopedGram::ScopedGram(const BlockColumns& whitened, std::size_t fixed) : fixed_(static_cast<Eigen::Index>(fixed)) {
  const auto width = static_cast<Eigen::Index>(whitened.width);
  all_ = Eigen::MatrixXd::Zero(width, width);
  for (const auto& rows : whitened.rows) {
    gram_.push_back(gram_of(rows, whitened.width));
    all_ += gram_.back();
  }
}

double ScopedGram::gain(const std::vector<std::size_t>& scope) const {
  const Eigen::Index columns = all_.cols() - fixed_;
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(columns, fixed_);
  Eigen::MatrixXd own = Eigen::MatrixXd::Zero(columns, columns);
  for (const std::size_t r : scope) {
    cross += gram_[r].bottomLeftCorner(columns, fixed_);
    own += gram_[r].bottomRightCorner(columns, columns);
  }
  const Eigen::MatrixXd before = own;
  Eigen::VectorXd data = cross.col(0);
  if (fixed_ > 1) {
    Eigen::MatrixXd b = all_.block(1, 1, fixed_ - 1, fixed_ - 1);
    b.diagonal() *= 1.0 + 1e-12;
    const Eigen::MatrixXd x = cross.rightCols(fixed_ - 1);
    Eigen::MatrixXd right(fixed_ - 1, columns + 1);
    right << x.transpose(), all_.col(0).segment(1, fixed_ - 1);
    const Eigen::MatrixXd explained = x * solve_symmetric(b, right);
    own -= explained.leftCols(columns);
    data -= explained.col(columns);
  }
  // What lies in the span of the regressors has no gain: the remainder must be more than rounding.
  for (Eigen::Index i = 0; i < columns; ++i) {
    if (!(own(i, i) > 1e-6 * before(i, i)) || !(before(i, i) > 0.0)) {
      return 0.0;
    }
  }
  return data.dot(solve_symmetric(own, data));
}

ScopedGram::Pair ScopedGram::pair_in(std::size_t r, Eigen::Index from) const {
  const Eigen::MatrixXd& g = gram_[r];
  Eigen::Matrix2d own = g.block<2, 2>(from, from);
  Eigen::Vector2d data = g.block<2, 1>(from, 0);
  const double before = own.trace();
  if (fixed_ > 1) {
    Eigen::MatrixXd b = all_.block(1, 1, fixed_ - 1, fixed_ - 1);
    b.diagonal() *= 1.0 + 1e-12;
    b.diagonal().array() += 1e-300;
    const Eigen::MatrixXd x = g.block(from, 1, 2, fixed_ - 1);
    Eigen::MatrixXd right(fixed_ - 1, 3);
    right << x.transpose(), all_.col(0).segment(1, fixed_ - 1);
    const Eigen::MatrixXd explained = x * solve_symmetric(b, right);
    own -= explained.leftCols<2>();
    data -= explained.col(2);
  }
  // A recording at rest has constant columns, which the bias holds already.
  if (!(before > 0.0) || own.determinant() < 1e-6 * before * before) {
    return {};
  }
  return {data.dot(own.inverse() * data), 0.5 * own.trace()};
}

namespace {

/// -2 ln of the tail probability of T for moduli of information n and gains X.
double surprise_of(const std::vector<double>& gain, const std::vector<double>& information) {
  double total = 0.0;
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t r = 0; r < gain.size(); ++r) {
    total += information[r];
    sum += std::sqrt(gain[r] * information[r]);
    count += information[r] > 0.0 ? 1.0 : 0.0;
  }
  if (!(total > 0.0)) {
    return 0.0;
  }
  const double s2 = sum * sum / total;
  double log_p = -0.5 * s2 + 0.5 * (count - 1.0) * std::log(6.283185307179586 * std::max(s2, 1.0));
  for (const double n : information) {
    log_p += n > 0.0 ? 0.5 * std::log(n / total) : 0.0;
  }
  return -2.0 * std::min(0.0, log_p);
}

}  // namespace

double ScopedGram::surprise_of_common_amplitude(const std::vector<std::size_t>& scope) const {
  std::vector<double> gain;
  std::vector<double> information;
  for (const std::size_t r : scope) {
    const Pair pair = pair_in(r, fixed_);
    gain.push_back(pair.gain);
    information.push_back(pair.information);
  }
  return surprise_of(gain, information);
}

double ScopedGram::surprise_of_members(const std::vector<std::size_t>& members) const {
  std::vector<double> gain;
  std::vector<double> information;
  for (std::size_t k = 0; k < members.size(); ++k) {
    const Pair pair = pair_in(members[k], fixed_ + 2 * static_cast<Eigen::Index>(k));
    gain.push_back(pair.gain);
    information.push_back(pair.information);
  }
  return surprise_of(gain, information);
}

double ScopedGram::gain_of_member(std::size_t r, const std::vector<std::size_t>& members) const {
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (members[k] == r) {
      return pair_in(r, fixed_ + 2 * static_cast<Eigen::Index>(k)).gain;
    }
  }
  return 0.0;
}

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

StepScan::StepScan(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns)
    : series_(series), model_(model) {
  const Whitened whitened = whiten(series, model, columns);
  const auto p = static_cast<Eigen::Index>(columns.width) - 1;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(p + 1, p + 1);
  for (const auto& rows : whitened.columns.rows) {
    gram += gram_of(rows, columns.width);
  }
  Eigen::MatrixXd b = gram.bottomRightCorner(p, p);
  b.diagonal() *= 1.0 + 1e-12;
  for (Eigen::Index k = 0; k < p; ++k) {
    b(k, k) = b(k, k) > 0.0 ? b(k, k) : 1.0;  // a regressor without input
  }
  inverse_ = inverse(b);
  const Eigen::VectorXd amplitude = inverse_ * gram.col(0).tail(p);
  for (std::size_t r = 0; r < series.recordings.size(); ++r) {
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

std::vector<double> StepScan::gains(std::size_t r) const {
  const std::size_t blocks = series_.recordings[r].mean.size();
  std::vector<double> result(blocks, 0.0);
  if (blocks < 4 * kMargin) {
    return result;
  }
  const SingleRecording single = take_recording(series_, model_, r);
  BlockColumns steps = BlockColumns::zeros(single.series, kPlaces);
  std::vector<double> place(kPlaces);
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const double share = static_cast<double>(k) / (kPlaces - 1.0);
    // Denser towards both ends, where the norm changes fastest.
    place[k] = std::round((0.5 - 0.5 * std::cos(share * 3.14159265358979)) * static_cast<double>(blocks - 1));
    for (auto i = static_cast<std::size_t>(place[k]); i < blocks; ++i) {
      steps.rows[0][i * kPlaces + k] = 1.0;
    }
  }
  const Whitened whitened = whiten(single.series, single.model, steps);
  std::vector<double> norm(kPlaces, 0.0);
  for (std::size_t i = 0; i < blocks; ++i) {
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const double z = whitened.columns.rows[0][i * kPlaces + k];
      norm[k] += z * z;
    }
  }
  const auto p = inverse_.rows();
  Eigen::VectorXd cross(p);
  std::size_t k = 0;
  for (std::size_t i = kMargin; i + kMargin < blocks; ++i) {
    while (k + 2 < kPlaces && static_cast<double>(i) > place[k + 1]) {
      ++k;
    }
    const double width = std::max(1.0, place[k + 1] - place[k]);
    const double own = norm[k] + (norm[k + 1] - norm[k]) * (static_cast<double>(i) - place[k]) / width;
    for (Eigen::Index c = 0; c < p; ++c) {
      cross[c] = tail_sum_[r][static_cast<std::size_t>(c) + 1][i];
    }
    const double d = own - cross.dot(inverse_ * cross);
    if (d > 1e-6 * own && d > 0.0) {
      const double n = tail_sum_[r][0][i];
      result[i] = n * n / d;
    }
  }
  return result;
}

StepScan::Best StepScan::best_in(std::size_t r) const {
  const std::vector<double> gain = gains(r);
  Best best;
  for (std::size_t i = 0; i < gain.size(); ++i) {
    if (gain[i] > best.gain) {
      best = {i, gain[i]};
    }
  }
  return best;
}

}  // namespace driftlab::investigate
