#pragma once
/// Composite models: sums of independent processes, and their names.
///
/// A name is symbols joined by `+`, each with an optional count: `WN`, `WN+GM`, `WN+2GM+RW+DR`, `QN+WN+FN+RW`. Printed
/// names are canonical (registry order, counts gathered), so that `RW+GM+WN+GM` is `WN+2GM+RW`.
#include "core/process/process.hpp"
#include "core/process/random.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// The kinds of a model, one entry per process, in registry order; no parameter values.
struct ModelStructure {
  std::vector<const ProcessKind*> kinds;

  [[nodiscard]] std::size_t parameter_count() const;
  [[nodiscard]] std::size_t shape_count() const;
  friend bool operator==(const ModelStructure&, const ModelStructure&) = default;
};

/// At most this many processes in one model: the fit enumerates subsets of them.
inline constexpr std::size_t kMaxModelProcesses = 8;
/// And at most this many shapes: the fit scans a grid over all of them.
inline constexpr std::size_t kMaxModelShapes = 3;

/// Errors: InvalidArgument (unknown symbol, a kind twice that cannot repeat, too many processes), naming the model.
[[nodiscard]] Result<ModelStructure> parse_model(std::string_view name);

[[nodiscard]] std::string model_name(const ModelStructure& structure);

/// True if every process of `inner` is also in `outer`.
[[nodiscard]] bool is_nested(const ModelStructure& inner, const ModelStructure& outer);

/// A model with values.
using Model = std::vector<Process>;

[[nodiscard]] double haar_variance(const Model& model, double half, double dt_s);

/// `samples` values of the sum of the model's processes: deterministic in the generator's state.
[[nodiscard]] std::vector<double> simulate(const Model& model, Random& random, double dt_s, std::size_t samples);

/// A process by name with its values. Errors: InvalidArgument (unknown name, wrong number of values, value out of
/// bounds).
[[nodiscard]] Result<Process> make_process(std::string_view name, std::vector<double> parameters);

}  // namespace driftlab
