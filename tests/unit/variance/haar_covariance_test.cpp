#include "core/variance/haar_covariance.hpp"

#include "core/process/registry.hpp"
#include "core/variance/haar_variance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

/// The sum over every lag.
double by_definition(const Process& process, double mi, double mj, double n) {
  const double last = n - mi - mj;
  double sum = 0.0;
  for (double h = 0.0; h <= last; h += 1.0) {
    double gamma = 0.0;
    process.kind->add_haar_cross(process.parameters, mi, mj, kDt, {&h, 1}, 1.0, {&gamma, 1});
    sum += (h == 0.0 ? 1.0 : 2.0) * (std::min(n - mj, n - mi - h) - mj + 1.0) * gamma * gamma;
  }
  return 2.0 * sum / ((n - 2.0 * mi + 1.0) * (n - 2.0 * mj + 1.0));
}

TEST(HaarCovariance, RulesAgreeWithTheSumOverEveryLag) {
  // Lengths that are and are not powers of two; correlation times from a fifth of a sample to ten records.
  std::vector<Process> processes;
  for (const char* symbol : {"QN", "WN", "RW", "FN"}) {
    processes.push_back({find_process(symbol), {1.3}});
  }
  for (const double beta : {500.0, 50.0, 5.0, 1.0, 0.2, 0.01}) {
    processes.push_back({find_process("GM"), {1.3, beta}});
  }
  for (const double frequency : {0.5, 6.0, 20.0}) {
    for (const double quality : {0.7, 3.0, 12.0, 40.0}) {
      processes.push_back({find_process("RES"), {1.3, frequency, quality}});
    }
    processes.push_back({find_process("LP2"), {1.3, frequency}});
  }
  for (const double width : {1.4, 3.25, 40.0}) {
    processes.push_back({find_process("MA"), {1.3, width}});
    processes.push_back({find_process("DEC"), {1.3, width}});
  }
  for (const double alpha : {0.3, 1.3, 1.8}) {
    processes.push_back({find_process("PL"), {1.3, alpha}});
  }
  for (const std::size_t samples : {std::size_t{1000}, std::size_t{4096}}) {
    const HaarVariance grid = haar_variance(std::vector<double>(samples, 0.0), 0.0);
    for (const Process& process : processes) {
      HaarCovariance plan(grid.half, samples, kDt);
      const Eigen::MatrixXd found = plan.matrix({process});
      const double tolerance = process.kind->symbol == "FN" || process.kind->symbol == "PL" ? 3e-3 : 1e-3;
      for (Eigen::Index j = 0; j < found.rows(); ++j) {
        for (Eigen::Index i = 0; i <= j; ++i) {
          const double expected =
              by_definition(process, static_cast<double>(grid.half[static_cast<std::size_t>(i)]),
                            static_cast<double>(grid.half[static_cast<std::size_t>(j)]), static_cast<double>(samples));
          EXPECT_NEAR(found(i, j), expected, tolerance * std::sqrt(found(i, i) * found(j, j)))
              << process.kind->name << " " << process.parameters.back() << " N=" << samples << " " << i << "," << j;
        }
      }
    }
  }
}

}  // namespace
}  // namespace driftlab
