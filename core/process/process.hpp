#pragma once
/// A stochastic process as all of driftlab uses it: a kind from the registry, and the values of its parameters.
///
/// All laws are in the unit of the channel: a `Process` with level 1 in rad/s gives variances in (rad/s)^2. `half` is
/// the half length m of a Haar filter in samples (scale n = 2m, Allan tau = m dt). It may be any whole number up to
/// 2^40, held in a double.
#include "core/process/appearance.hpp"
#include "core/process/low_frequency.hpp"
#include "core/process/parameter.hpp"
#include "core/process/random.hpp"
#include "core/process/ringing.hpp"
#include "core/process/slow_law.hpp"
#include "core/process/state_space.hpp"

#include <cassert>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab {

/// The laws of one kind of process, made from its value type by `kind_of` (core/process/registry.cpp). Each function
/// takes the parameter values in declaration order. A law that does not exist for a kind returns nothing.
struct ProcessKind {
  std::string_view name;    ///< as in documents: white_noise, ...
  std::string_view symbol;  ///< as in model names: WN, ...
  std::string_view title;   ///< for people
  bool repeats = false;     ///< may a model hold several of them?
  /// May a stepwise search over octave scales add it? Octaves alone do not tell filters, resonances and power laws from
  /// one another: those take part where the spectrum shows them, or where a model is asked for by name.
  bool in_octave_search = true;
  std::span<const ParameterSpec> parameters;

  double (*haar_variance)(std::span<const double> p, double half, double dt_s) = nullptr;
  void (*haar_gradient)(std::span<const double> p, double half, double dt_s, std::span<double> out) = nullptr;
  /// Both at once for many half lengths, in a fraction of the time where the kind knows what they share. `gradient` is
  /// empty, or holds the derivatives by each parameter, half length by half length.
  void (*haar_curve)(std::span<const double> p, std::span<const double> half, double dt_s, std::span<double> variance,
                     std::span<double> gradient) = nullptr;
  std::optional<double> (*spectral_density)(std::span<const double> p, double f_hz, double dt_s) = nullptr;
  std::optional<double> (*autocovariance)(std::span<const double> p, double lag, double dt_s) = nullptr;
  double (*variogram)(std::span<const double> p, double lag, double dt_s) = nullptr;
  /// One value per lag, added times `factor` to `out`.
  void (*add_haar_cross)(std::span<const double> p, double mi, double mj, double dt_s, std::span<const double> lags,
                         double factor, std::span<double> out) = nullptr;
  double (*haar_mean)(std::span<const double> p, double half, double dt_s) = nullptr;
  std::optional<StateSpace> (*state_space)(std::span<const double> p, double dt_s) = nullptr;
  void (*add_path)(std::span<const double> p, Random& random, double dt_s, std::span<double> out) = nullptr;
  /// Where a record of `samples` can tell shape k, that is parameter k + 1; k < shape_count().
  std::pair<double, double> (*shape_range)(std::size_t k, double dt_s, double samples) = nullptr;

  /// Null where the density has no limit at low frequencies, or none but zero.
  LowFrequencyDensity (*low_frequency)(std::span<const double> p, double dt_s) = nullptr;

  /// What of the covariances of Haar coefficients is not smooth between their kinks; null where all is.
  Ringing (*ringing)(std::span<const double> p, double dt_s) = nullptr;

  /// What people are told about a curve in which this process is present; null for kinds that need no mention (white
  /// noise, a random walk).
  std::optional<Appearance> (*appearance)(std::span<const double> p, double dt_s) = nullptr;

  /// Optional laws, null where the kind declares none: what an investigation can do with the process where a model that
  /// is taken at its word holds it. A kind with none of them is simulated, and stays in a recording.
  double (*white_square)(std::span<const double> p) = nullptr;        ///< N^2 of a density equal at all frequencies
  double (*differenced_square)(std::span<const double> p) = nullptr;  ///< Q^2 of differences of a white error
  double (*slope)(std::span<const double> p) = nullptr;               ///< of a mean R t [unit/s]
  AddBlockStates add_block_states = nullptr;                          ///< a slow process (slow_law.hpp)
  ExpectedPeriodogram expected_periodogram = nullptr;

