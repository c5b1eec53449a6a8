/// A kind of process without a range for each of its shapes was called through a null pointer, or read past the end of
/// an array, by the first fit that held it; and one with a periodogram of three parameters lost the third.
#include "core/process/constant_offset.hpp"
#include "core/process/gauss_markov.hpp"
#include "core/process/process_kind.hpp"
#include "core/process/registry.hpp"
#include "core/process/resonance.hpp"
#include "core/process/white_noise.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace driftlab {
namespace {

using Range = std::pair<double, double>;

/// What contradicts the shapes that a kind declares; empty: nothing.
std::string fault_of_shapes(const ProcessKind& kind) {
  if (kind.has_shape() != (kind.shape_range != nullptr)) {
    return kind.has_shape() ? "it has shapes and no range of them" : "it has a range and no shape";
  }
  if (kind.shape_count() > 1 && (kind.add_block_states != nullptr || kind.expected_periodogram != nullptr)) {
    return "a law of slow processes takes one shape";
  }
  for (const double dt_s : {0.0005, 0.01, 1.0}) {
    for (const double samples : {64.0, 1e4, 1e8}) {
      for (std::size_t k = 0; k < kind.shape_count(); ++k) {
        const auto [low, high] = kind.shape_range(k, dt_s, samples);
        if (!(low > 0.0 && low < high && std::isfinite(high))) {
          return "shape " + std::to_string(k) + " has no range of positive numbers";  // fits search their logarithms
        }
      }
    }
  }
  return "";
}

TEST(ShapeLaws, EveryKindHasARangeForEachOfItsShapes) {
  EXPECT_EQ(fault_of_shapes(constant_offset()), "");
  for (const ProcessKind& kind : process_registry()) {
    EXPECT_EQ(fault_of_shapes(kind), "") << kind.name;
  }
}

TEST(ShapeLaws, RefuseAPlantedKind) {
  ProcessKind planted = registered<GaussMarkov>();
  ASSERT_EQ(fault_of_shapes(planted), "");
  planted.shape_range = nullptr;
  EXPECT_EQ(fault_of_shapes(planted), "it has shapes and no range of them");
  planted.shape_range = [](std::size_t, double, double) { return Range{0.0, 1.0}; };
  EXPECT_EQ(fault_of_shapes(planted), "shape 0 has no range of positive numbers");
  planted = registered<WhiteNoise>();
  planted.shape_range = registered<GaussMarkov>().shape_range;
  EXPECT_EQ(fault_of_shapes(planted), "it has a range and no shape");
  planted = registered<Resonance>();
  planted.expected_periodogram = registered<GaussMarkov>().expected_periodogram;
  EXPECT_EQ(fault_of_shapes(planted), "a law of slow processes takes one shape");
}

/// What `kind_of` looks at before it makes a kind of a type; it refuses these when it is compiled.
template <std::size_t Count>
struct Shaped {
  static constexpr std::array<ParameterSpec, 1 + Count> kParameters{};
};
struct OneRange : Shaped<1> {
  static Range shape_range(double /*dt_s*/, double /*samples*/) { return {1.0, 2.0}; }
};
struct OneRangeForTwo : Shaped<2> {
  static Range shape_range(double /*dt_s*/, double /*samples*/) { return {1.0, 2.0}; }
};
struct ShortRanges : Shaped<2> {
  static std::array<Range, 1> shape_ranges(double /*dt_s*/, double /*samples*/) { return {}; }
};
struct TwoRanges : Shaped<2> {
  static std::array<Range, 2> shape_ranges(double /*dt_s*/, double /*samples*/) { return {}; }
};
struct PeriodogramOfTwo : TwoRanges {
  static double expected_periodogram(double /*square*/, double /*shape*/, double /*f_hz*/, double /*dt_s*/,
                                     double /*samples*/) {
    return 0.0;
  }
};
static_assert(detail::ranges_every_shape<Shaped<0>>());
static_assert(!detail::ranges_every_shape<Shaped<1>>(), "no range for its shape");
static_assert(detail::ranges_every_shape<OneRange>());
static_assert(!detail::ranges_every_shape<OneRangeForTwo>());
static_assert(!detail::ranges_every_shape<ShortRanges>());
static_assert(detail::ranges_every_shape<TwoRanges>());
static_assert(detail::slow_laws_know_its_shapes<TwoRanges>());
static_assert(!detail::slow_laws_know_its_shapes<PeriodogramOfTwo>());

}  // namespace
}  // namespace driftlab
