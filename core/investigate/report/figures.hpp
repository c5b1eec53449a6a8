#pragma once
/// What the figures of an investigation show of one channel, once for all its findings and over all its recordings.
///
/// There are five views:
/// - Scales: the Haar wavelet deviation by scale, from coefficients that do not overlap and whose squares are nearly
///   independent, with the 95 % band of a chi-square of as many degrees of freedom.
/// - Ratios: the wavelet variance of the innovations over that of a right model, which is what the checks judge, with
///   the range in which it should lie.
/// - Spectrum: the two-sided density of the error, as the mean over stretches of equal length of all recordings, in
///   bins of equal width. Beside it stand the largest single ordinate of each bin, which a mean would hide, and the
///   height that the largest of all ordinates exceeds by chance in one spectrum of twenty.
/// - Course: means over at most 200 stretches of time of one recording, the first that a finding names.
/// - Spectrogram of the innovations: of the recording whose noise changes most, where it still does beside the findings
///   (innovation_spectrogram.hpp).
///
/// "Before" is the error under the baseline that knows of no effect. "After" is the error without every mean effect
/// that was found, compared with the noise of the extended model. Causes that change the level or distribution of the
/// white part show in the comparison of "before" with "baseline".
#include "core/investigate/report/report.hpp"
#include "core/investigate/search/group_search.hpp"

namespace driftlab::investigate {

/// What the figures of a channel take from its samples.
struct MeasuredFigures {
  struct Course {
    std::string recording;
    std::vector<double> time_s, error, effect;
  };
  ChannelFigures figures;       ///< without ratios and course
  std::vector<Course> courses;  ///< one per member
};

/// Of a usable channel. O(samples log samples).
[[nodiscard]] MeasuredFigures measure_figures(const ChannelGroup& group, const GroupOutcome& outcome);

/// `shown`: the member whose course is drawn. The checks of the channel give the ratios.
[[nodiscard]] ChannelFigures figures_of(const MeasuredFigures& measured, std::size_t shown,
                                        const std::vector<Check>& checks);

/// The Allan deviation of a channel at the scales of its figures: as measured, as the baseline has it, and as the
/// extended model has it with the effects taken off put back. sqrt(2) times the Haar deviation at half the scale.
[[nodiscard]] std::vector<AllanChange> allan_changes(const ChannelFigures& figures);

}  // namespace driftlab::investigate
