#include "core/variance/hadamard_variance.hpp"

#include "core/process/registry.hpp"
#include "core/variance/allan_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/process_examples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stop_token>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

double by_definition(const std::vector<double>& x, std::size_t m) {
  long double sum = 0.0L;
  std::size_t count = 0;
  for (std::size_t end = 3 * m; end <= x.size(); ++end, ++count) {
    long double y = 0.0L;
    for (std::size_t i = 0; i < m; ++i) {
      y += static_cast<long double>(x[end - 1 - i]) - 2.0L * static_cast<long double>(x[end - 1 - m - i]) +
           static_cast<long double>(x[end - 1 - 2 * m - i]);
    }
    sum += y * y;
  }
  return static_cast<double>(sum / (6.0L * static_cast<long double>(m * m * count)));
}

TEST(HadamardVariance, EqualsItsDefinitionAtAnyLength) {
  Random random(5);
  std::vector<double> x(9000);
  for (double& value : x) {
    value = 7.0 + random.normal();
  }
  const std::vector<std::size_t> m{1, 2, 3, 17, 100, 1023, 3000};
  const std::vector<double> found = hadamard_variance(x, summarise(x)->mean, m);
  for (std::size_t k = 0; k < m.size(); ++k) {
    const double expected = by_definition(x, m[k]);
    EXPECT_NEAR(found[k], expected, 1e-12 * expected) << m[k];
  }
}

TEST(HadamardVariance, DoesNotSeeARampThatTheAllanVarianceSees) {
  std::vector<double> x(20000);
  for (std::size_t t = 0; t < x.size(); ++t) {
    x[t] = 0.25 * static_cast<double>(t);
  }
  const std::vector<std::size_t> m{1, 8, 512, 4096};
  const std::vector<double> hadamard = hadamard_variance(x, summarise(x)->mean, m);
  const std::vector<double> allan = allan_variance(x, summarise(x)->mean, m);
  for (std::size_t k = 0; k < m.size(); ++k) {
    EXPECT_LT(hadamard[k], 1e-12 * allan[k]) << m[k];
  }
}

TEST(HadamardVariance, EveryProcessHasTheOneThatItsModelSays) {
  // 200 series of 600 samples; the scatter among the series is the standard error, 4.5 of them.
  for (const ProcessKind& kind : process_registry()) {
    const Process process = example_of(kind, 1.7, kDt);
    for (const std::size_t m : {std::size_t{1}, std::size_t{4}, std::size_t{32}}) {
      double sum = 0.0;
      double squares = 0.0;
      for (std::uint64_t run = 0; run < 200; ++run) {
        Random random(77, run);
        std::vector<double> x(600, 0.0);
        process.add_path(random, kDt, x);
        const double found = hadamard_variance(x, x[0], std::vector<std::size_t>{m}).at(0);
        sum += found / 200.0;
        squares += found * found / 200.0;
      }
      const double expected = hadamard_variance(Model{process}, static_cast<double>(m), kDt);
      const double error = std::sqrt(std::max(0.0, squares - sum * sum) / 200.0);
      EXPECT_NEAR(sum, expected, 4.5 * error + 1e-9 * expected + 1e-18) << kind.name << " m=" << m;
    }
  }
}

TEST(HadamardVariance, StopsWhenAsked) {
  std::stop_source source;
  source.request_stop();
  const std::vector<double> x(100, 1.0);
  EXPECT_TRUE(
      hadamard_variance(x, 1.0, std::vector<std::size_t>{1}, {.stop = source.get_token(), .progress = {}}).empty());
}

}  // namespace
}  // namespace driftlab
