/// Transforms in parts are the library's.
#include "core/investigate/fullrate/fourier.hpp"

#include "core/process/random.hpp"

#include <gtest/gtest.h>
#include <unsupported/Eigen/FFT>

#include <complex>
#include <vector>

namespace driftlab::investigate {
namespace {

TEST(Fourier, ATransformInPartsIsThatOfTheLibraryToTheBit) {
  for (const std::size_t length : {4U, 8U, 18U, 30U, 64U, 100U, 240U, 432U, 4096U, 8640U, 65536U}) {
    Random random(length);
    std::vector<double> values(length);
    for (double& value : values) {
      value = random.normal();
    }
    std::vector<std::complex<double>> expected(length / 2 + 1);
    Eigen::FFT<double> fft;
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    fft.fwd(expected.data(), values.data(), static_cast<Eigen::Index>(length));
    for (const std::size_t whole : {std::size_t{4}, std::size_t{50}, std::size_t{3000}, kWholeTransform}) {
      EXPECT_EQ(half_spectrum(
                    length, [&](std::size_t i) { return values[i]; }, whole),
                expected)
          << length << " in parts of " << whole;
    }
  }
}

TEST(Fourier, NothingHasOneValueOfNothing) {
  EXPECT_EQ(half_spectrum(0, [](std::size_t) { return 1.0; }), std::vector<std::complex<double>>(1));
}

}  // namespace
}  // namespace driftlab::investigate
