#include "core/navigate/error_covariance.hpp"

#include "core/navigate/covariance_kernels.hpp"
#include "core/process/random.hpp"

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

namespace driftlab {
namespace {

constexpr int kSensors = 12;
constexpr int kStates = kNavigationStates + kSensors;

/// A full covariance with eigenvalues about 1: navigation and sensor states drawn apart, then mixed by a step.
ErrorCovariance drawn(Random& random) {
  const auto square = [&](int n) -> Eigen::MatrixXd {
    Eigen::MatrixXd a(n, n);
    for (double& value : a.reshaped()) {
      value = random.normal() / std::sqrt(n);
    }
    return a * a.transpose();
  };
  ErrorCovariance covariance(kSensors);
  const Eigen::MatrixXd navigation = square(kNavigationStates);
  covariance.navigation() = 0.5 * (navigation + navigation.transpose());
  const Eigen::MatrixXd sensors = square(kSensors);
  for (int i = 0; i < kSensors; ++i) {
    for (int j = 0; j < kSensors; ++j) {
      covariance.add_sensor(i, j, 0.5 * (sensors(i, j) + sensors(j, i)));
    }
  }
  SensorTransition mixing;
  std::fill_n(mixing.phi.begin(), kSensors, 1.0);
  for (std::size_t i = 0; i < kNavigationStates; ++i) {
    for (std::size_t j = 0; j < kSensors; ++j) {
      mixing.gain[i * static_cast<std::size_t>(covariance.stride()) + j] = 0.3 * random.normal();
    }
  }
  covariance.propagate({}, mixing);
  return covariance;
}

/// One coordinate, or any direction of the first three.
ScalarMeasurement measurement(Random& random, int coordinate, double variance) {
  ScalarMeasurement m;
  if (coordinate >= 0) {
    m.h(coordinate) = 1.0;
  } else {
    m.h.head<3>() = Vector3(random.normal(), random.normal(), random.normal()).normalized();
  }
  m.innovation = random.normal();
  m.variance = variance;
  return m;
}

/// Blocks of a covariance as the kernels take them, filled at random: what they compute of it is all that is asked.
template <int S>
struct Blocks {
  explicit Blocks(Random& random) {
    const auto fill = [&](auto& numbers) {
      for (double& number : numbers) {
        number = random.normal();
      }
    };
    fill(gain);
    fill(phi);
    fill(ns);
    fill(ss);
    fill(state);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j <= i; ++j) {
        nn(i, j) = nn(j, i) = random.normal();
      }
    }
    f = {0.1, 1e-6 * Matrix3::Ones(), {random.normal(), random.normal(), random.normal()}, {0.1, -0.2, 0.3}};
    measurement.h.setConstant(0.3);
    measurement.innovation = random.normal();
    measurement.variance = 4.0;
  }
  NavigationTransition f;
  ScalarMeasurement measurement;
  ErrorCovariance::Navigation nn;
  alignas(32) std::array<double, std::size_t{9} * S> gain{}, ns{};
  alignas(32) std::array<double, S> phi{};
  alignas(32) std::array<double, std::size_t{S} * S> ss{};
  std::array<double, 9 + S> state{};
};

template <int S>
void expect_the_same_of_both_kernels() {
  Random random(17);
  for (int round = 0; round < 50; ++round) {
    Blocks<S> wide(random);
    Blocks<S> plain = wide;
    const auto run = [](auto kernel, Blocks<S>& blocks) {
      using Of = decltype(kernel);
      Of::propagate(blocks.f, blocks.gain.data(), blocks.phi.data(), blocks.nn, blocks.ns.data(), blocks.ss.data());
      return Of::update(blocks.measurement, blocks.nn, blocks.ns.data(), blocks.ss.data(), blocks.state.data());
    };
    const ScalarInnovation of_wide = run(covariance_kernels::WideKernel<S>{}, wide);
    const ScalarInnovation of_plain = run(covariance_kernels::Kernel<S>{}, plain);
    EXPECT_EQ(of_wide.value, of_plain.value);
    EXPECT_EQ(of_wide.variance, of_plain.variance);
    EXPECT_TRUE(wide.nn == plain.nn);
    EXPECT_EQ(wide.ns, plain.ns);
    EXPECT_EQ(wide.ss, plain.ss);
    EXPECT_EQ(wide.state, plain.state);
  }
}

