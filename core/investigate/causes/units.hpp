#pragma once
/// The units in which causes report their parameters.
#include "core/investigate/causes/evidence.hpp"
#include "core/signal/angle.hpp"

namespace driftlab::investigate::units {

inline LabUnit level(const Unit& u) { return level_unit(u); }
inline LabUnit per_second(const Unit& u) { return level_unit(u, "/s"); }
inline LabUnit per_root_second(const Unit& u) { return level_unit(u, "/sqrt(s)"); }
inline LabUnit per_kelvin(const Unit& u) { return level_unit(u, "/degC"); }
inline LabUnit per_force(const Unit& u) { return level_unit(u, "/(m/s^2)"); }
inline LabUnit per_force_squared(const Unit& u) { return level_unit(u, "/(m/s^2)^2"); }
inline LabUnit density(const Unit& u) {
  const ParameterUnit unit = lab_unit(u.dimension, 1);
  return {unit.symbol, unit.per_si};
}
inline LabUnit integral(const Unit& u) {
  const ParameterUnit unit = lab_unit(u.dimension, 2);
  return {unit.symbol, unit.per_si};
}
inline LabUnit seconds(const Unit& /*u*/) { return {"s", 1.0}; }
inline LabUnit hertz(const Unit& /*u*/) { return {"Hz", 1.0}; }
inline LabUnit one(const Unit& /*u*/) { return {"1", 1.0}; }
inline LabUnit ppm(const Unit& /*u*/) { return {"ppm", 1e6}; }
inline LabUnit radians(const Unit& /*u*/) { return {"rad", 1.0}; }
inline LabUnit degrees(const Unit& /*u*/) { return {"deg", 1.0}; }
inline LabUnit metres(const Unit& /*u*/) { return {"m", 1.0}; }
inline LabUnit per_hertz_rate(const Unit& /*u*/) { return {"1/s", 1.0}; }
inline LabUnit per_rate(const Unit& /*u*/) { return {"s/deg", kDegree}; }
inline LabUnit per_rate_squared(const Unit& /*u*/) { return {"s^2/deg^2", kDegree * kDegree}; }
inline LabUnit per_acceleration(const Unit& /*u*/) { return {"s^2/deg", kDegree}; }

}  // namespace driftlab::investigate::units
