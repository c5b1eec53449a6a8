#pragma once
/// The result of an investigation as values; schema/json/investigation.hpp writes it down (spec/causes.md).
#include "core/campaign/verdict.hpp"
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/search/channel_model.hpp"
#include "core/investigate/study/study.hpp"
#include "core/investigate/unnamed/unnamed_search.hpp"

#include <optional>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// Whether a check fails and, if it does, what accounts for it; every failed check ends in one of the last three.
enum class CheckEnd {
  None,         ///< it does not fail
  Finding,      ///< a finding rests on it
  Mended,       ///< the extended model mends it, though no finding names it
  Unexplained,  ///< it fails with the extended model too
};

/// One statistic compared with what the baseline model gives for the same recording, and with the extended model.
struct Check {
  std::string id;
  std::string title;      ///< for people
  std::string recording;  ///< empty: the whole channel
  std::string channel;
  double observed = 0.0;
  double q025 = 0.0, median = 0.0, q975 = 0.0;  ///< under the model
  double p = 1.0;
  double p_adjusted = 1.0;      ///< over all checks of the study together, before and after (Holm 1979)
  bool failed = false;          ///< p_adjusted is below 0.05
  double excess = 0.0;          ///< log likelihood that the misfit it shows is worth [nat], 0 for checks of causes
  bool of_slow_misfit = false;  ///< what mean effects and slow noise explain
  bool of_spectrum = false;     ///< how power lies over frequencies or scales, all of a recording together
  double scale_s = 0.0;         ///< of a wavelet variance; 0 for others
  double observed_after = 0.0;  ///< the same under the extended model
  double p_after = 1.0;
  double p_after_adjusted = 1.0;
  bool failed_after = false;
  double excess_after = 0.0;
  CheckEnd end = CheckEnd::None;
};

/// What a finding gains on data that it was not fitted to. Nats belong to the details: people read the share of the
/// misfit.
struct FindingGain {
  double log_score_per_sample = 0.0;  ///< [nat]
  double misfit_before = 0.0;         ///< [nat per sample]
  double misfit_after = 0.0;
  bool heldout = false;
  double share = 0.0;  ///< of the samples held out at a time
  double samples = 0.0;
  /// It tells how the file was written (its digits, its absent rows) and not how the sensor errs: it is no part of any
  /// sum of gains. The gain of a lattice is ln(step / last printed digit) per sample, however little it disturbs.
  bool of_the_file = false;
  double explained = 0.0;  ///< share of the misfit that the checks can see, 0 to 1; 0 where `of_the_file`
};

/// 95 % band of a simulated statistic.
struct Band {
  std::vector<double> low, median, high;
};

/// Wavelet variance of a recording's innovations at one scale over that of a right model.
struct InnovationRatio {
  std::string recording;
  double scale_s = 0.0;
  double before = 0.0, after = 0.0;
  double low = 0.0, high = 0.0;  ///< where 95 % of right models lie
};

/// The density of innovations over that of white ones, by time and frequency (core/investigate/report/
/// innovation_spectrogram.hpp).
struct InnovationSpectrogram {
  std::string recording;
  std::vector<double> time_s;       ///< from the first sample of the file
  std::vector<double> f_hz;         ///< rising
  std::vector<double> log10_ratio;  ///< cells x bands, cell by cell; NaN: no sample there
};

/// What the figures of a channel show (core/investigate/report/figures.hpp).
struct ChannelFigures {
  std::string channel;
  std::string recording;  ///< whose course it is
  Unit unit;
  std::vector<double> scale_s, deviation_before, deviation_after;  ///< deviations [SI]
  Band baseline, extended;
  std::vector<InnovationRatio> ratios;
  std::vector<double> f_hz, density_before, density_after, highest_before, highest_after, chance;  ///< [SI^2/Hz]
  Band density_baseline;
  std::vector<double> time_s, error, effect;         ///< [SI]; effect: what was taken off
  std::optional<InnovationSpectrogram> spectrogram;  ///< where noise still changes in time or frequency
};

/// Allan deviation of a channel at one averaging time [SI].
struct AllanChange {
  double tau_s = 0.0;
  double measured = 0.0, baseline = 0.0, extended = 0.0;
};

struct Finding {
  Evidence evidence;
  std::vector<ChannelName> channels;
  bool everywhere = true;            ///< in every recording of its channels
  std::vector<std::string> because;  ///< ids of checks
  std::string explanation;
  std::string next_measurement;
  FindingGain gain;
};

/// What the extended model does not describe; every check that fails with it stands in one of these.
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
  Verdict summary;  ///< what it comes to, in a sentence (report/verdict.hpp)
  bool automatic = true;
  Baseline baseline;                 ///< as the study gave it
  std::vector<ChannelModel> models;  ///< one per examined channel
  std::vector<Check> checks;
  std::size_t failed_before = 0;
  std::size_t failed_after = 0;
  double misfit_before = 0.0;
  double misfit_after = 0.0;
  double explained = 0.0;               ///< share of the misfit that the findings explain, 0 to 1
  std::vector<Finding> findings;        ///< in the order in which a laboratory would act on them (report/order.hpp)
  std::vector<ChannelFigures> figures;  ///< one per examined channel
  std::optional<OutageGain>
      outages;  ///< nothing where no gyroscope or accelerometer axis was examined, or not asked for
  std::vector<Unexplained> unexplained;
  std::vector<UnnamedFinding> unnamed;  ///< profiles without a name that the extended model holds
  std::vector<NotExamined> not_examined;
  std::vector<std::string> notes;
};

}  // namespace driftlab::investigate
