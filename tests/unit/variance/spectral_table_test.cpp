#include "core/variance/spectral_table.hpp"

#include "core/process/registry.hpp"
#include "core/variance/haar_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;
constexpr std::size_t kSamples = 20'000;

std::vector<Process> processes() {
  return {*make_process("quantization_noise", {1.3}), *make_process("white_noise", {1.3}),
          *make_process("flicker_noise", {1.3}),      *make_process("random_walk", {1.3}),
          *make_process("gauss_markov", {1.3, 0.5}),  *make_process("gauss_markov", {1.3, 50.0})};
}

Eigen::VectorXd density_of(const Process& process, const SpectralTable& table) {
  Eigen::VectorXd density(static_cast<Eigen::Index>(table.frequencies().size()));
  for (std::size_t b = 0; b < table.frequencies().size(); ++b) {
    density(static_cast<Eigen::Index>(b)) = process.spectral_density(table.frequencies()[b] / kDt, kDt).value() / kDt;
  }
  return density;
}

TEST(SpectralTable, VariancesAreThoseOfTheClosedForms) {
  const std::vector<std::size_t> half = dense_half_lengths(kSamples);
  const SpectralTable table(half, kSamples);
  for (const Process& process : processes()) {
    const Eigen::VectorXd nu = table.variance(density_of(process, table));
    for (std::size_t j = 0; j < half.size(); ++j) {
      const double expected = process.haar_variance(static_cast<double>(half[j]), kDt);
      // A bin is 1/20 octave: f^-2 is off by a third of (ln 2/20)^2 where the filter rises as f^2; the registered law
      // of the random walk has its aliases, the density at the bin's place too.
      EXPECT_NEAR(nu(static_cast<Eigen::Index>(j)) / expected, 1.0, 3e-3) << process.kind->name << " m " << half[j];
    }
  }
}

TEST(SpectralTable, CovariancesAreThoseOfTheSumsOverLags) {
  const std::vector<std::size_t> half = dense_half_lengths(kSamples);
  const SpectralTable table(half, kSamples);
  HaarCovariance plan(half, kSamples, kDt);
  for (const Process& process : processes()) {
    const Eigen::MatrixXd found = table.covariance(density_of(process, table));
    const Eigen::MatrixXd expected = plan.matrix({process});
    for (std::size_t j = 0; j < half.size(); ++j) {
      if (32 * half[j] > kSamples) {
        continue;  // beyond a sixteenth of the record its ends matter
      }
      // Coefficients of quantization noise are correlated at single lags, where those of other noise are at many.
      const double tolerance = process.kind->name == "quantization_noise" ? 0.15 : 0.03;
      const auto b = static_cast<Eigen::Index>(j);
      for (Eigen::Index a = 0; a <= b; ++a) {
        EXPECT_NEAR(found(a, b), expected(a, b), tolerance * std::sqrt(expected(a, a) * expected(b, b)))
            << process.kind->name << " m " << half[j];
      }
    }
  }
}

TEST(SpectralTable, DenseHalfLengthsAreFourToTheOctaveUpToHalfOfTheRecord) {
  EXPECT_EQ(dense_half_lengths(64), (std::vector<std::size_t>{1, 2, 3, 4, 5, 6, 7, 8, 10, 11, 13, 16}));
  EXPECT_TRUE(dense_half_lengths(3).empty());
}

}  // namespace
}  // namespace driftlab
