/// What all recordings show must not doubt a difference between them, and what one shows alone must.
#include "core/investigate/report/shared_misfit.hpp"

#include "core/investigate/causes/cause.hpp"
#include "tests/unit/investigate/noise_at_full_rate.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace driftlab::investigate {
namespace {

/// Three recordings of 20 s.
class Shared : public testing::Test {
 protected:
  static Evidence of(const char* cause, std::vector<std::size_t> members) {
    Evidence evidence;
    evidence.cause = find_cause(cause);
    evidence.members = std::move(members);
    return evidence;
  }
  static Remainder swelling(const char* recording, double period_s, double p = 0.0009) {
    Remainder remainder;
    remainder.channel = "gz";
    remainder.recording = recording;
    remainder.period_s = period_s;
    remainder.p_study = p;
    return remainder;
  }
  static Remainder tile(const char* recording) { return swelling(recording, 0.0); }
  static UnnamedFinding profile(UnnamedKind kind, Against against, std::vector<std::string> recordings) {
    UnnamedFinding found;
    found.effect.column = "gz";
    found.effect.kind = kind;
    found.effect.against = against;
    found.effect.recordings = std::move(recordings);
    found.effect.period_s = against == Against::Phase ? 0.9 : 0.0;
    return found;
  }
  [[nodiscard]] bool holds(const Evidence& evidence, const Remainder& remainder) const {
    return SharedMisfit(evidence, noise_.group, remains_, unnamed_).holds(remainder);
  }
  [[nodiscard]] bool holds(const Evidence& evidence, const UnnamedFinding& found) const {
    return SharedMisfit(evidence, noise_.group, remains_, unnamed_).holds(found);
  }

  NoiseAtFullRate noise_{{std::vector<double>(1000), std::vector<double>(1000), std::vector<double>(1000)}, 0.02};
  const Evidence step_ = of("noise_level_change", {1});
  const Evidence differenced_ = of("quantization_noise", {1});
  std::vector<Remainder> remains_;
  std::vector<UnnamedFinding> unnamed_;
};

TEST_F(Shared, ARhythmOfSeveralRecordingsIsNoChangeThatLasts) {
  const Remainder own = swelling("r1", 0.9);
  remains_ = {own};
  EXPECT_FALSE(holds(step_, own)) << "no other recording has it";
  remains_.push_back(swelling("r0", 0.9));
  EXPECT_TRUE(holds(step_, own));
  EXPECT_TRUE(holds(differenced_, own));
  EXPECT_FALSE(holds(of("noise_level_change", {0, 1, 2}), own)) << "it is in all recordings itself";
  EXPECT_FALSE(holds(of("white_noise_level", {1}), own)) << "a recording may be louder for it";
  EXPECT_FALSE(holds(of("heavy_tailed_noise", {1}), own));
  remains_[1].p_study = 0.0011;
  EXPECT_FALSE(holds(step_, own)) << "the other hardly shows it";
}

TEST_F(Shared, ASlowSwellingMayBeAChangeThatLasts) {
  remains_ = {swelling("r1", 1.1), swelling("r0", 1.1)};  // 18 periods
  EXPECT_FALSE(holds(step_, remains_[0]));
  remains_ = {tile("r1"), tile("r0")};
  EXPECT_FALSE(holds(step_, remains_[0])) << "what has no rhythm least of all";
}

TEST_F(Shared, AProfileOfThePhaseIsARhythmToo) {
  unnamed_ = {profile(UnnamedKind::Variance, Against::Phase, {"r1"}),
              profile(UnnamedKind::Variance, Against::Phase, {"r2"})};
  EXPECT_TRUE(holds(step_, unnamed_[0]));
  EXPECT_TRUE(holds(step_, swelling("r1", 0.9)));
  unnamed_[1].effect.recordings = {"r1"};
  EXPECT_FALSE(holds(step_, unnamed_[0])) << "no other recording has it";
  unnamed_[1] = profile(UnnamedKind::Variance, Against::Time, {"r2"});
  EXPECT_FALSE(holds(step_, unnamed_[1]));
}

TEST_F(Shared, ASpectrumOfAllRecordingsIsNoDifferenceBetweenThem) {
  unnamed_ = {profile(UnnamedKind::Spectrum, Against::Frequency, {})};
  EXPECT_TRUE(holds(differenced_, unnamed_[0]));
  EXPECT_FALSE(holds(of("resonance", {1}), unnamed_[0])) << "which is not sought against the other recordings";
  Check spectrum;
  spectrum.channel = "gz";
  spectrum.of_spectrum = true;
  const auto holds_check = [&](const Evidence& evidence, const Check& check) {
    return SharedMisfit(evidence, noise_.group, remains_, unnamed_).holds(check);
  };
  EXPECT_TRUE(holds_check(differenced_, spectrum));
  EXPECT_TRUE(holds_check(step_, spectrum));
  spectrum.of_spectrum = false;
  EXPECT_FALSE(holds_check(differenced_, spectrum));
  spectrum.of_spectrum = true;
  spectrum.channel = "gx";
  EXPECT_FALSE(holds_check(differenced_, spectrum));
  spectrum.channel = "gz";
  unnamed_[0].effect.recordings = {"r1"};
  EXPECT_FALSE(holds_check(differenced_, spectrum)) << "a profile of one recording";
}

TEST_F(Shared, WhatOtherRecordingsDoIsNoneOfTheDifferencedNoiseOfOne) {
  EXPECT_FALSE(holds(differenced_, tile("r0"))) << "nothing is known to be shared";
  unnamed_ = {profile(UnnamedKind::Spectrum, Against::Frequency, {})};
  EXPECT_TRUE(holds(differenced_, tile("r0")));
  EXPECT_FALSE(holds(differenced_, tile("r1")));
  EXPECT_FALSE(holds(step_, tile("r0"))) << "a change in time is seen by its size";
}

}  // namespace
}  // namespace driftlab::investigate
