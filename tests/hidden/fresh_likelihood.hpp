#pragma once
/// The log likelihood of a simulation model on a study, written without the search, the templates or the filters of the
/// product: what decides whether a stored model is worth what an investigation claims for it.
///
/// A channel's error is (white + slow processes) with one constant bias, which is profiled out, and the effects of
/// spec/causes.md by their equations. One dense Kalman filter at full rate holds white noise, Gauss-Markov processes,
/// random walks, flicker noise (12 Gauss-Markov states), differenced noise, a constant per recording and a Butterworth
/// low-pass; variances may differ from sample to sample. Tails are those of the innovations. A free phase is integrated
/// out. The output's lattice is scored without the digits that it leaves out, ln(step) per sample, which is a fact of
/// the file; samples that absence, freezing or clipping spoil have no say, and their causes none either.
#include "tests/hidden/simulated_study.hpp"

namespace driftlab::hidden {

/// Whether this likelihood has the equation of a cause, or leaves the samples out that it spoils.
[[nodiscard]] bool has_equation(const std::string& cause);

/// Sum over all channels of the study [nat]. `facts`: the effects by which samples are known to be spoilt.
[[nodiscard]] double log_likelihood(const investigate::Baseline& model, const SimulatedStudy& data,
                                    const std::vector<Hidden>& facts);

}  // namespace driftlab::hidden
