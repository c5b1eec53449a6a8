#pragma once
/// Characterisation of one channel: variances with intervals, Allan coefficients, and ranked GMWM fits.
#include "core/fit/characterisation.hpp"
#include "core/signal/gappy_samples.hpp"
#include "core/signal/progress.hpp"
#include "core/signal/result.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace driftlab {

/// This number is raised whenever the same input and settings may give other figures. It is stored with every result.
inline constexpr int kAlgorithmVersion = 9;

/// Which models are compared.
enum class ModelSearch {
  Listed,    ///< the models of CharacteriseOptions::models and no others
  Stepwise,  ///< from the best of these on, process by process over the whole registry (core/fit/model_search.hpp)
};

struct CharacteriseOptions {
  /// Candidate models, written as in Table 3 of the seed paper (`WN`, `WN+GM`, `WN+2GM+RW`, `QN+WN+RW`, ...).
  /// The default is the nine of Table 3.
  std::vector<std::string> models = {"WN",     "WN+GM",     "WN+GM+RW",  "WN+GM+DR",    "WN+GM+RW+DR",
                                     "WN+2GM", "WN+2GM+RW", "WN+2GM+DR", "WN+2GM+RW+DR"};
  /// Seed of every random draw (the bootstrap). The same seed gives the same bits.
  std::uint64_t seed = 1;
  ModelSearch search = ModelSearch::Listed;
  /// Replicates of a parametric bootstrap of the best model's parameter intervals (core/fit/bootstrap.hpp); 0: none.
  std::size_t bootstrap = 0;
  /// Windows of a dynamic Allan variance (core/variance/dynamic_allan.hpp); 0: none.
  std::size_t dynamic = 0;
  FurtherRequest also = {};  ///< curves beside the Allan and wavelet variances
  /// Models are fitted to the scales of tau = m dt from here on [s]; 0: to all. For a sensor whose filter is known to
  /// shape the first scales. The curves are still given at all scales.
  double from_tau_s = 0.0;
};

/// Samples of one channel as they lie in the file, and the factor that makes them SI.
struct ChannelSamples {
  std::span<const double> values;  ///< uniform at dt_s but for the gaps, file unit
  double dt_s = 0.0;
  double si_factor = 1.0;          ///< file unit -> SI; variances are computed on `values` and scaled once
  std::span<const Gap> gaps = {};  ///< where samples are missing between two rows of `values`
};

/// Checks a model name and every setting without data. Errors: InvalidArgument, naming the parameter.
[[nodiscard]] Status check_options(const CharacteriseOptions& options);

/// Errors: TooFewSamples (fewer than 8 samples), NonFinite (naming the row), OutOfRange (squares overflow),
/// InvalidArgument, LimitExceeded (more than two samples missing for each recorded), Cancelled. A model needs as many
/// scales as it has parameters; candidates with more are left out with a warning. A constant channel is no error: it
/// has zero variances, no fit and a warning. The result is deterministic; one thread is used.
[[nodiscard]] Result<ChannelCharacterisation> characterise_channel(const ChannelSamples& channel,
                                                                   const CharacteriseOptions& options = {},
                                                                   const RunControl& control = {});

}  // namespace driftlab
