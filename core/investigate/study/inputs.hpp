#pragma once
/// The inputs that drive effects (rates, their derivatives, specific force), for the causes that need them.
#include "core/investigate/study/study.hpp"

#include <functional>
#include <string>
#include <vector>

namespace driftlab::investigate {

/// Length of the longest analysed part [s].
[[nodiscard]] double longest_s(const ChannelGroup& group);

/// Does any recording of the group turn about axis k?
[[nodiscard]] bool turns_about(const ChannelGroup& group, std::size_t k);

/// One column f(w), w the reference rate about the group's own axis; false where there is none.
bool follow_rate(const StudyRecording& recording, const ChannelGroup& group, std::vector<std::vector<double>>& columns,
                 const std::function<double(double)>& f);

/// One column f(t, dw/dt) of a recording whose rate changes.
bool follow_slope(const StudyRecording& recording, const ChannelGroup& group, std::vector<std::vector<double>>& columns,
                  const std::function<double(double, double)>& f);

/// Variance in a centred window of `window` samples, shorter at the ends.
[[nodiscard]] std::vector<double> running_variance(const Series& values, double window);

[[nodiscard]] std::string lacks_rotation(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_profile(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_force(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_stamps(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_axes(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_recordings(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_rates(const Study& study, const ChannelGroup& group);
[[nodiscard]] std::string lacks_slopes(const Study& study, const ChannelGroup& group);
/// Under an automatic baseline: a noise that all recordings share is the baseline's.
[[nodiscard]] std::string lacks_contrast(const Study& study, const ChannelGroup& group);
/// The same for slow noise, which single recordings do not contrast.
[[nodiscard]] std::string lacks_motion(const Study& study, const ChannelGroup& group);

}  // namespace driftlab::investigate
