#pragma once
/// The noise of one recording as linear states, written once more for fresh_likelihood.cpp: nothing here is shared with
/// the search that it judges.
#include "core/investigate/study/study.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace driftlab::hidden {

/// Whether a list of names holds one; an empty list holds all.
[[nodiscard]] inline bool lists(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// A value of a series, 0 where there is no series.
[[nodiscard]] inline double at(const investigate::Series& values, std::size_t i) {
  return values.empty() ? 0.0 : values[i];
}

/// x' = F x + noise of covariance Q, y = h x + white of variance r g_i^2.
struct States {
  Eigen::MatrixXd f, q, p0;
  Eigen::RowVectorXd h;
  double white = 0.0;  ///< [SI^2], of one sample
  void add(const Eigen::MatrixXd& f2, const Eigen::MatrixXd& q2, const Eigen::MatrixXd& p2,
           const Eigen::RowVectorXd& h2) {
    const auto n = h.size();
    const auto m = h2.size();
    const auto grow = [&](Eigen::MatrixXd& into, const Eigen::MatrixXd& more) {
      Eigen::MatrixXd both = Eigen::MatrixXd::Zero(n + m, n + m);
      both.topLeftCorner(n, n) = into;
      both.bottomRightCorner(m, m) = more;
      into = both;
    };
    grow(f, f2);
    grow(q, q2);
    grow(p0, p2);
    Eigen::RowVectorXd both(n + m);
    both << h, h2;
    h = both;
  }
  void add_scalar(double phi, double step, double start) {
    const auto one = [](double v) { return Eigen::MatrixXd::Constant(1, 1, v); };
    add(one(phi), one(step), one(start), Eigen::RowVectorXd::Ones(1));
  }
};

/// Everything that an effect does beside the mean.
struct Noise {
  States states;
  std::vector<double> white_factor;  ///< of the white part's deviation, per sample
  std::vector<double> whole_factor;  ///< of the whole error
  double nu = 0.0;
  double fraction = 0.0, magnitude = 0.0;
  double step = 0.0;
  double correlation = 0.0;
};

/// What `model` says of the noise of `group`'s column in `recording`. `finest`: the last digit of the file [SI].
[[nodiscard]] Noise noise_of(const investigate::Baseline& model, const investigate::StudyRecording& recording,
                             const investigate::ChannelGroup& group, double finest);

}  // namespace driftlab::hidden
