#pragma once
/// Angles are radians everywhere inside driftlab; degrees stand only in files, documents and texts.
#include <numbers>

namespace driftlab {

/// One degree in radians: an angle in degrees times this is the angle in radians.
inline constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace driftlab
