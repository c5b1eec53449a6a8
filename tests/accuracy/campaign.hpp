#pragma once
/// A simulated rate-table campaign with the iPhone values of Table 4 of Radi, Nassar and El-Sheimy (2017): eight
/// conditions, each recorded twice at 100 Hz, 15 min but for the ramps of 225 and 155 s; experiment 4, which the paper
/// leaves out, has the geometric means of experiments 3 and 5 and gross errors.
#include "core/campaign/replicates.hpp"
#include "core/fit/characterise.hpp"
#include "core/process/published_models.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace driftlab::campaign {

inline constexpr double kDt = 0.01;
/// Of experiment 4: this share of the samples has an error of this many standard deviations of the white noise.
inline constexpr double kOutlierShare = 0.002;
inline constexpr double kOutlierSize = 10.0;

struct Experiment {
  std::string name;
  Model truth;
  std::size_t samples = 90000;
  bool contaminated = false;
};

inline Model published(const char* condition) { return *published_model("iphone5s-z", *parse_condition(condition)); }

/// Parameter by parameter.
inline Model geometric_mean(const Model& a, const Model& b) {
  Model mean = a;
  for (std::size_t p = 0; p < mean.size(); ++p) {
    for (std::size_t k = 0; k < mean[p].parameters.size(); ++k) {
      mean[p].parameters[k] = std::sqrt(a[p].parameters[k] * b[p].parameters[k]);
    }
  }
  return mean;
}

inline std::vector<Experiment> experiments() {
  const Model third = published("constant_rate:z:36:deg/s");
  const Model fifth = published("constant_rate:z:120:deg/s");
  return {{"0 static", published("static")},
          {"1 9 deg/s", published("constant_rate:z:9:deg/s")},
          {"2 18 deg/s", published("constant_rate:z:18:deg/s")},
          {"3 36 deg/s", third},
          {"4 72 deg/s, gross errors", geometric_mean(third, fifth), 90000, true},
          {"5 120 deg/s", fifth},
          {"6 1 deg/s^2", published("constant_angular_acceleration:z:1:deg/s^2"), 22500},
          {"7 2 deg/s^2", published("constant_angular_acceleration:z:2:deg/s^2"), 15500}};
}

/// One recording, seeded by repetition, experiment and replicate.
inline std::vector<double> record(const Experiment& experiment, std::uint64_t seed, std::uint64_t stream) {
  Random random(seed, stream);
  std::vector<double> x = simulate(experiment.truth, random, kDt, experiment.samples);
  if (experiment.contaminated) {
    const double sd = experiment.truth.front().parameters[0] / std::sqrt(kDt);
    for (double& value : x) {
      if (random.uniform() < kOutlierShare) {
        value += kOutlierSize * sd * random.normal();
      }
    }
  }
  return x;
}

/// What the table shows for an experiment: the joint fit of its two recordings.
struct Row {
  ModelFit fit;
  double agreement_p = 1.0;
  int contaminated = 0;  ///< of the two recordings
};

inline Row characterise_row(const Experiment& experiment, const std::string& model, std::uint64_t seed,
                            std::uint64_t stream) {
  Row row;
  std::vector<WaveletRecord> records;
  for (std::uint64_t replicate = 0; replicate < 2; ++replicate) {
    const std::vector<double> x = record(experiment, seed, 2 * stream + replicate);
    const auto channel = characterise_channel({.values = x, .dt_s = kDt}, {.models = {"WN"}});
    row.contaminated += channel->contamination.verdict == "contaminated" ? 1 : 0;
    records.push_back(record_of(reported("x", ColumnRole{}, *channel)));
  }
  auto stack = Replicates::stack(records);
  Candidate joint = stack->fit(*parse_model(model));
  row.fit = stack->report(joint, IntervalMethod::Profile);
  row.agreement_p = stack->agreement(joint)->p;
  return row;
}

/// Does the interval hold the truth? Not identified: everything up to the limit that the data set.
inline bool holds(const FittedParameter& parameter, double truth) {
  return parameter.estimate ? parameter.estimate->ci95.contains(truth) : truth <= parameter.upper_limit;
}

}  // namespace driftlab::campaign
