// Allan deviations against an independent implementation and a printed standard (values stored as numbers).
#include "core/variance/allan_variance.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/hadamard_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/reference_values.hpp"
#include "tests/unit/fit/shared_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

namespace driftlab {
namespace {

/// The test suite of NIST SP 1065, section 12.4: a thousand numbers of a multiplicative congruential generator.
std::vector<double> nist_points() {
  std::vector<double> points;
  for (std::uint64_t n = 1234567890; points.size() < 1000; n = 16807 * n % 2147483647) {
    points.push_back(static_cast<double>(n) / 2147483647.0);
  }
  return points;
}

/// Largest relative difference of deviations whose variances `variance_of` computes at all m of a reference entry.
template <class VarianceOf>
double worst(const nlohmann::json& entry, VarianceOf variance_of) {
  const auto m = entry["m"].get<std::vector<std::size_t>>();
  const std::vector<double> found = variance_of(m);
  double largest = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i) {
    largest = std::max(largest, std::fabs(std::sqrt(found.at(i)) / entry["deviation"][i].get<double>() - 1.0));
  }
  return largest;
}

TEST(ReferenceAllan, TheThousandPointsOfTheHandbookGiveItsDeviations) {
  // Printed to seven digits, computed by the peer to sixteen.
  const nlohmann::json reference = reference_values("nist_1000_points.json");
  const std::vector<double> x = nist_points();
  const double mean = summarise(x)->mean;
  const auto allan = [&](const std::vector<std::size_t>& m) { return allan_variance(x, mean, m); };
  const auto hadamard = [&](const std::vector<std::size_t>& m) { return hadamard_variance(x, mean, m); };
  EXPECT_LT(worst(reference["published"]["oadev"], allan), 3e-7);
  EXPECT_LT(worst(reference["published"]["ohdev"], hadamard), 3e-7);
  EXPECT_LT(worst(reference["computed"]["oadev"], allan), 1e-11);
  EXPECT_LT(worst(reference["computed"]["ohdev"], hadamard), 1e-11);
}

TEST(ReferenceAllan, EveryOctaveOfTheAdisRecordingsAgreesToNineDigits) {
  const auto shared = shared_data::folder();
  if (!shared) {
    GTEST_SKIP() << "SKIPPED: no recordings; set DRIFTLAB_SHARED to the directory that holds data/";
  }
  const auto columns = shared_data::read_npy_xz(*shared / "data/adis_16405_imu1.npy.xz", 6);
  const auto reference = reference_values("adis_16405_imu1.oadev.json");
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto& axis = reference["axes"][shared_data::adis_axes()[c]];
    const HaarVariance curve = haar_variance(columns[c], summarise(columns[c])->mean);
    ASSERT_EQ(curve.scales(), axis["m"].size());
    for (std::size_t j = 0; j < curve.scales(); ++j) {
      ASSERT_EQ(curve.half[j], axis["m"][j].get<std::size_t>());
      const double expected = axis["oadev"][j].get<double>();
      EXPECT_NEAR(std::sqrt(2.0 * curve.variance[j]), expected, 1e-9 * expected);
    }
  }
}

}  // namespace
}  // namespace driftlab
