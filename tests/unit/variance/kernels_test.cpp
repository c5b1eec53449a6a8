#include "core/variance/kernels.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace driftlab {
namespace {

TEST(Kernels, EveryInstructionSetGivesTheBitsOfThePortableOne) {
  Random random(3);
  std::vector<double> x(5000);
  for (double& value : x) {
    value = random.normal();
  }
  const Kernels& chosen = kernels();
  const Kernels& portable = portable_kernels();
  for (const std::size_t count : {0U, 1U, 15U, 16U, 17U, 1000U, 1003U}) {
    std::vector<double> a(count);
    std::vector<double> b(count);
    for (const std::size_t first : {std::size_t{0}, count / 3, count}) {
      EXPECT_EQ(chosen.pyramid_step(x.data() + 64, x.data(), a.data(), first, count),
                portable.pyramid_step(x.data() + 64, x.data(), b.data(), first, count));
      EXPECT_EQ(a, b);
    }
    std::vector<double> p(5, 0.0);
    std::vector<double> q(5, 0.0);
    chosen.octave_powers(x.data() + 3000, 40, 5, count, p.data());
    portable.octave_powers(x.data() + 3000, 40, 5, count, q.data());
    EXPECT_EQ(p, q);
    std::vector<double> squares(count);
    for (std::size_t i = 0; i < count; ++i) {
      squares[i] = x[i] * x[i];
    }
    EXPECT_EQ(chosen.biweight_sum(squares.data(), count, 0.7), portable.biweight_sum(squares.data(), count, 0.7));
    chosen.square_second_differences(x.data() + 20, x.data() + 10, x.data(), count, 0.3, a.data());
    portable.square_second_differences(x.data() + 20, x.data() + 10, x.data(), count, 0.3, b.data());
    EXPECT_EQ(a, b);
  }
}

}  // namespace
}  // namespace driftlab