TEST(ErrorCovariance, IsTheSameToTheBitWithWideInstructions) {
  if (!covariance_kernels::has_avx2()) {
    GTEST_SKIP() << "This processor has no AVX2.";
  }
  expect_the_same_of_both_kernels<12>();
  expect_the_same_of_both_kernels<16>();
  expect_the_same_of_both_kernels<24>();
  expect_the_same_of_both_kernels<kMaxSensorStates>();
}

TEST(ErrorCovariance, AnUpdateIsTheTextbooksInJosephsForm) {
  // The page promised Joseph's form and the code had it multiplied out, P - k (P h)^T - (P h) k^T + s k k^T, which left
  // an eigenvalue of -8e-14 of the largest after a measurement far better than what was known.
  // Both compute with roundings of 1e-16 of the entries, which are of size 1; 100 of them.
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    ErrorCovariance covariance = drawn(random);
    const Eigen::MatrixXd before = covariance.dense();
    const ScalarMeasurement m = measurement(random, -1, 0.3);
    ErrorCovariance::State state = ErrorCovariance::State::Zero();
    covariance.update(m, state);
    Eigen::VectorXd h = Eigen::VectorXd::Zero(kStates);
    h.head<9>() = m.h;
    const Eigen::VectorXd gain = before * h / (h.dot(before * h) + m.variance);
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(kStates, kStates) - gain * h.transpose();
    const Eigen::MatrixXd expected = rest * before * rest.transpose() + m.variance * gain * gain.transpose();
    const Eigen::MatrixXd after = covariance.dense();
    EXPECT_LT((after - expected).cwiseAbs().maxCoeff(), 1e-14);
    EXPECT_EQ((after - after.transpose()).cwiseAbs().maxCoeff(), 0.0) << "symmetric to the bit";
    EXPECT_LT((state.head<kStates>() - gain * m.innovation).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(ErrorCovariance, AMeasurementFarBetterThanWhatWasKnownLeavesNoNegativeVariance) {
  // Each update rounds the matrix of n states by n eps, and thirty follow each other; the solver adds its own. (The
  // form multiplied out keeps this bound too; what it loses in a single update is tested below.)
  constexpr int kUpdates = 30;
  const double rounding = (kUpdates + 4.0) * kStates * std::numeric_limits<double>::epsilon();
  double worst = 0.0;
  for (const double variance : {1e-12, 1e-16, 1e-18, 1e-20}) {
    for (const bool along_axes : {true, false}) {
      for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Random random(7, seed);
        ErrorCovariance covariance = drawn(random);
        for (int i = 0; i < kUpdates; ++i) {
          ErrorCovariance::State state = ErrorCovariance::State::Zero();
          covariance.update(measurement(random, along_axes ? i % 3 : -1, variance), state);
          const Eigen::VectorXd eigenvalues =
              Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(covariance.dense(), Eigen::EigenvaluesOnly).eigenvalues();
          worst = std::min(worst, eigenvalues(0) / eigenvalues(kStates - 1));
        }
      }
    }
  }
  EXPECT_GT(worst, -rounding);
}

TEST(ErrorCovariance, ACoordinateMeasuredFarBetterHasTheVarianceOfItsMeasurement) {
  // P h stands to R as 1 to 1e-20: P R/(P + R) is R to the last bit, where the form multiplied out gives a difference
  // of two numbers of size 1, anything up to 1e-16 of either sign.
  Random random(11);
  ErrorCovariance covariance = drawn(random);
  for (int coordinate = 0; coordinate < 3; ++coordinate) {
    ErrorCovariance::State state = ErrorCovariance::State::Zero();
    covariance.update(measurement(random, coordinate, 1e-20), state);
    EXPECT_NEAR(covariance.navigation()(coordinate, coordinate), 1e-20, 1e-25);
  }
}

}  // namespace
}  // namespace driftlab
