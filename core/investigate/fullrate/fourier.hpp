#pragma once
/// Discrete Fourier transforms of whole recordings, in little more memory than their results take.
///
/// A library's transform of n values holds the values, as many complex factors, and half as many complex results at
/// once. For a day at 100 Hz that is a third of a gigabyte, and a whole one if the series is padded to a power of two.
/// Here the values are asked for one by one. A long transform is divided into four of a quarter of its length
/// (decimation in time, Cooley and Tukey 1965), each of these into four again, until the rest is short enough for a
/// library to hold its factors; the factors that join the parts are worked out where they are used. The joins are those
/// of Eigen's transform, in its order, so that every value is equal to Eigen's to the bit.
#include <complex>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <vector>

namespace driftlab::investigate {

/// Complex length up to which a transform is left to the library: 16 MiB of values and of factors.
inline constexpr std::size_t kWholeTransform = std::size_t{1} << 20U;

/// Transform of the real values at(0) ... at(length - 1): length/2 + 1 complex ones. Memory: 8 bytes a value for the
/// result, 32 bytes for each of the `whole` (a quarter of a longer part at most); 48 bytes a value where `length` is no
/// multiple of 4. O(length log length). Once `stop` is asked, of which longer transforms take note, the values mean
/// nothing.
[[nodiscard]] std::vector<std::complex<double>> half_spectrum(std::size_t length,
                                                              const std::function<double(std::size_t)>& at,
                                                              std::size_t whole = kWholeTransform,
                                                              const std::stop_token& stop = {});

}  // namespace driftlab::investigate
