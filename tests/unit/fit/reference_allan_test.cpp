// Allan deviations of real recordings against an independent implementation (values stored as numbers).
#include "core/fit/characterise.hpp"
#include "core/variance/haar_variance.hpp"
#include "core/variance/samples.hpp"
#include "tests/unit/fit/shared_data.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace driftlab {
namespace {

TEST(ReferenceAllan, EveryOctaveOfTheAdisRecordingsAgreesToNineDigits) {
  const auto shared = shared_data::folder();
  if (!shared) {
    GTEST_SKIP() << "SKIPPED: no reference values; set DRIFTLAB_SHARED to the directory that holds reference/";
  }
  const auto columns = shared_data::read_npy_xz(*shared / "data/adis_16405_imu1.npy.xz", 6);
  const auto reference = shared_data::read_json(*shared / "reference/adis_16405_imu1.oadev.json");
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
