#include "core/investigate/slow/screening.hpp"

#include "core/process/dense.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace driftlab::investigate {

ScopedGram::ScopedGram(const BlockColumns& whitened, std::size_t fixed) : fixed_(static_cast<Eigen::Index>(fixed)) {
  const auto width = static_cast<Eigen::Index>(whitened.width);
  all_ = Eigen::MatrixXd::Zero(width, width);
  for (std::size_t r = 0; r < whitened.rows.size(); ++r) {
    gram_.push_back(gram_of(whitened, r));
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

}  // namespace driftlab::investigate
