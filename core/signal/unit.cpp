#include "core/signal/unit.hpp"

#include "core/signal/angle.hpp"

#include <array>
#include <cmath>
#include <utility>

namespace driftlab {
namespace {

struct Alias {
  std::string_view written;
  std::string_view symbol;
};

constexpr std::array kAliases{
    Alias{"sec", "s"},
    Alias{"seconds", "s"},
    Alias{"second", "s"},
    Alias{"µs", "us"},
    Alias{"°/s", "deg/s"},
    Alias{"dps", "deg/s"},
    Alias{"deg/sec", "deg/s"},
    Alias{"degree/s", "deg/s"},
    Alias{"degrees/s", "deg/s"},
    Alias{"rad/sec", "rad/s"},
    Alias{"°/h", "deg/h"},
    Alias{"deg/hr", "deg/h"},
    Alias{"m/s2", "m/s^2"},
    Alias{"m/s²", "m/s^2"},
    Alias{"m/s/s", "m/s^2"},
    Alias{"m/sec^2", "m/s^2"},
    Alias{"°C", "degC"},
    Alias{"celsius", "degC"},
    Alias{"°", "deg"},
    Alias{"degree", "deg"},
    Alias{"degrees", "deg"},
    Alias{"µT", "uT"},
    Alias{"", "1"},
    Alias{"-", "1"},
};

}  // namespace

const std::vector<Unit>& all_units() {
  static const std::vector<Unit> units{
      {"1", Dimension::One, 1.0, 0.0},
      {"s", Dimension::Time, 1.0, 0.0},
      {"ms", Dimension::Time, 1e-3, 0.0},
      {"us", Dimension::Time, 1e-6, 0.0},
      {"ns", Dimension::Time, 1e-9, 0.0},
      {"rad/s", Dimension::AngularRate, 1.0, 0.0},
      {"deg/s", Dimension::AngularRate, kDegree, 0.0},
      {"deg/h", Dimension::AngularRate, kDegree / 3600.0, 0.0},
      {"m/s^2", Dimension::SpecificForce, 1.0, 0.0},
      {"g", Dimension::SpecificForce, kStandardGravity, 0.0},
      {"mg", Dimension::SpecificForce, kStandardGravity * 1e-3, 0.0},
      {"K", Dimension::Temperature, 1.0, 0.0},
      {"degC", Dimension::Temperature, 1.0, 273.15},
      {"rad", Dimension::Angle, 1.0, 0.0},
      {"deg", Dimension::Angle, kDegree, 0.0},
      {"m", Dimension::Length, 1.0, 0.0},
      {"m/s", Dimension::Velocity, 1.0, 0.0},
      {"T", Dimension::MagneticField, 1.0, 0.0},
      {"uT", Dimension::MagneticField, 1e-6, 0.0},
  };
  return units;
}

Result<Unit> parse_unit(std::string_view symbol) {
  for (const Alias& alias : kAliases) {
    if (alias.written == symbol) {
      symbol = alias.symbol;
      break;
    }
  }
  for (const Unit& unit : all_units()) {
    if (unit.symbol == symbol) {
      return unit;
    }
  }
  std::string known;
  for (const Unit& unit : all_units()) {
    known += known.empty() ? "" : ", ";
    known += unit.symbol;
  }
  return fail(ErrorCode::UnknownUnit,
              "The unit '" + std::string(symbol) + "' is not known; known units are " + known + ".",
              {{"unit", std::string(symbol)}});
}

std::string_view si_symbol(Dimension dimension) {
  switch (dimension) {
    case Dimension::One:
      return "1";
    case Dimension::Time:
      return "s";
    case Dimension::AngularRate:
      return "rad/s";
    case Dimension::SpecificForce:
      return "m/s^2";
    case Dimension::Temperature:
      return "K";
    case Dimension::Angle:
      return "rad";
    case Dimension::Length:
      return "m";
    case Dimension::Velocity:
      return "m/s";
    case Dimension::MagneticField:
      return "T";
  }
  return "1";
}

ParameterUnit lab_unit(Dimension channel, int second_power_halves) {
  if (channel == Dimension::AngularRate) {
    // rad/s -> deg/h is 3600/kDegree; every half power of a second becomes a half power of an hour.
    switch (second_power_halves) {
      case 2:
        return {"deg", 1.0 / kDegree};  // Q: angle
      case 1:
        return {"deg/sqrt(h)", 60.0 / kDegree};  // N: rad/sqrt(s)
      case 0:
        return {"deg/h", 3600.0 / kDegree};  // B, sigma
      case -1:
        return {"deg/h/sqrt(h)", 3600.0 * 60.0 / kDegree};  // K
      case -2:
        return {"deg/h/h", 3600.0 * 3600.0 / kDegree};  // R
      default:
        break;
    }
  }
  if (channel == Dimension::SpecificForce) {
    switch (second_power_halves) {
      case 2:
        return {"m/s", 1.0};
      case 1:
        return {"m/s/sqrt(h)", 60.0};
      case 0:
        return {"mg", 1000.0 / kStandardGravity};
      case -1:
        return {"mg/sqrt(h)", 60.0 * 1000.0 / kStandardGravity};
      case -2:
        return {"mg/h", 3600.0 * 1000.0 / kStandardGravity};
      default:
        break;
    }
  }
  std::string symbol(si_symbol(channel));
  switch (second_power_halves) {
    case 0:
      break;
    case 1:
      symbol += "*sqrt(s)";
      break;
    case -1:
      symbol += "/sqrt(s)";
      break;
    case 2:
      symbol += "*s";
      break;
    case -2:
      symbol += "/s";
      break;
    default:
      symbol += "*s^(" + std::to_string(second_power_halves) + "/2)";
      break;
  }
  return {std::move(symbol), 1.0};
}

}  // namespace driftlab
