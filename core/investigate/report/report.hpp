#pragma once
/// The result of an investigation as values; schema/json/investigation.hpp writes it down (spec/causes.md).
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/search/channel_model.hpp"
#include "core/investigate/study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// One statistic compared with what the baseline model gives for the same recording.
struct Check {
  std::string id;
  std::string recording;  ///< empty: the whole channel
  std::string channel;
  double observed = 0.0;
  double q025 = 0.0, median = 0.0, q975 = 0.0;  ///< under the model
  double p = 1.0;
  double p_adjusted = 1.0;  ///< over all checks of the study together (Holm 1979)
  bool failed = false;      ///< p_adjusted is below 0.05
};

struct FindingGain {
  double log_score_per_sample = 0.0;  ///< [nat]
  double misfit_before = 0.0;         ///< [nat per sample]
  double misfit_after = 0.0;
  bool heldout = false;
  double share = 0.0;  ///< of the samples held out at a time
  double samples = 0.0;
};

/// 95 % band of a simulated statistic.
struct Band {
  std::vector<double> low, median, high;
};

/// What a figure of a finding shows (core/investigate/report/series.hpp).
struct FindingSeries {
  std::string recording;
  std::string channel;
  Unit unit;
  std::vector<double> scale_s, deviation_before, deviation_after;  ///< deviations [SI]
  Band baseline, extended;
  std::vector<double> f_hz, density_before, density_after, density_baseline;  ///< [SI^2/Hz]
  std::vector<double> time_s, error, effect;                                  ///< [SI]; effect: what was taken off
};

struct Finding {
  Evidence evidence;
  std::vector<std::string> channels;  ///< recording/column
  bool everywhere = true;             ///< in every recording of its channels
  std::vector<std::string> because;   ///< ids of checks
  std::string explanation;
  std::string next_measurement;
  FindingGain gain;
  FindingSeries series;  ///< of the first recording it acts in
};

struct Unexplained {
  std::string channel;
  std::string sentence;
  std::vector<std::string> checks;
};

struct NotExamined {
  std::string cause;
  std::string channel;
  std::string needs;
};

/// Mean horizontal position error at the end of simulated outages [m] (core/investigate/report/outage_gain.hpp).
struct OutageGain {
  Estimate baseline_m;  ///< as the baseline predicts it
  Estimate extended_m;  ///< as the extended model predicts it for a filter that still believes the baseline
  Estimate adopted_m;   ///< as the extended model predicts it for a filter that believes the extended model
  std::vector<std::string> left_out;             ///< findings that a navigation simulation cannot hold
  std::vector<std::string> left_out_of_filters;  ///< processes that are in the data and no filter can hold
};

struct Report {
  std::string study;
  bool automatic = true;
  Baseline baseline;                 ///< as the study gave it
  std::vector<ChannelModel> models;  ///< one per examined channel
  std::vector<Check> checks;
  std::size_t failed_before = 0;
  std::size_t failed_after = 0;
  double misfit_before = 0.0;
  double misfit_after = 0.0;
  std::vector<Finding> findings;  ///< strongest first
  std::optional<OutageGain>
      outages;  ///< nothing where no gyroscope or accelerometer axis was examined, or not asked for
  std::vector<Unexplained> unexplained;
  std::vector<NotExamined> not_examined;
  std::vector<std::string> notes;
};

}  // namespace driftlab::investigate
