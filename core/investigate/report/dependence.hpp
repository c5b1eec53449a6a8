#pragma once
/// What no spectrum and no mean shows: noise that is white and yet not independent, slow errors that are not Gaussian,
/// and axes that are loud together.
///
/// All tests look at normal scores s of the innovations (remains.hpp), which are standard normal where the model is
/// right. With h = (s^2 - 1)/sqrt(2), uncorrelated with s and of unit variance, and n pairs of samples k apart, k from
/// 1 to 8, the correlations
///   r = mean of a_t b_(t-k),   (a, b) = (h, h), (s, h), (h, s)
/// are normal with variance 1/n, and x = n r^2/2. Noise whose loudness depends on what it was a moment ago, as of
/// GARCH, has the first; one that leans to a side after large errors, as a threshold autoregression, the second. Beside
/// quantization noise it is not asked: differenced uniform noise is not independent, and known not to be.
///
/// Means of m = 4, 16, 64, ... scores in a row are normal too. Of at least 200 of them the skewness and the kurtosis
/// are turned into a normal z each, by D'Agostino (1970) and by Anscombe and Glynn (1983), and x = z^2/2: slow errors
/// that go to one side, or come as shocks.
///
/// Of two axes of a recording, of which the correlation is rho, the correlation of h is rho^2; what it exceeds that by
/// is tested alike, with k = 0.
#include "core/investigate/report/remainder.hpp"
#include "core/investigate/study/series.hpp"

#include <string>
#include <vector>

namespace driftlab::investigate {

/// The strongest correlation of what a sample shows with samples before. Samples that are not in use say nothing. O(n).
[[nodiscard]] Remainder dependence_over_time(const std::vector<double>& score, const std::vector<unsigned char>& used,
                                             const std::string& name);

/// The strongest departure of means of scores from a Gaussian distribution. O(n).
[[nodiscard]] Remainder slow_distribution(const std::vector<double>& score, double dt_s, const std::string& name);

/// The correlation of the sizes of two series of unit variance beyond that of the series. O(n).
[[nodiscard]] Remainder shared_loudness(const Series& a, const Series& b, const std::string& name);

}  // namespace driftlab::investigate
