#pragma once
/// Angles that start again after a turn, and the rates behind them.
///
/// An encoder that goes from 359.9 to 0.1 deg has not turned back. A step of more than half a turn from one sample to
/// the next is taken the short way, so a reference must turn by less than half a turn between samples: at 100 Hz below
/// 18,000 deg/s.
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace driftlab {

/// One turn [rad].
inline constexpr double kTurn = 2.0 * std::numbers::pi;

/// `angle` [rad] with as many whole turns added as bring it nearest to `near`.
[[nodiscard]] double nearest_turn(double angle, double near);

/// Angles [rad] made continuous. `places` says where on an even grid each of them was taken, strictly rising; empty:
/// one after the other. Over places without a sample the angle is taken to go on at the pace it had before, for of
/// whole turns inside a gap nothing else is known. Angles that never start again come back unchanged, whatever they do
/// over gaps; values that are not finite stay where they are. O(n).
[[nodiscard]] std::vector<double> continuous_angle(std::span<const double> angles, std::span<const std::size_t> places);

/// Slope of values at even steps: central differences, one-sided at the ends; 0 of a single value.
[[nodiscard]] std::vector<double> slope(std::span<const double> values, double dt_s);

/// Rate [rad/s] behind angles [rad] at even steps: the same differences, with whole turns taken out.
[[nodiscard]] std::vector<double> rate_of_angle(std::span<const double> angles, double dt_s);

}  // namespace driftlab
