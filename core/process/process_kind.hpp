#pragma once
/// Turns a value type such as GaussMarkov into a ProcessKind. A value type is an aggregate of doubles, one per declared
/// parameter and in that order, with the functions of white_noise.hpp; `static shape_range(dt_s, samples)` where it has
/// one shape, and `static shape_ranges(dt_s, samples)`, a std::array with a range for each shape, where it has several;
/// `low_frequency(dt_s)` where its density has a limit there; `appearance(dt_s)` where a curve that holds it is worth a
/// word; `ringing(dt_s)` where its Haar coefficients' covariance rings; `kInOctaveSearch = false` where a search over
/// octaves is not to add it; and those of the optional laws of ProcessKind that it has, `add_block_states` and
/// `expected_periodogram` as static functions of slow_law.hpp's form.
#include "core/process/process.hpp"

#include <array>
#include <cassert>
#include <cstddef>
#include <tuple>
#include <utility>

namespace driftlab {

namespace detail {

template <class T, std::size_t... I>
T from_values(std::span<const double> p, std::index_sequence<I...> /*indices*/) {
  return T{p[I]...};
}

template <class T>
T from_values(std::span<const double> p) {
  assert(p.size() == T::kParameters.size());
  return from_values<T>(p, std::make_index_sequence<T::kParameters.size()>{});
}

/// How many parameters follow the level.
template <class T>
inline constexpr std::size_t kShapesOf = T::kParameters.size() - 1;

/// Every shape has a range and there is no range without a shape: fits walk the ranges by the number of shapes.
template <class T>
constexpr bool ranges_every_shape() {
  if constexpr (requires { T::shape_ranges(1.0, 1.0); }) {
    return std::tuple_size_v<decltype(T::shape_ranges(1.0, 1.0))> == kShapesOf<T>;
  } else {
    return kShapesOf<T> == (requires { T::shape_range(1.0, 1.0); } ? 1 : 0);
  }
}

/// The laws of slow_law.hpp take the level and one shape.
template <class T>
constexpr bool slow_laws_know_its_shapes() {
  return !(requires { &T::add_block_states; } || requires { &T::expected_periodogram; }) || kShapesOf<T> <= 1;
}

}  // namespace detail

template <class T>
[[nodiscard]] ProcessKind kind_of() {
  using Values = std::span<const double>;
  static_assert(!T::kParameters.empty() && T::kParameters.size() <= kMostParameters,
                "a process has a level and at most two shapes");
  static_assert(detail::ranges_every_shape<T>(),
                "a process with one shape has shape_range, one with several an array shape_ranges of as many");
  static_assert(detail::slow_laws_know_its_shapes<T>(),
                "a process with add_block_states or expected_periodogram has a level and at most one shape");
  ProcessKind kind;
  kind.name = T::kName;
  kind.symbol = T::kSymbol;
  kind.title = T::kTitle;
  kind.repeats = T::kRepeats;
  kind.parameters = T::kParameters;
  if constexpr (requires { T::kInOctaveSearch; }) {
    kind.in_octave_search = T::kInOctaveSearch;
  }
  kind.haar_variance = [](Values p, double half, double dt_s) {
    return detail::from_values<T>(p).haar_variance(half, dt_s);
  };
  kind.haar_gradient = [](Values p, double half, double dt_s, std::span<double> out) {
    detail::from_values<T>(p).haar_gradient(half, dt_s, out);
  };
  kind.haar_curve = [](Values p, std::span<const double> half, double dt_s, std::span<double> variance,
                       std::span<double> gradient) {
    const T process = detail::from_values<T>(p);
    if constexpr (requires { process.haar_curve(half, dt_s, variance, gradient); }) {
      process.haar_curve(half, dt_s, variance, gradient);  // the type knows what the half lengths share
    } else {
      for (std::size_t j = 0; j < half.size(); ++j) {
        variance[j] = process.haar_variance(half[j], dt_s);
        if (!gradient.empty()) {
          process.haar_gradient(half[j], dt_s, gradient.subspan(j * p.size(), p.size()));
        }
      }
    }
  };
  kind.spectral_density = [](Values p, double f_hz, double dt_s) {
    return detail::from_values<T>(p).spectral_density(f_hz, dt_s);
  };
  kind.autocovariance = [](Values p, double lag, double dt_s) {
    return detail::from_values<T>(p).autocovariance(lag, dt_s);
  };
  kind.variogram = [](Values p, double lag, double dt_s) { return detail::from_values<T>(p).variogram(lag, dt_s); };
  kind.add_haar_cross = [](Values p, double mi, double mj, double dt_s, std::span<const double> lags, double factor,
                           std::span<double> out) {
    const T process = detail::from_values<T>(p);
    if constexpr (requires { process.add_haar_cross(mi, mj, dt_s, lags, factor, out); }) {
      process.add_haar_cross(mi, mj, dt_s, lags, factor, out);  // the type knows a faster way over many lags
    } else {
      for (std::size_t i = 0; i < lags.size(); ++i) {
        out[i] += factor * process.haar_cross(mi, mj, lags[i], dt_s);
      }
    }
  };
  kind.haar_mean = [](Values p, double half, double dt_s) { return detail::from_values<T>(p).haar_mean(half, dt_s); };
  kind.state_space = [](Values p, double dt_s) { return detail::from_values<T>(p).state_space(dt_s); };
  kind.add_path = [](Values p, Random& random, double dt_s, std::span<double> out) {
    detail::from_values<T>(p).add_path(random, dt_s, out);
  };
  if constexpr (requires { T::shape_ranges(1.0, 1.0); }) {
    kind.shape_range = [](std::size_t k, double dt_s, double samples) { return T::shape_ranges(dt_s, samples)[k]; };
  } else if constexpr (requires { T::shape_range(1.0, 1.0); }) {
    kind.shape_range = [](std::size_t, double dt_s, double samples) { return T::shape_range(dt_s, samples); };
  }
  if constexpr (requires(const T process) { process.low_frequency(1.0); }) {
    kind.low_frequency = [](Values p, double dt_s) { return detail::from_values<T>(p).low_frequency(dt_s); };
  }
  if constexpr (requires(const T process) { process.appearance(1.0); }) {
    kind.appearance = [](Values p, double dt_s) -> std::optional<Appearance> {
      return detail::from_values<T>(p).appearance(dt_s);
    };
  }
  if constexpr (requires(const T process) { process.ringing(1.0); }) {
    kind.ringing = [](Values p, double dt_s) { return detail::from_values<T>(p).ringing(dt_s); };
  }
  if constexpr (requires(const T process) { process.white_square(); }) {
    kind.white_square = [](Values p) { return detail::from_values<T>(p).white_square(); };
  }
  if constexpr (requires(const T process) { process.differenced_square(); }) {
    kind.differenced_square = [](Values p) { return detail::from_values<T>(p).differenced_square(); };
  }
  if constexpr (requires(const T process) { process.slope(); }) {
    kind.slope = [](Values p) { return detail::from_values<T>(p).slope(); };
  }
  if constexpr (requires { &T::add_block_states; }) {
    kind.add_block_states = T::add_block_states;
  }
  if constexpr (requires { &T::expected_periodogram; }) {
    kind.expected_periodogram = T::expected_periodogram;
  }
  return kind;
}

}  // namespace driftlab
