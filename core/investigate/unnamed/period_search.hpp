#pragma once
/// The period with which something comes again, whatever its shape is.
///
/// A train of short pulses has many weak lines in place of one strong one: none of them stands out, their sum does.
/// With p(f) the ordinates of the periodogram of white noise over their mean (exponential, of mean 1), the comb
///   S_K(f0) = sum over k = 1 ... K of min(p(k f0), 20)
/// is at most a gamma variable of shape K, so that under white noise (Chernoff)
///   -ln P(S_K >= s) >= s - K - K ln(s/K),   s > K.
/// Combs of K = 4, 8, ... 256 teeth are moved over all fundamentals in steps by which the last tooth moves half of a
/// line's width; the best is the comb of the least chance. The cap keeps one line from passing for a comb.
#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>

namespace driftlab::investigate {

struct FoundPeriod {
  double period_s = 0.0;
  std::size_t teeth = 0;  ///< of the comb: what comes again has about twice as many details
  double tried = 1.0;     ///< combs that are not each other's neighbours
};

/// The likeliest period of white noise `at(0) ... at(n - 1)`, of any size, 0 where there is no value: at most an eighth
/// of the recording, or of its first 2^18 values. Nothing where no comb has a chance below one in those tried.
/// O(512 n).
[[nodiscard]] std::optional<FoundPeriod> find_period(std::size_t n, double dt_s,
                                                     const std::function<double(std::size_t)>& at,
                                                     const std::stop_token& stop = {});

}  // namespace driftlab::investigate
