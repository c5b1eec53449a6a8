#pragma once
/// The families of causes. A cause belongs to exactly one of them. The family says what the cause must declare, which
/// part of the search looks for it, how its gain is held out, and how it is taken out of the data once it has been
/// found.
///
/// A member without a default is one that every cause of the family must give: the compiler refuses a cause without it.
#include "core/investigate/causes/evidence.hpp"
#include "core/investigate/causes/shape_refinement.hpp"
#include "core/investigate/slow/slow_model.hpp"
#include "core/investigate/study/study.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <variant>
#include <vector>

namespace driftlab::investigate {

struct FullRate;

/// A cause that adds `amplitude` times a template to the error. The slow search fits it together with the slow noise,
/// and holds it out in segments that take turns.
struct MeanEffect {
  /// Templates over the grid of the whole file (one, or two for a free phase); false where an input is missing.
  bool (*build)(const StudyRecording& recording, const ChannelGroup& group, double shape,
                std::vector<std::vector<double>>& columns);
  int columns = 1;
  bool free_phase = false;  ///< two columns, and their combination differs from recording to recording: one amplitude
  /// Values of the shape to try; one value (ignored) where there is none.
  std::vector<double> (*shapes)(const ChannelGroup& group) = nullptr;
  ShapeRefinement refinement = {};  ///< of the shape, between the tried values
  /// Where each shape has a parameter of its own for its amplitude: the shape that belongs to each parameter.
  std::vector<double> shape_of_parameter = {};
  double penalty = 1.0;
  double (*shape_penalty)(double shape) = nullptr;  ///< added for that value
  bool scope_all = true;
  bool scope_moving = false;
  bool scope_single = false;
  bool change_point = false;  ///< a step at an unknown time, paid for as step_scan.hpp says; `build` takes t0
  /// The effect must be a small part of the reference rate. One that exceeds 0.3 of it is not an error of scale factor
  /// or mounting but of unit, axis or clock, and is left unexplained.
  bool part_of_rate = false;
  /// The part that all recordings share is the drift of an automatic baseline and not a finding.
  bool drift_of_baseline = false;
  /// One value moves several axes: findings on several axes are one finding, their values weighted by the squares of
  /// their intervals, their scores, held-out gains and held-out samples added.
  bool one_for_all_axes = false;
};

/// One more slow process in the noise. The slow search fits its level with the rest of the model; each half of the
/// recordings is held out in turn.
struct SlowNoise {
  const ProcessKind* kind;
};

/// White noise whose level differs between samples or recordings. Sought in the innovations at full rate and held out
/// in segments that take turns; once it is found the innovations are divided by its deviation.
struct NoiseLevel {
  std::vector<Evidence> (*examine)(const FullRate& data);
  /// Standard deviation of each innovation of member r relative to no effect.
  void (*deviation)(const FullRate& data, const Evidence& found, std::size_t r, std::vector<double>& sd);
  /// The deviation changes within one recording; with an automatic baseline that recording's own level is free, for the
  /// change says how much louder one part is than the other and not which of them is the usual one.
  bool within_recording = false;
  bool scales_slow = false;  ///< the slow part grows with the white one: the whole error is scaled
  /// The first parameter is the density of the white noise in place of the baseline's.
  bool replaces_white = false;
};

/// Differenced uniform noise. `Evidence::shape` is Q^2; the spectra of each half are held out in turn. Found in all
/// recordings, it becomes part of the model that whitens the innovations.
struct DifferencedNoise {
  std::vector<Evidence> (*examine)(const FullRate& data);
  /// Log likelihood gained on `data` by the effect as found elsewhere, nothing refitted.
  double (*log_gain)(const FullRate& data, const Evidence& found);
};

/// A low-pass that has narrowed the white noise. `Evidence::shape` is its corner [Hz]; the spectra of each half are
/// held out in turn. It is sought before everything else at full rate, because it colours the data that the other
/// searches use.
struct BandLimit {
  std::vector<Evidence> (*examine)(const FullRate& data);
  double (*log_gain)(const FullRate& data, const Evidence& found);  ///< as DifferencedNoise::log_gain
};

/// One more stationary process whose spectrum has a peak. The spectra of each half are held out in turn. It is sought
/// once a band limit is known; where it is found its density is expected in the spectra, and an autoregression takes it
/// out of the innovations.
struct SpectralPeak {
  std::vector<Evidence> (*examine)(const FullRate& data);
  double (*log_gain)(const FullRate& data, const Evidence& found);  ///< as DifferencedNoise::log_gain
  /// Its density at a frequency [SI^2/Hz, two-sided].
  double (*density)(const Evidence& found, double f_hz, double dt_s);
};

/// The distribution of the white noise. The innovations of each half are held out in turn; once it is found they become
/// normal scores.
struct NoiseTails {
  std::vector<Evidence> (*examine)(const FullRate& data);
  double (*log_gain)(const FullRate& data, const Evidence& found);  ///< as DifferencedNoise::log_gain
  /// Chance of an innovation beyond e >= 0 on one side, under the symmetric distribution found.
  std::function<double(double)> (*tail)(const FullRate& data, const Evidence& found);
  /// Variance that it adds to the white noise's own [SI^2]; null: none, the variance stays.
  double (*added_variance)(const Evidence& found) = nullptr;
};

/// A sinusoid. `Evidence::shape` is its frequency [Hz]; each half is held out in turn. It is sought beside the mean
/// effects and taken off the error.
struct SpectralLine {
  std::vector<Evidence> (*examine)(const FullRate& data);
  /// The found line once more in a part of the data, where `examine` would have to find it among all frequencies.
  Evidence (*find_again)(const FullRate& part, const Evidence& found);
  double (*log_gain)(const FullRate& data, const Evidence& found);  ///< as DifferencedNoise::log_gain
  /// Its values over the analysed part of member r, to be subtracted.
  std::vector<double> (*values)(const FullRate& data, std::size_t r, const Evidence& found);
};

/// Noise that several axes share. It is held out by `examine_together` itself.
struct CommonNoise {
  /// Members are those of the first axis.
  std::vector<Evidence> (*examine_together)(std::span<const FullRate> axes);
};

/// A fact that the file itself shows, before any model. Its rivals are not sought beside it, because the file leaves no
/// doubt. It is held out by its own log likelihood if it declares one, else by the rate of its events: the places that
/// it marks as events or as spoilt. A fact that declares none of these is not held out.
struct FileFact {
  /// Once `stop` is asked it ends early, and what it gives counts for nothing.
  std::vector<Evidence> (*find)(const ChannelGroup& group, const std::stop_token& stop);
  /// Marks the grid places of member r that the found fact has spoilt; nothing after it uses them.
  void (*spoils)(const ChannelGroup& group, const Evidence& found, std::size_t r,
                 std::vector<unsigned char>& mask) = nullptr;
  /// Marks the grid places at which the fact happened.
  void (*events)(const Channel& channel, std::vector<unsigned char>& mask) = nullptr;
  /// Log likelihood that each half of the channel gains by the fact as the other half shows it.
  double (*log_gain)(const Channel& channel) = nullptr;
  /// The first parameter is the step of the output's lattice, whose rounding the model must hold.
  bool gives_lattice_step = false;
};

/// Noise that jumps between levels: not Gaussian, though its spectrum is that of a slow process. It is sought in the
/// residuals of the search for slow effects and subtracted from the error; that search is then repeated, because a
/// process of the baseline may have been fitted to the jumps. `find` holds it out itself.
struct SwitchingNoise {
  std::optional<Evidence> (*find)(const FullRate& data);
  /// Its expected course over the analysed part of member r, to be subtracted.
  std::vector<double> (*values)(const FullRate& data, std::size_t r, const Evidence& found);
};

/// One fault of some recordings, and its repair.
struct FaultyRecordings {
  std::vector<ChannelName> channels;
  std::vector<FoundParameter> parameters;
  std::string sentence;  ///< what is wrong where, and what was done about it
  /// Puts the recordings right. Rows of a file that must be written anew are kept in `rows`.
  std::function<void(Study& study, std::deque<std::vector<double>>& rows)> mend;
};

/// A recording that differs from its description: another unit, another axis, a clock that breaks, samples resampled by
/// the driver. Such faults are sought in all recordings of the study together and repaired before any model is fitted.
/// Causes of this family are examined in the order of the registry, each on the recordings as repaired by those before
/// it. They are facts: nothing is held out.
struct RecordingFault {
  /// Once `stop` is asked it ends early, and what it gives counts for nothing.
  std::vector<FaultyRecordings> (*find)(const Study& study, const std::stop_token& stop);
};

using Family = std::variant<MeanEffect, SlowNoise, NoiseLevel, DifferencedNoise, BandLimit, SpectralPeak, NoiseTails,
                            SpectralLine, CommonNoise, SwitchingNoise, FileFact, RecordingFault>;

}  // namespace driftlab::investigate
