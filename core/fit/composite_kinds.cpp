#include "core/fit/composite_kinds.hpp"

#include "core/process/registry.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string_view>

namespace driftlab {
namespace {

constexpr std::size_t kKept = 4;
/// Samples over which an average is looked for.
constexpr double kWidest = 32.0;
/// Corner of a low-pass, in sampling rates.
constexpr double kLowestCorner = 0.02;
constexpr double kHighestCorner = 1.0;
/// Quality of a resonance; a sharper one is a sinusoid to the curve.
constexpr double kSharpest = 200.0;
/// An average of fewer samples leaves white noise.
constexpr double kNarrowest = 1.02;
/// Values of the shape of a filter at which it is tabulated or tried.
constexpr std::size_t kFilterNodes = 40;

CompositeKind composite_kind(const ProcessKind& kind, double dt_s, std::size_t samples) {
  CompositeKind result;
  result.kind = &kind;
  const auto count = static_cast<double>(samples);
  const auto narrow = [&](std::size_t k, double low, double high) {
    auto& range = result.log_range[k];
    range = {std::max(range.first, std::log(low)), std::min(range.second, std::log(high))};
  };
  for (std::size_t k = 0; k < kind.shape_count(); ++k) {
    const auto [low, high] = kind.shape_range(k, dt_s, count);
    result.log_range.emplace_back(std::log(low), std::log(high));
  }
  if (!kind.has_shape()) {
    return result;
  }
  const std::string_view shape = kind.parameters[1].name;
  if (shape == "beta") {  // slower than the record it is a random walk, and that has a parameter less
    narrow(0, 0.5 / (count * dt_s), 1e300);
  } else if (shape == "samples") {
    narrow(0, kind.name == "moving_average" ? kNarrowest : kNarrowest / 3.0, kWidest);
    result.nodes = kFilterNodes;
    result.smooth = false;
  } else if (shape == "corner_hz") {
    narrow(0, kLowestCorner / dt_s, kHighestCorner / dt_s);
    result.nodes = kFilterNodes;
  } else if (shape == "alpha") {
    result.nodes = kFilterNodes;
  } else if (shape == "frequency_hz") {
    result.at_lines_only = true;
    if (kind.shape_count() > 1) {
      narrow(1, 1e-300, kSharpest);
    }
  }
  result.repeats = kind.repeats && (shape != "samples" && shape != "corner_hz");
  return result;
}

}  // namespace

std::vector<CompositeKind> composite_kinds(double dt_s, std::size_t samples) {
  std::vector<CompositeKind> kinds;
  for (const ProcessKind& kind : process_registry()) {
    if (kind.name != "low_pass_1") {
      kinds.push_back(composite_kind(kind, dt_s, samples));
    }
  }
  return kinds;
}

std::shared_ptr<const CompositeBasis> composite_basis(std::span<const std::size_t> half, std::size_t samples,
                                                      double dt_s) {
  static std::mutex mutex;
  static std::vector<std::shared_ptr<const CompositeBasis>> kept;  // newest last
  const std::scoped_lock lock(mutex);
  const auto found = std::find_if(kept.begin(), kept.end(), [&](const std::shared_ptr<const CompositeBasis>& one) {
    return one->dt_s() == dt_s && one->table().samples() == samples && std::ranges::equal(one->table().half(), half);
  });
  if (found != kept.end()) {
    std::rotate(found, found + 1, kept.end());
    return kept.back();
  }
  if (kept.size() == kKept) {
    kept.erase(kept.begin());
  }
  kept.push_back(std::make_shared<const CompositeBasis>(std::make_shared<const SpectralTable>(half, samples),
                                                        composite_kinds(dt_s, samples), dt_s));
  return kept.back();
}

}  // namespace driftlab