  [[nodiscard]] std::size_t shape_count() const { return parameters.size() - 1; }
  [[nodiscard]] bool has_shape() const { return shape_count() > 0; }
  [[nodiscard]] bool is_slow() const { return add_block_states != nullptr; }
  /// Can be taken off a recording or out of its innovations.
  [[nodiscard]] bool can_be_taken_out() const {
    return is_slow() || white_square != nullptr || differenced_square != nullptr || slope != nullptr;
  }
};

/// A process has a level, and at most two shapes after it. One that is slow (`is_slow`) has at most one.
inline constexpr std::size_t kMostParameters = 3;
inline constexpr std::size_t kMostShapes = kMostParameters - 1;

/// A kind with values: a value type, cheap to copy.
struct Process {
  const ProcessKind* kind = nullptr;
  std::vector<double> parameters;  ///< SI, as declared by kind->parameters

  /// The square of the level, to which every second moment is proportional.
  [[nodiscard]] double square() const { return parameters[0] * parameters[0]; }
  /// The parameters after the level.
  [[nodiscard]] std::span<const double> shapes() const { return std::span(parameters).subspan(1); }
  /// The one parameter after the level, 0 for kinds without one. Precondition: the kind has at most one shape, as every
  /// slow one has.
  [[nodiscard]] double only_shape() const {
    assert(kind->shape_count() <= 1);
    return kind->has_shape() ? parameters[1] : 0.0;
  }

  /// Haar MODWT wavelet variance at scale 2 `half` [unit^2].
  [[nodiscard]] double haar_variance(double half, double dt_s) const {
    return kind->haar_variance(parameters, half, dt_s);
  }
  /// Allan variance at tau = half dt: twice the Haar wavelet variance in this normalisation.
  [[nodiscard]] double allan_variance(double half, double dt_s) const { return 2.0 * haar_variance(half, dt_s); }
  /// Derivatives of haar_variance by each parameter.
  void haar_gradient(double half, double dt_s, std::span<double> out) const {
    kind->haar_gradient(parameters, half, dt_s, out);
  }
  /// haar_variance at each of `half` and, unless `gradient` is empty, haar_gradient there: half.size() x
  /// parameters.size(), a half length after the other.
  void haar_curve(std::span<const double> half, double dt_s, std::span<double> variance,
                  std::span<double> gradient = {}) const {
    kind->haar_curve(parameters, half, dt_s, variance, gradient);
  }
  /// Two-sided density [unit^2 s] of the sampled process at |f| <= 1/(2 dt); its integral over both signs is the
  /// variance.
  [[nodiscard]] std::optional<double> spectral_density(double f_hz, double dt_s) const {
    return kind->spectral_density(parameters, f_hz, dt_s);
  }
  /// Its density at low frequencies, where it has one there.
  [[nodiscard]] std::optional<LowFrequencyDensity> low_frequency(double dt_s) const {
    return kind->low_frequency != nullptr ? std::optional(kind->low_frequency(parameters, dt_s)) : std::nullopt;
  }
  /// What people are told about a curve in which this process is present; nothing where its kind needs no mention.
  [[nodiscard]] std::optional<Appearance> appearance(double dt_s) const {
    return kind->appearance != nullptr ? kind->appearance(parameters, dt_s) : std::nullopt;
  }
  /// Autocovariance at a lag in whole samples; nothing for processes that are not stationary.
  [[nodiscard]] std::optional<double> autocovariance(double lag, double dt_s) const {
    return kind->autocovariance(parameters, lag, dt_s);
  }
  /// E (x_{t+lag} - x_t)^2: exists for every kind.
  [[nodiscard]] double variogram(double lag, double dt_s) const { return kind->variogram(parameters, lag, dt_s); }
  /// Mean of the Haar coefficients of half length `half`; 0 except for deterministic trends.
  [[nodiscard]] double haar_mean(double half, double dt_s) const { return kind->haar_mean(parameters, half, dt_s); }
  /// State-space form; nothing where none exists, approximate with its error where only that does (flicker noise).
  [[nodiscard]] std::optional<StateSpace> state_space(double dt_s) const { return kind->state_space(parameters, dt_s); }
  /// Adds one realisation to `out`, one value per sample.
  void add_path(Random& random, double dt_s, std::span<double> out) const {
    kind->add_path(parameters, random, dt_s, out);
  }
};

}  // namespace driftlab
