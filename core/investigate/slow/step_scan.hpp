#pragma once
/// Scan for a step of the mean at every block of a recording, at a fixed noise model, and the penalty for having
/// searched.
///
/// Z(t), the standardised amplitude of a step at t, is standard normal at every t if there is no step. Neighbouring
/// values have the correlation rho(t). How fast the correlation decays depends on the noise: within 1/beta of a
/// Gauss-Markov process that stands out above the white noise, and never in white noise alone. The largest of many
/// values exceeds u with probability
///   P ~ 2 u phi(u) sum over t of (1 - rho) nu(sqrt(2 u^2 (1 - rho))),
/// where nu is the correction for a grid (Siegmund and Yakir, The Statistics of Gene Mapping, 2007, with their closed
/// approximation of it). A gain g = v^2 at one given place has P ~ 2 phi(v) / v. With equal probabilities the search
/// costs
///   u^2 - v^2 ~ 2 ln(u v sum (1 - rho) nu).
/// For five minutes in blocks of 1/5 s that is 5 for white noise, and 8 to 10 with Gauss-Markov processes or a random
/// walk (tests/unit/investigate/step_scan_test.cpp measures the probabilities).
#include "core/investigate/slow/slow_model.hpp"

#include <Eigen/Core>

#include <stop_token>
#include <vector>

namespace driftlab::investigate {

/// Steps at every block of a recording. W'z gives all inner products by running sums; the norms of a whitened step and
/// of a whitened impulse vary smoothly and are computed at 24 places.
class StepScan {
 public:
  /// `columns`: data, then regressors. O(blocks) per recording and regressor. Once `stop` is asked no step is found.
  StepScan(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns, std::stop_token stop = {});
  struct Best {
    std::size_t block = 0;
    double gain = 0.0;
    double search_cost = 0.0;  ///< what the choice of the block is worth, in twice the log likelihood
  };
  [[nodiscard]] Best best_in(std::size_t r) const;
  struct Steps {
    std::vector<double> gain;      ///< of a step at each block (0 near the ends)
    std::vector<double> turnover;  ///< 1 - correlation of Z with the next block's; 0 where no step is sought
  };
  [[nodiscard]] Steps steps_in(std::size_t r) const;

 private:
  const BlockSeries& series_;
  const SlowModel& model_;
  std::stop_token stop_;
  Eigen::MatrixXd inverse_;                                 ///< (B'B)^-1
  std::vector<std::vector<std::vector<double>>> tail_sum_;  ///< recording, column (0: residual), block
};

/// 2 ln of the ratio of the probability that the best of all places has this gain to the probability that one given
/// place has it; 0 or more.
[[nodiscard]] double cost_of_search(const std::vector<double>& turnover, double gain);

/// The series and the model of one recording alone.
struct SingleRecording {
  BlockSeries series;
  SlowModel model;
};
[[nodiscard]] SingleRecording take_recording(const BlockSeries& series, const SlowModel& model, std::size_t r);

}  // namespace driftlab::investigate
