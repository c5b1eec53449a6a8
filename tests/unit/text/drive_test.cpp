// What people read of a recorded drive.
#include "schema/text/drive.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TEST(DriveText, ARatioHasNoUnitAndALevelNoError) {
  // "the white noise ... is that of the model times 31.91 +- 0 1": levels of the noise are fitted without an error.
  drive::DriveFinding finding;
  finding.value = 31.914;
  finding.unit = "1";
  EXPECT_EQ(size_of_finding(finding), "31.91");
  finding.se = 1.04;
  EXPECT_EQ(size_of_finding(finding), "31.91 +- 1");
  finding.value = 0.1265;
  finding.se = 0.0009;
  finding.unit = "s";
  EXPECT_EQ(size_of_finding(finding), "0.1265 +- 0.0009 s");
}

}  // namespace
}  // namespace driftlab
