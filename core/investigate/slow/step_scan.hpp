#pragma once
/// Steps of the mean at every block of a recording, at a fixed noise model, and what the choice among them costs.
///
/// Z(t), the standardised amplitude of a step at t, is standard normal at each t where there is none; its neighbours
/// are correlated by rho(t), and how fast it forgets depends on the noise: within 1/beta of a Gauss-Markov process that
/// rises above the white noise, never in white noise alone. The largest of many is beyond u with probability
///   P ~ 2 u phi(u) sum over t of (1 - rho) nu(sqrt(2 u^2 (1 - rho))),
/// nu the correction for a grid (Siegmund and Yakir, The Statistics of Gene Mapping, 2007, with their closed
/// approximation of it). A single look at a gain g = v^2 has P ~ 2 phi(v) / v: equal chances make the search worth
///   u^2 - v^2 ~ 2 ln(u v sum (1 - rho) nu),
/// for five minutes in blocks of 1/5 s: 5 for white noise, 8 to 10 with Gauss-Markov processes or a random walk
/// (tests/unit/investigate/step_scan_test.cpp measures the chances).
#include "core/investigate/slow/slow_model.hpp"

#include <Eigen/Core>

#include <vector>

namespace driftlab::investigate {

/// Steps at every block of a recording. W'z gives all inner products by running sums; the norms of a whitened step and
/// of a whitened impulse vary smoothly and are computed at 24 places.
class StepScan {
 public:
  /// `columns`: data, then regressors. O(blocks) per recording and regressor.
  StepScan(const BlockSeries& series, const SlowModel& model, const BlockColumns& columns);
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
  Eigen::MatrixXd inverse_;                                 ///< (B'B)^-1
  std::vector<std::vector<std::vector<double>>> tail_sum_;  ///< recording, column (0: residual), block
};

/// 2 ln of how much likelier a gain is by the best of all places than by one of them; 0 or more.
[[nodiscard]] double cost_of_search(const std::vector<double>& turnover, double gain);

/// The series and the model of one recording alone.
struct SingleRecording {
  BlockSeries series;
  SlowModel model;
};
[[nodiscard]] SingleRecording take_recording(const BlockSeries& series, const SlowModel& model, std::size_t r);

}  // namespace driftlab::investigate
