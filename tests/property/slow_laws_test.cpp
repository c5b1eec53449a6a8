/// The laws by which an investigation takes slow processes, for every kind that declares them: both follow from the
/// variogram V(h) = E (x_{t+h} - x_t)^2.
#include "core/process/constant_offset.hpp"
#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace driftlab {
namespace {

std::vector<const ProcessKind*> slow_kinds() {
  std::vector<const ProcessKind*> kinds{&constant_offset()};
  for (const ProcessKind& kind : process_registry()) {
    if (kind.is_slow()) {
      kinds.push_back(&kind);
    }
  }
  return kinds;
}

class SlowLaws : public testing::TestWithParam<const ProcessKind*> {
 protected:
  static constexpr double kDt = 0.05;

  /// Some process of the kind, of level 0.7 and of a correlation time of 2 s where it has one.
  [[nodiscard]] static Process process() {
    Process process{GetParam(), {0.7}};
    if (process.kind->has_shape()) {
      process.parameters.push_back(0.5);
    }
    return process;
  }
  /// Everything but flicker noise is exact. Of that, six processes make increments of single samples 36 % too large and
  /// of longer blocks less, and the density is that of all frequencies, not of a record's.
  [[nodiscard]] static double tolerance() { return GetParam()->symbol == "FN" ? 0.4 : 1e-8; }
};

/// E (difference of two neighbouring block means)^2 = sum over the pairs of [V(L + i - j) - V(i - j)] / L^2; of the
/// states, each (1 - phi)^2 p + q, and twice the white remainder.
TEST_P(SlowLaws, BlockMeansDifferAsTheVariogramSays) {
  for (const std::size_t length : {1U, 2U, 9U, 40U}) {
    double expected = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
      for (std::size_t j = 0; j < length; ++j) {
        const double lag = static_cast<double>(i) - static_cast<double>(j);
        expected +=
            process().variogram(static_cast<double>(length) + lag, kDt) - process().variogram(std::fabs(lag), kDt);
      }
    }
    expected /= static_cast<double>(length * length);
    BlockStates states;
    GetParam()->add_block_states(process().square(), process().only_shape(), {kDt, length, 0.0, 4000.0}, states);
    double got = 2.0 * states.remainder;
    for (std::size_t k = 0; k < states.phi.size(); ++k) {
      const double gap = 1.0 - states.phi[k];
      got += gap * gap * states.p0[k] + states.q[k];
    }
    EXPECT_NEAR(got, expected, tolerance() * expected + 1e-15) << "L = " << length;
  }
}

/// At a whole number of cycles per record, E P = - dt/2 sum over |h| < n of (1 - |h|/n) V(h) cos(2 pi f h dt).
TEST_P(SlowLaws, PeriodogramFollowsFromTheVariogram) {
  if (GetParam()->expected_periodogram == nullptr) {
    EXPECT_EQ(process().variogram(7.0, kDt), 0.0) << "only what is constant in a record shows nothing";
    return;
  }
  constexpr double kSamples = 600.0;
  for (const double cycles : {3.0, 20.0, 100.0}) {
    const double f = cycles / kSamples / kDt;
    double expected = 0.0;
    for (double h = 1.0; h < kSamples; h += 1.0) {
      expected -=
          kDt * (1.0 - h / kSamples) * process().variogram(h, kDt) * std::cos(2.0 * std::numbers::pi * f * h * kDt);
    }
    const double got = GetParam()->expected_periodogram(process().square(), process().only_shape(), f, kDt, kSamples);
    EXPECT_NEAR(got, expected, tolerance() * expected) << "f = " << f;
  }
}

TEST_P(SlowLaws, GoWithTheSquareOfTheLevel) {
  BlockStates one;
  BlockStates four;
  const Blocks blocks{kDt, 4, 0.0, 4000.0};
  GetParam()->add_block_states(1.0, process().only_shape(), blocks, one);
  GetParam()->add_block_states(4.0, process().only_shape(), blocks, four);
  ASSERT_EQ(one.phi, four.phi);
  for (std::size_t k = 0; k < one.phi.size(); ++k) {
    EXPECT_DOUBLE_EQ(four.q[k], 4.0 * one.q[k]);
    EXPECT_DOUBLE_EQ(four.p0[k], 4.0 * one.p0[k]);
  }
  EXPECT_NEAR(four.remainder, 4.0 * one.remainder, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Kinds, SlowLaws, testing::ValuesIn(slow_kinds()),
                         [](const auto& instance) { return std::string(instance.param->name); });

/// Every process of the octave search can be held by a given baseline: taken out by a law, or by a cause found again.
/// Filters, resonances and power laws stay, and the sinusoid does.
TEST(Processes, DeclareWhatABaselineDoesWithThem) {
  for (const ProcessKind& kind : process_registry()) {
    EXPECT_EQ(kind.can_be_taken_out(), kind.in_octave_search && kind.name != "sinusoid") << kind.name;
  }
}

}  // namespace
}  // namespace driftlab
