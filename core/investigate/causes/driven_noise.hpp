#pragma once
/// White noise that grows with a driver u: N(u) = N0 (1 + k |u|). The driver is the reference rate or acceleration
/// about the channel's axis (for accelerometers: about z). The innovations have the variance c [1 + rho ((1 + k u)^2 -
/// 1)], where rho is the share of their variance that the white part causes.
#include "core/investigate/causes/cause.hpp"

#include <array>
#include <span>
#include <vector>

namespace driftlab::investigate {

/// The driver: `&StudyRecording::rate` or `&StudyRecording::acceleration`.
using Driver = std::array<Series, 3> StudyRecording::*;

/// k by maximum likelihood over levels of |u|; nothing where there are fewer than two, or where noise does not grow.
[[nodiscard]] std::vector<Evidence> examine_driven(const FullRate& data, Driver driver, LabUnit (*unit)(const Unit&));

/// As NoiseLevel::deviation and Cause::inject.
void driven_deviation(const FullRate& data, const Evidence& found, std::size_t r, Driver driver,
                      std::vector<double>& sd);
void inject_driven(Draft& draft, double k, Driver driver);

/// The value of k that would be detected at z standard deviations (Showing::values). The information on k is 2 sum u^2,
/// with u taken about its mean if the noise level is free.
[[nodiscard]] double shown_driven(const Stage& stage, Driver driver);

}  // namespace driftlab::investigate
