#include "core/analysis/stored_channel.hpp"

#include "core/analysis/drawn_allan.hpp"
#include "core/process/parameter_unit.hpp"
#include "core/process/registry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace driftlab {
namespace {

const std::string kNone = "The level is estimated as zero: the best fit has none of it.";

/// The process as a result tells it: each parameter in the unit of the field.
ReportedProcess told(const char* name, const std::vector<double>& si, Dimension dimension) {
  ReportedProcess process{name, {}};
  const ProcessKind& kind = *find_process(name);
  for (std::size_t k = 0; k < kind.parameters.size(); ++k) {
    const ParameterSpec& spec = kind.parameters[k];
    const ParameterUnit unit = lab_unit(spec.channel_power == 0 ? Dimension::One : dimension, spec.second_power_halves);
    process.parameters.emplace_back(spec.name, ReportedValue{si[k] * unit.per_si, {}, {}, unit.symbol, ""});
  }
  return process;
}

ReportedProcess none(const char* name) {
  ReportedProcess process{name, {}};
  for (const ParameterSpec& spec : find_process(name)->parameters) {
    process.parameters.emplace_back(spec.name, ReportedValue{{}, {}, {}, "", kNone});
  }
  return process;
}

ReportedFit fit_of(std::vector<ReportedProcess> processes) {
  ReportedFit fit;
  fit.model = "a model";
  fit.processes = std::move(processes);
  return fit;
}

/// 0.01 s samples of white noise and a random walk, measured from 0.01 s to 81.92 s.
StoredChannel gyro(ReportedFit fit) {
  StoredChannel channel;
  channel.told.channel = "gx";
  channel.told.quantity = "angular_rate";
  channel.told.unit = "deg/s";
  channel.told.dt_s = 0.01;
  for (std::size_t half = 1; half <= 8192; half *= 2) {
    channel.told.haar.scale.push_back(2 * half);
    channel.allan.tau_s.push_back(0.01 * static_cast<double>(half));
    channel.allan.deviation.emplace_back(0.1);
    channel.allan.low.emplace_back(0.05);
    channel.allan.high.emplace_back(0.2);
  }
  channel.told.fits.push_back(std::move(fit));
  return channel;
}

TEST(ModelOfAStoredFit, IsTheModelThatWasFittedForEveryProcessOfTheRegistry) {
  for (const ProcessKind& kind : process_registry()) {
    std::vector<double> si;
    for (const ParameterSpec& spec : kind.parameters) {
      si.push_back(std::max(spec.lower, std::min(spec.upper, 0.37)));
    }
    for (const Dimension dimension : {Dimension::AngularRate, Dimension::SpecificForce, Dimension::One}) {
      const auto model = model_of(fit_of({told(std::string(kind.name).c_str(), si, dimension)}), dimension);
      ASSERT_TRUE(model) << kind.name;
      ASSERT_EQ(model->size(), 1U);
      EXPECT_EQ(model->front().kind, &kind);
      for (std::size_t k = 0; k < si.size(); ++k) {
        EXPECT_NEAR(model->front().parameters[k], si[k], 1e-14 * std::abs(si[k])) << kind.name << " " << k;
      }
    }
  }
}

TEST(ModelOfAStoredFit, LeavesOutWhatTheFitHasNothingOfAndIsNothingWhereAParameterIsOpen) {
  const Dimension rate = Dimension::AngularRate;
  const auto walk = told("random_walk", {1e-5}, rate);
  const auto model = model_of(fit_of({none("white_noise"), walk}), rate);
  ASSERT_TRUE(model);
  ASSERT_EQ(model->size(), 1U);
  EXPECT_EQ(model->front().kind->name, "random_walk");

  ReportedProcess open = told("gauss_markov", {1e-4, 0.1}, rate);
  open.parameters[1].second = ReportedValue{{}, {}, {}, "", "The data do not bound it."};
  EXPECT_FALSE(model_of(fit_of({walk, open}), rate));
  EXPECT_FALSE(model_of(fit_of({none("white_noise")}), rate)) << "a model of nothing implies nothing";
  EXPECT_FALSE(model_of(fit_of({walk}), Dimension::SpecificForce)) << "a walk of a rate is none of a force";
}

TEST(ModelOfAStoredFit, LeavesOutAWhiteNoiseInWhosePlaceAFasterProcessStands) {
  // The words that a fit says of white noise alone were not taken for its absence: no curve was drawn at all.
  ReportedProcess white = none("white_noise");
  white.parameters.front().second.reason =
      "The best fit of this model has no white noise of its own, for a faster process stands in its place; the density "
      "N at low frequencies is given beside it.";
  const auto model =
      model_of(fit_of({white, told("gauss_markov", {1e-4, 0.1}, Dimension::AngularRate)}), Dimension::AngularRate);
  ASSERT_TRUE(model);
  EXPECT_EQ(model->size(), 1U);
}

TEST(DrawnAllan, ReadsALevelOffItsOwnCurveThoughAProcessBeforeItHasVanished) {
  const Dimension rate = Dimension::AngularRate;
  const double walk = 1e-4;  // rad/s/sqrt(s)
  const DrawnAllan drawn = drawn_allan(
      gyro(fit_of({none("white_noise"), told("gauss_markov", {1e-4, 0.1}, rate), told("random_walk", {walk}, rate)})));
  ASSERT_TRUE(drawn.model);
  ASSERT_EQ(drawn.model->components.size(), 2U);
  ASSERT_EQ(drawn.levels.size(), 1U) << "the white noise that vanished has none";
  EXPECT_EQ(drawn.levels[0].name, "K");
  EXPECT_EQ(drawn.model->components[drawn.levels[0].component].process, "random_walk");
  EXPECT_EQ(drawn.levels[0].place.tau_s, 3.0);
  // At 3 s the Allan deviation of a random walk is K, but for the sampling: 1 + 1/(2 m^2) of its square at m = 300.
  EXPECT_EQ(drawn.unit.symbol, "deg/h");
  const double drawn_walk = walk * 180.0 / M_PI * 3600.0;
  EXPECT_NEAR(drawn.levels[0].place.deviation / drawn_walk, 1.0, 1e-3);
}

TEST(DrawnAllan, OfAnOpenModelIsTheMeasuredCurveAlone) {
  StoredChannel channel = gyro(fit_of({none("white_noise")}));
  channel.told.allan = {{"B", ReportedValue{2.0, 1.0, 3.0, "deg/h", ""}}};
  const DrawnAllan drawn = drawn_allan(channel);
  EXPECT_FALSE(drawn.model);
  EXPECT_TRUE(drawn.levels.empty());
  EXPECT_FALSE(drawn.robust) << "gross errors were not tested for";
  EXPECT_EQ(drawn.classical.x, channel.allan.tau_s);
  EXPECT_NEAR(drawn.classical.y[0].value_or(0.0), 0.1 * 3600.0, 1e-9);
  ASSERT_TRUE(drawn.bias);
  EXPECT_NEAR(drawn.bias->deviation, 2.0 * std::sqrt(2.0 * std::log(2.0) / M_PI), 1e-3);
}

TEST(RatiosOfAFigure, AreMeasuredOverModelOnAnAxisThatHoldsThem) {
  const DrawnAllan drawn =
      drawn_allan(gyro(fit_of({told("white_noise", {0.01 * M_PI / 180.0}, Dimension::AngularRate)})));
  ASSERT_TRUE(drawn.model);
  const DrawnRatios ratios = ratios_of(drawn);
  // sqrt(AV) = N/sqrt(tau) = 0.1 deg/s at 0.01 s, where 0.1 were measured.
  EXPECT_NEAR(ratios.classical.y[0].value_or(0.0), 1.0, 1e-12);
  EXPECT_NEAR(ratios.classical.y[4].value_or(0.0), 4.0, 1e-12);
  EXPECT_EQ(ratios.end, 8.0) << "the axis ends at 8 however far the ratios go";
}

TEST(GravestChannel, IsTheFirstOfTheWorst) {
  EXPECT_FALSE(gravest_channel({}));
  StoredChannel fine = gyro(fit_of({told("white_noise", {1e-4}, Dimension::AngularRate)}));
  fine.told.fits[0].j_test = JTest{5.0, 5.0, 0.4};
  StoredChannel bad = fine;
  bad.told.channel = "gy";
  bad.told.fits[0].j_test = JTest{90.0, 5.0, 1e-9};
  StoredChannel also_bad = bad;
  also_bad.told.channel = "gz";
  const std::vector<StoredChannel> channels{fine, bad, also_bad};
  const auto gravest = gravest_channel(channels);
  ASSERT_TRUE(gravest);
  EXPECT_EQ(gravest->channel, "gy");
  EXPECT_EQ(gravest->verdict.sentence, verdict_of(bad).sentence);
  EXPECT_NE(gravest->verdict.level, VerdictLevel::Fine);
}

}  // namespace
}  // namespace driftlab
