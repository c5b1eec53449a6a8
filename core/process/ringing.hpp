#pragma once
/// What a fast process does to the covariance of Haar coefficients near the lags at which the ends of two filters meet.

namespace driftlab {

/// The covariance gamma_ij(h) of the coefficients of two Haar filters has kinks where an end of one filter meets an end
/// of the other. Of white, Gauss-Markov and slower processes it is smooth in between. A process that oscillates, or
/// whose autocovariance ends at a lag, has a structure of its own size around each kink, which sums over lags have to
/// resolve.
struct Ringing {
  double reach = 0.0;   ///< lags from a kink within which it is there, in samples
  double length = 1.0;  ///< lags over which a polynomial of degree five follows it
};

}  // namespace driftlab
