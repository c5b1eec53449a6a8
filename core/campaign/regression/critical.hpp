#pragma once
/// How large a difference unchanged noise would show: the joint distribution of all tests, its critical values, and
/// what a comparison of this design can show.
///
/// Draws of Z = C(h kL, h kS)^1/2 z: kL, kS from their posterior, h^2 = sum_r w_r^2 h_r^2 / sum_r w_r^2 over the
/// sessions of both arms with the weights of theta, h_r^2 = (v - 2)/chi-square(v), for sessions scatter with tails like
/// Student's t, v = `session_df`. In arms of equal size h^2 is the mean of the h_r^2, as spec/regression.md has it;
/// where five sessions stand against one, that one's tails are nearly all. All tests jointly, so that axes, overlapping
/// scales and levels cost what they are worth. With s the share of a look (spec/regression.md, section 8): c_max =
/// quantile 1 - s (alpha - 0.01) of max Z/se, c_1 = quantile 1 - s alpha of one Z/se.
///   lower = theta - c_max se (all at once),  upper = theta + c_1 se (one alone)   (6)
///
/// The gate. What must be shown to be within its margin: scales up to `through_s` and the gated levels of all units,
/// and longer scales in rising tau, all units together, while the design passes an unchanged device with probability
/// `design_power`. The design knows lengths, sessions and K, not theta.
#include "core/campaign/regression/contrast.hpp"

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

namespace driftlab::regression {

struct TestSettings {
  double alpha = 0.05;        ///< of the run
  double event_alpha = 0.01;  ///< the part of it that checks of events take from c_max
  double look_share = 0.6;    ///< s
  double prior_df = 4.0;      ///< of kL and kS
  int session_df = 5;         ///< v
  double through_s = 1.0;     ///< scales to here must be shown
  double design_power = 0.8;
  bool fail_on_worse = false;  ///< fail where lower > 0 and the estimate is above the margin
  bool two_sided = false;      ///< an improvement beyond the margin fails
  std::size_t draws = 4000;
  std::uint64_t seed = 1;

  /// A run of this level; the checks of events take a fifth of it (spec/regression.md).
  void set_level(double level) {
    alpha = level;
    event_alpha = 0.2 * level;
  }
};

struct Critical {
  double c_max = 0.0;
  double c_1 = 0.0;
  Eigen::MatrixXd draws;  ///< Z/se, tests x draws
};

/// `settings.draws` draws of stream 0 of `settings.seed`. Empty contrasts give zeros.
[[nodiscard]] Critical critical_values(const Contrast& contrast, const SessionScatter& scatter,
                                       const TestSettings& settings);

struct Gate {
  std::vector<bool> gated;  ///< per test
  double scope_s = 0.0;     ///< largest tau that all units are gated to
  double power = 0.0;       ///< share of unchanged devices that pass
};

[[nodiscard]] Gate choose_gate(const Design& design, const Contrast& contrast, const Critical& critical,
                               const TestSettings& settings);

/// The designs that would let an unchanged device pass with probability `design_power`, with the factors at their
/// posterior means. Empty: none of the tried designs would.
struct Needs {
  std::optional<std::size_t> sessions_per_arm;  ///< up to 30, of the mean length
  std::optional<double> length_factor;          ///< 2, 4, ... 64 times as long, as many sessions
};

/// `stop` is polled before each trial; after a stop the result must not be used.
[[nodiscard]] Needs what_would_decide(const Design& design, const Contrast& contrast, const SessionScatter& scatter,
                                      const Gate& gate, const TestSettings& settings, const std::stop_token& stop = {});

}  // namespace driftlab::regression
