#pragma once
/// Total variance and Theo1 at the longest averaging times, corrected for their bias, with intervals.
///
/// Bias. What either is in the mean, over the Allan variance, is linear in the noise: it is formed process by process
/// over the mixture that was fitted to the whole curve (variance_intervals.hpp), not from one noise type.
///   total:  1 - a tau/T with T the length of the record; a = 0, 1/(3 ln 2), 3/4 for white noise, flicker noise and
///           random walk (Greenhall, Howe and Percival 1999; NIST SP 1065 table 7), interpolated in the slope of the
///           Allan variance of a Gauss-Markov process; noise rougher than white counts as white, a drift as a walk
///   Theo1:  the exact expectation of its double sum for each process, from a generalised covariance of its phase
/// Degrees of freedom. Known for the same three: total b T/tau - c with (b, c) = (1.5, 0), (1.168, 0.222), (0.927,
/// 0.358); Theo1 NIST SP 1065 table 8 (Howe and Tasset 2005), at least 0.85 T/tau. They are interpolated in the slope
/// of the Allan variance of the mixture at tau: -1, 0 and 1. Intervals are chi-square with these degrees, at least one.
/// The expectation of Theo1 lies between 0.37 (random walk) and 1 (white) of the Allan variance, and how much of either
/// there is at the longest tau is known no better than the record knows that tau: a relative variance of 1.04 over the
/// degrees of the total variance there is added (fitted to simulations of white noise, flicker noise, random walk and
/// white noise with a random walk). Where the noise type is known Theo1 promises more degrees of freedom; here that
/// gain is lost to the added variance, and what remains of Theo1 is its reach: tau up to three quarters of the record.
#include "core/process/model.hpp"
#include "core/signal/estimate.hpp"

#include <span>
#include <vector>

namespace driftlab {

/// Estimates of the Allan variance [unit^2], tau rising.
struct LongTauCurve {
  std::vector<double> tau_s;
  std::vector<double> variance;
  std::vector<Interval> ci95;
  std::vector<double> edf;
};

/// d ln AVAR/d ln tau of a mixture at tau.
[[nodiscard]] double allan_slope(const Model& mixture, double tau_s, double dt_s);

/// At tau = T/2, T/3, T/4, T/6, ... down to T/64 (16 samples at least). `samples` without gaps, at least 32 of them
/// (else empty); the result is in units of `unit` squared, and so are the variances of the mixture that `intervals`
/// hold.
[[nodiscard]] LongTauCurve total_curve(std::span<const double> samples, double pivot, double unit_square,
                                       const Model& mixture, double dt_s);

/// At tau = 3/4 T, 9/16 T, 3/8 T, ... down to 3/4 T/64: twice as far as the Allan variance and further than total.
[[nodiscard]] LongTauCurve theo1_curve(std::span<const double> samples, double pivot, double unit_square,
                                       const Model& mixture, double dt_s);

}  // namespace driftlab
