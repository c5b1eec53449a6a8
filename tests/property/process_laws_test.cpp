// One suite of laws over every registered process: what it declares must agree with what it simulates and with itself.
#include "core/process/model.hpp"
#include "core/process/registry.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/process_examples.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace driftlab {
namespace {

constexpr double kDt = 0.01;

std::vector<Process> examples(const ProcessKind& kind) { return examples_of(kind, kDt); }

class ProcessLaws : public testing::TestWithParam<std::size_t> {
 protected:
  [[nodiscard]] static const ProcessKind& kind() { return process_registry()[GetParam()]; }
};

TEST_P(ProcessLaws, DeclaresDistinctNamesAndBounds) {
  EXPECT_FALSE(kind().name.empty());
  EXPECT_FALSE(kind().symbol.empty());
  EXPECT_FALSE(kind().title.empty());
  ASSERT_FALSE(kind().parameters.empty());
  EXPECT_EQ(kind().parameters[0].channel_power, 1) << "the first parameter is the level";
  for (const ParameterSpec& spec : kind().parameters) {
    EXPECT_LT(spec.lower, spec.upper);
  }
  EXPECT_EQ(find_process(kind().name), &kind());
  EXPECT_EQ(find_process(kind().symbol), &kind());
}

TEST_P(ProcessLaws, VarianceIsProportionalToTheSquaredLevel) {
  for (Process process : examples(kind())) {
    const double before = process.haar_variance(8, kDt);
    process.parameters[0] *= 2.0;
    EXPECT_NEAR(process.haar_variance(8, kDt), 4.0 * before, 1e-13 * before);
  }
}

TEST_P(ProcessLaws, GradientMatchesCentralDifferences) {
  for (const Process& process : examples(kind())) {
    for (const double m : {1.0, 3.0, 16.0, 1024.0}) {
      std::vector<double> gradient(kind().parameters.size());
      process.haar_gradient(m, kDt, gradient);
      for (std::size_t k = 0; k < gradient.size(); ++k) {
        // Truncation h^2 f'''/6: with h = 1e-5 of the value (divided by the number of turns for a frequency) about
        // 1e-9 of f.
        const double turns = kind().parameters[k].name == "frequency_hz" ? 1.0 + m * process.parameters[k] * kDt : 1.0;
        const double step = 1e-5 * process.parameters[k] / turns;
        Process up = process;
        Process down = process;
        up.parameters[k] += step;
        down.parameters[k] -= step;
        const double difference = (up.haar_variance(m, kDt) - down.haar_variance(m, kDt)) / (2.0 * step);
        const double scale = process.haar_variance(m, kDt) / process.parameters[k] * turns;
        EXPECT_NEAR(gradient[k], difference, 3e-7 * std::fabs(difference) + 1e-8 * scale)
            << kind().name << " m=" << m << " parameter " << kind().parameters[k].name;
      }
    }
  }
}

TEST_P(ProcessLaws, ACurveIsTheVarianceAndTheGradientAtEachHalfLength) {
  std::vector<double> half;
  for (double m = 1.0; m < 3e6; m = std::ceil(1.37 * m)) {
    half.push_back(m);
  }
  const std::size_t count = kind().parameters.size();
  for (const Process& process : examples(kind())) {
    std::vector<double> alone(half.size());
    std::vector<double> variance(half.size());
    std::vector<double> gradient(half.size() * count);
    process.haar_curve(half, kDt, alone);
    process.haar_curve(half, kDt, variance, gradient);
    for (std::size_t j = 0; j < half.size(); ++j) {
      const double expected = process.haar_variance(half[j], kDt);
      EXPECT_NEAR(alone[j], expected, 1e-10 * expected) << kind().name << " m=" << half[j];
      EXPECT_NEAR(variance[j], expected, 1e-10 * expected) << kind().name << " m=" << half[j];
      std::vector<double> slope(count);
      process.haar_gradient(half[j], kDt, slope);
      for (std::size_t k = 0; k < count; ++k) {
        const double scale = std::fabs(slope[k]) + expected / process.parameters[k];
        EXPECT_NEAR(gradient[j * count + k], slope[k], 1e-9 * scale) << kind().name << " m=" << half[j] << " " << k;
      }
    }
  }
}

TEST_P(ProcessLaws, HaarVarianceIsTheSecondDifferenceOfTheVariogram) {
  // E W^2 with W = (sum of m - sum of m before)/(2m) and sum_i c_i = 0 is -1/2 sum_ij c_i c_j V(i - j).
  for (const Process& process : examples(kind())) {
    for (const int m : {1, 2, 5, 16, 33}) {
      double sum = 0.0;
      for (int lag = -2 * m + 1; lag < 2 * m; ++lag) {
        double pairs = 0.0;  // sum over i of c_i c_{i+lag}
        for (int i = 0; i < 2 * m; ++i) {
          const int other = i + lag;
          if (other >= 0 && other < 2 * m) {
            pairs += ((i < m) == (other < m) ? 1.0 : -1.0) / (4.0 * m * m);
          }
        }
        sum -= 0.5 * pairs * process.variogram(lag, kDt);
      }
      EXPECT_NEAR(sum, process.haar_variance(m, kDt), 1e-10 * process.variogram(m, kDt) + 1e-14)
          << kind().name << " m=" << m;
    }
  }
}

TEST_P(ProcessLaws, HaarVarianceIsTheIntegralOfTheDensity) {
  // Seed paper eq. (6): 2 int_0^{1/2dt} S(f) sin^4(pi f m dt)/(m^2 sin^2(pi f dt)) df, midpoint rule on panels of the
  // comb.
  for (const Process& process : examples(kind())) {
    if (!process.spectral_density(1.0, kDt)) {
      continue;
    }
    for (const int m : {1, 4, 32}) {
      const int points = 400000;
      double sum = 0.0;
      for (int i = 0; i < points; ++i) {
        const double f = (i + 0.5) / points * 0.5 / kDt;
        const double wide = std::sin(std::numbers::pi * f * m * kDt);
        const double narrow = std::sin(std::numbers::pi * f * kDt);
        sum += *process.spectral_density(f, kDt) * wide * wide * wide * wide / (m * m * narrow * narrow);
      }
      const double integral = 2.0 * sum * 0.5 / kDt / points;
      EXPECT_NEAR(integral, process.haar_variance(m, kDt), 1e-6 * integral) << kind().name << " m=" << m;
    }
  }
}

TEST_P(ProcessLaws, CrossCovarianceAtLagZeroIsTheVariance) {
  for (const Process& process : examples(kind())) {
    if (process.haar_mean(1.0, kDt) != 0.0 || kind().symbol == "SIN") {
      continue;  // deterministic: no scatter
    }
    for (const double m : {1.0, 2.0, 64.0, 4096.0}) {
      const std::vector<double> lag{0.0};
      std::vector<double> gamma{0.0};
      kind().add_haar_cross(process.parameters, m, m, kDt, lag, 1.0, gamma);
      const double expected = process.haar_variance(m, kDt);
      EXPECT_NEAR(gamma[0], expected, 1e-7 * expected) << kind().name << " m=" << m;
    }
  }
}

TEST_P(ProcessLaws, CrossCovarianceIsTheDifferenceOfTheVariogram) {
  // gamma_ij(h) = -1/2 sum_ab c_a d_b V(distance of the two samples), filter centres h apart; over the near field, the
  // far field and the borders between them.
  for (const Process& process : examples(kind())) {
    if (process.haar_mean(1.0, kDt) != 0.0 || kind().symbol == "SIN") {
      continue;
    }
    for (const auto& [mi, mj] : {std::pair{1, 1}, {2, 2}, {1, 4}, {4, 16}, {8, 8}}) {
      for (const int h : {0, 1, 2, 3, 4, 5, 8, 15, 16, 17, 20, 21, 40, 200}) {
        double expected = 0.0;
        for (int s = 0; s < 2 * mi; ++s) {
          for (int t = 0; t < 2 * mj; ++t) {
            const double sign = ((s < mi) == (t < mj) ? 1.0 : -1.0) / (4.0 * mi * mj);
            expected -= 0.5 * sign * process.variogram(h + (s - mi) - (t - mj), kDt);
          }
        }
        const std::vector<double> lag{static_cast<double>(h)};
        std::vector<double> gamma{0.0};
        kind().add_haar_cross(process.parameters, mi, mj, kDt, lag, 1.0, gamma);
        const double scale = std::sqrt(process.haar_variance(mi, kDt) * process.haar_variance(mj, kDt));
        // The far field of flicker noise is a series: it errs by less than 1 % of its own small value.
        EXPECT_NEAR(gamma[0], expected, 1e-6 * scale + 1e-2 * std::fabs(expected) * (h > 8 * (mi + mj) ? 1.0 : 0.0))
            << kind().name << " mi=" << mi << " mj=" << mj << " h=" << h;
      }
    }
  }
}

TEST_P(ProcessLaws, StateSpaceHasTheSecondMomentsOfTheProcess) {
  for (const Process& process : examples(kind())) {
    const auto model = process.state_space(kDt);
    if (!model) {
      continue;
    }
    // E (y_L - y_0)^2 by running the moments of the pair (x_0, x_L).
    const Eigen::Index n = model->phi.rows();
    for (const int lag : {1, 2, 7}) {
      Eigen::VectorXd mean = model->mean0;
      Eigen::MatrixXd cov = model->cov0;
      Eigen::MatrixXd cross = model->cov0;  // cov(x_L, x_0)
      for (int t = 0; t < lag; ++t) {
        mean = model->phi * mean;
        cov = model->phi * cov * model->phi.transpose() + model->q;
        cross = model->phi * cross;
      }
      double expected = 2.0 * model->r;
      if (n > 0) {
        const double step = (model->h * (mean - model->mean0))(0);
        expected +=
            (model->h * (cov + model->cov0 - cross - cross.transpose()) * model->h.transpose())(0) + step * step;
      }
      // An approximate state space is held to the error that it declares.
      const double tolerance = std::max(1e-9, model->relative_error);
      EXPECT_NEAR(expected, process.variogram(lag, kDt), tolerance * process.variogram(lag, kDt) + 1e-15)
          << kind().name;
    }
  }
}

TEST_P(ProcessLaws, StateSpaceHasTheDeclaredDensityWithinItsError) {
  // S(f) = dt [h (e^{iw} - phi)^-1 q (e^{-iw} - phi')^-1 h' + r], 40 frequencies over eight decades.
  for (const Process& process : examples(kind())) {
    const auto model = process.state_space(kDt);
    if (!model || !process.spectral_density(1.0, kDt)) {
      continue;
    }
    const Eigen::Index n = model->phi.rows();
    for (int i = 0; i < 40; ++i) {
      const double cycles = std::max(0.5 * std::pow(10.0, -0.15 * i), 1.01 * model->lowest_hz * kDt);
      const std::complex<double> turn = std::polar(1.0, 2.0 * std::numbers::pi * cycles);
      const Eigen::MatrixXcd resolvent =
          turn * Eigen::MatrixXcd::Identity(n, n) - model->phi.cast<std::complex<double>>();
      double density = model->r;
      if (n > 0) {
        const Eigen::VectorXcd x = resolvent.transpose().partialPivLu().solve(Eigen::VectorXcd(model->h.transpose()));
        density += (x.adjoint() * model->q * x).value().real();
      }
      const double expected = *process.spectral_density(cycles / kDt, kDt);
      const double tolerance = std::max(1e-6, 1.001 * model->relative_error);
      EXPECT_NEAR(kDt * density, expected, tolerance * expected) << kind().name << " at " << cycles;
      if (cycles < 0.05) {
        EXPECT_NEAR(kDt * density, expected, 0.016 * expected) << kind().name << " at " << cycles;
      }
    }
  }
}

TEST_P(ProcessLaws, DensityAtLowFrequenciesIsTheLimitAndFlatAsFarAsDeclared) {
  for (const Process& process : examples(kind())) {
    const auto low = process.low_frequency(kDt);
    if (!low) {
      continue;
    }
    EXPECT_NEAR(*process.spectral_density(0.0, kDt), low->density, 1e-9 * low->density) << kind().name;
    // Aliases, which the closed form of the reach leaves out, change the tenth by less than itself.
    const double end = std::min(low->flat_to_hz, 0.25 / kDt);
    for (const double share : {0.1, 0.5, 1.0}) {
      EXPECT_NEAR(*process.spectral_density(share * end, kDt), low->density, 0.12 * low->density) << kind().name;
    }
    // The long scales of what is left there fall like those of white noise of that density, N^2/(2 m dt).
    const double m = std::ceil(3e4 / (std::min(low->flat_to_hz, 1.0 / kDt) * kDt));
    EXPECT_NEAR(process.haar_variance(m, kDt) * 2.0 * m * kDt, low->density, 1e-3 * low->density) << kind().name;
  }
}

TEST_P(ProcessLaws, AutocovarianceAndVariogramAgree) {
  for (const Process& process : examples(kind())) {
    const auto at_zero = process.autocovariance(0.0, kDt);
    if (!at_zero) {
      continue;
    }
    for (const double lag : {1.0, 2.0, 10.0}) {
      EXPECT_NEAR(2.0 * (*at_zero - *process.autocovariance(lag, kDt)), process.variogram(lag, kDt), 1e-12 * *at_zero);
    }
  }
}

TEST_P(ProcessLaws, SimulationHasTheDeclaredVariance) {
  // 400 series of 512 samples: each variance is averaged over R series, whose scatter among themselves gives the
  // standard error; 4.5 of them is one false alarm in 10^5 per comparison.
  constexpr std::size_t kSeries = 400;
  constexpr std::size_t kSamples = 512;
  for (const Process& process : examples(kind())) {
    std::vector<double> sum(9, 0.0);
    std::vector<double> squares(9, 0.0);
    for (std::size_t s = 0; s < kSeries; ++s) {
      Random random(20240611, s);
      std::vector<double> path(kSamples, 0.0);
      process.add_path(random, kDt, path);
      const HaarVariance curve = haar_variance(path, path[0]);
      ASSERT_EQ(curve.scales(), sum.size());
      for (std::size_t j = 0; j < sum.size(); ++j) {
        sum[j] += curve.variance[j];
        squares[j] += curve.variance[j] * curve.variance[j];
      }
    }
    for (std::size_t j = 0; j < sum.size(); ++j) {
      const double mean = sum[j] / kSeries;
      const double error = std::sqrt(std::max(0.0, squares[j] / kSeries - mean * mean) / kSeries);
      const double expected = process.haar_variance(std::pow(2.0, static_cast<double>(j)), kDt);
      EXPECT_NEAR(mean, expected, 4.5 * error + 1e-9 * expected) << kind().name << " scale " << j;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, ProcessLaws, testing::Range(std::size_t{0}, process_registry().size()),
                         [](const testing::TestParamInfo<std::size_t>& tested) {
                           return std::string(process_registry()[tested.param].name);
                         });

}  // namespace
}  // namespace driftlab
