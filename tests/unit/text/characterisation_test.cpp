#include "schema/text/characterisation.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace driftlab {
namespace {

ToldChannel channel_of(VerdictLevel level) {
  ToldChannel channel;
  channel.channel = "gz";
  channel.unit = "deg/s";
  channel.verdict = Verdict{"WN describes this recording.", {}, level, {}};
  return channel;
}

TEST(CharacterisationText, MarksEachSentenceAndNamesTheRecordingWhereThereAreSeveral) {
  const ToldRecording one{"a.csv", {channel_of(VerdictLevel::Fine)}};
  EXPECT_EQ(verdicts_to_text({one}), "✓ gz: WN describes this recording.\n");
  ToldRecording two{"b.csv", {channel_of(VerdictLevel::Look), channel_of(VerdictLevel::Wrong), ToldChannel{}}};
  EXPECT_EQ(verdicts_to_text({one, two}),
            "✓ a.csv, gz: WN describes this recording.\n"
            "△ b.csv, gz: WN describes this recording.\n"
            "✗ b.csv, gz: WN describes this recording.\n");
}

TEST(CharacterisationText, HasALinePerTauDensityAndSpectralLineAndADashWhereThereIsNoFigure) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ToldChannel channel = channel_of(VerdictLevel::Fine);
  EXPECT_EQ(further_to_text({{"a", {channel}}}), "");
  channel.total = ToldCurve{{0.01, 1234.5678}, {0.25, 2.0e-5}, {0.2, 0.0}, {0.3, kNone}};
  channel.psd = ToldSpectrum{{{12.5}, {0.001}, {kNone}, {0.002}}, {{12.5, 0.125, 40.0}}};
  EXPECT_EQ(further_to_text({{"a", {channel}}}),
            "Total deviation of gz\n"
            "     tau [s]   deviation  95 % interval [deg/s]\n"
            "        0.01        0.25  0.2 .. 0.3\n"
            "        1235       2e-05  0 .. -\n"
            "\n"
            "Power spectral density of gz\n"
            "      f [Hz]     density  95 % interval [(deg/s)^2/Hz]\n"
            "        12.5       0.001  - .. 0.002\n"
            "Line at 12.5 Hz: amplitude 0.125 deg/s, 40 times the power of the noise around it\n"
            "\n");
}

}  // namespace
}  // namespace driftlab
