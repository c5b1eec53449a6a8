#pragma once
/// White noise that grows with a driver u, the reference rate or acceleration about the channel's axis (for
/// accelerometers: about z): N(u) = N0 (1 + k |u|). Innovations have variance c [1 + rho ((1 + k u)^2 - 1)], rho the
/// share of their variance that the white part drives.
#include "core/investigate/causes/cause.hpp"

#include <array>
#include <span>
#include <vector>

namespace driftlab::investigate {

/// The driver: `&StudyRecording::rate` or `&StudyRecording::acceleration`.
using Driver = std::array<std::vector<double>, 3> StudyRecording::*;

/// k by maximum likelihood over levels of |u|; nothing where there are fewer than two, or where noise does not grow.
[[nodiscard]] std::vector<Evidence> examine_driven(const FullRate& data, Driver driver, LabUnit (*unit)(const Unit&));

/// As NoiseLevel::deviation and Cause::inject.
void driven_deviation(const FullRate& data, const Evidence& found, std::size_t r, Driver driver,
                      std::vector<double>& sd);
void inject_driven(Draft& draft, double k, Driver driver);

/// k that is seen at z standard deviations (Showing::values): the information on it is 2 sum u^2, u about its mean
/// where the level is free.
[[nodiscard]] double shown_driven(const Stage& stage, Driver driver);

}  // namespace driftlab::investigate
