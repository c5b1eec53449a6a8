#pragma once
/// Noise parameters in the file of another program (core/export/target.hpp): its names and numbers, and as comments
/// what they mean, where they come from and how well they are known.
#include "core/export/target.hpp"

#include <string>
#include <vector>

namespace driftlab {

/// The whole file. A number that the recording does not give is left out: its line is a comment that says why.
[[nodiscard]] std::string export_to_text(const ExportTarget& target, const ImuNoise& imu);

/// One sentence for each name of the file that has no value, or only an upper limit. Empty: everything is there.
[[nodiscard]] std::vector<std::string> export_gaps(const ExportTarget& target, const ImuNoise& imu);

/// Whether a noise density is known of any axis: without one there is nothing to use.
[[nodiscard]] bool has_noise(const ImuNoise& imu);

/// The targets with what each is, a line each.
[[nodiscard]] std::string export_targets_to_text();

}  // namespace driftlab
