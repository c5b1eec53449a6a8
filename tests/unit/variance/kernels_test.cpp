#include "core/variance/kernels.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <numeric>
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
      EXPECT_EQ(chosen.pyramid_step(x.data() + 64, 64, a.data(), first, count),
                portable.pyramid_step(x.data() + 64, 64, b.data(), first, count));
      EXPECT_EQ(a, b);
      const std::size_t firsts[] = {first / 2, first};
      std::vector<double> p(2, 0.0);
      std::vector<double> q(2, 0.0);
      chosen.pyramid_pair(x.data() + 64, 16, a.data(), firsts, count, p.data());
      portable.pyramid_pair(x.data() + 64, 16, b.data(), firsts, count, q.data());
      EXPECT_EQ(a, b);
      EXPECT_EQ(p, q);
    }
    EXPECT_EQ(chosen.prefix_block(x.data(), count, 0.3, 7.0, 0.01, a.data()),
              portable.prefix_block(x.data(), count, 0.3, 7.0, 0.01, b.data()));
    EXPECT_EQ(a, b);
    std::vector<double> p(5, 0.0);
    std::vector<double> q(5, 0.0);
    chosen.octave_powers(x.data() + 3000, 40, 5, count, p.data());
    portable.octave_powers(x.data() + 3000, 40, 5, count, q.data());
    EXPECT_EQ(p, q);
    for (const std::size_t levels : {1U, 2U, 3U, 4U}) {
      chosen.octave_powers(x.data() + 3000, 7, levels, count, p.data());
      portable.octave_powers(x.data() + 3000, 7, levels, count, q.data());
      EXPECT_EQ(p, q) << levels;
    }
    EXPECT_EQ(chosen.second_difference_power(x.data() + 20, x.data() + 10, x.data(), count),
              portable.second_difference_power(x.data() + 20, x.data() + 10, x.data(), count));
    EXPECT_EQ(chosen.third_difference_power(x.data() + 300, 10, count),
              portable.third_difference_power(x.data() + 300, 10, count));
    std::vector<double> squares(count);
    for (std::size_t i = 0; i < count; ++i) {
      squares[i] = x[i] * x[i];
    }
    EXPECT_EQ(chosen.biweight_sum(squares.data(), count, 0.7), portable.biweight_sum(squares.data(), count, 0.7));
    std::vector<double> between(count + 1);
    std::vector<double> portable_between(count + 1);
    const std::size_t found = chosen.biweight_powers(squares.data(), count, 0.7, 1.5, p.data(), between.data());
    EXPECT_EQ(portable.biweight_powers(squares.data(), count, 0.7, 1.5, q.data(), portable_between.data()), found);
    EXPECT_EQ(p, q);
    between.resize(found);
    portable_between.resize(found);
    EXPECT_EQ(between, portable_between);
    chosen.square_second_differences(x.data() + 20, x.data() + 10, x.data(), count, 0.3, a.data());
    portable.square_second_differences(x.data() + 20, x.data() + 10, x.data(), count, 0.3, b.data());
    EXPECT_EQ(a, b);
  }
  for (const std::size_t rows : {1U, 7U, 8U, 9U, 19U, 40U}) {
    std::vector<double> lower(rows * rows, 0.0);
    for (std::size_t c = 0; c < rows; ++c) {
      std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(50 * c), rows - c,
                  lower.begin() + static_cast<std::ptrdiff_t>(c * rows + c));
    }
    for (const std::size_t columns : {1U, 2U, 3U, 4U, 11U}) {
      std::vector<double> p(rows * columns, 0.0);
      std::vector<double> q(rows * columns, 0.0);
      chosen.lower_product(lower.data(), rows, x.data() + 2000, columns, p.data());
      portable.lower_product(lower.data(), rows, x.data() + 2000, columns, q.data());
      EXPECT_EQ(p, q);
      for (std::size_t i = 0; i < rows; ++i) {
        double sum = 0.0;
        for (std::size_t c = 0; c <= i; ++c) {
          sum += lower[c * rows + i] * x[2000 + (columns - 1) * rows + c];
        }
        EXPECT_EQ(p[(columns - 1) * rows + i], sum) << rows << " x " << columns;
      }
      std::vector<double> g(columns * columns);
      std::vector<double> h(columns * columns);
      chosen.gram(x.data(), rows, columns, g.data());
      portable.gram(x.data(), rows, columns, h.data());
      EXPECT_EQ(g, h);
      EXPECT_NEAR(g.back(),
                  std::inner_product(&x[(columns - 1) * rows], &x[columns * rows], &x[(columns - 1) * rows], 0.0),
                  1e-12 * g.back());
    }
  }
  const std::vector<std::uint16_t> pairs{0, 3, 1, 2, 0, 1, 2, 3, 1, 2};
  std::vector<double> a(x.begin(), x.begin() + 4 * kWindowsAtOnce);
  std::vector<double> b = a;
  chosen.exchange(a.data(), pairs.data(), pairs.size() / 2);
  portable.exchange(b.data(), pairs.data(), pairs.size() / 2);
  EXPECT_EQ(a, b);
}

}  // namespace
}  // namespace driftlab
