#include "core/signal/unit.hpp"

#include "core/signal/angle.hpp"
#include "core/signal/text.hpp"
#include "core/signal/written_scale.hpp"

#include <algorithm>
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
    Alias{"mdps", "mdeg/s"},
    Alias{"deg/second", "deg/s"},
    Alias{"degrees/second", "deg/s"},
    Alias{"degrees/sec", "deg/s"},
    Alias{"°/sec", "deg/s"},
    Alias{"rad/second", "rad/s"},
    Alias{"radians/s", "rad/s"},
    Alias{"radians/sec", "rad/s"},
    Alias{"radians/second", "rad/s"},
    Alias{"µg", "ug"},
    Alias{"msec", "ms"},
    Alias{"usec", "us"},
    Alias{"µsec", "us"},
    Alias{"nsec", "ns"},
    Alias{"milliseconds", "ms"},
    Alias{"microseconds", "us"},
    Alias{"nanoseconds", "ns"},
    Alias{"rads/s", "rad/s"},
    Alias{"rads/sec", "rad/s"},
    Alias{"µrad/s", "urad/s"},
    Alias{"deg/hour", "deg/h"},
    Alias{"degree/h", "deg/h"},
    Alias{"degrees/h", "deg/h"},
    Alias{"degrees/hour", "deg/h"},
    Alias{"°/hr", "deg/h"},
    Alias{"°/hour", "deg/h"},
    Alias{"°/min", "deg/min"},
    Alias{"mps2", "m/s^2"},
    Alias{"mps^2", "m/s^2"},
    Alias{"m/sec2", "m/s^2"},
    Alias{"mm/s2", "mm/s^2"},
    Alias{"mm/s²", "mm/s^2"},
    Alias{"cm/s2", "cm/s^2"},
    Alias{"cm/s²", "cm/s^2"},
    Alias{"g0", "g"},
    Alias{"gn", "g"},
    Alias{"mgal", "mGal"},
    Alias{"deg C", "degC"},
    Alias{"° C", "degC"},
    Alias{"℃", "degC"},
    Alias{"Kelvin", "K"},
    Alias{"", "1"},
    Alias{"-", "1"},
    Alias{"LSB", "1"},
    Alias{"lsb", "1"},
    Alias{"LSb", "1"},
    Alias{"LSBs", "1"},
    Alias{"lsbs", "1"},
    Alias{"count", "1"},
    Alias{"counts", "1"},
    Alias{"digit", "1"},
    Alias{"digits", "1"},
    Alias{"raw", "1"},
};

/// Powers of a second as they are written behind a product, and behind a slash.
constexpr std::array kPowers{
    Alias{" s^-1", "/s"},   Alias{" s-1", "/s"},   Alias{" s⁻¹", "/s"},
    Alias{" s^-2", "/s^2"}, Alias{" s-2", "/s^2"}, Alias{" s⁻²", "/s^2"},
};

/// Characters that look like others and stand for them, and a power as programs write it.
constexpr std::array kLookalikes{
    Alias{"μ", "µ"},  // Greek mu (U+03BC) for the micro sign (U+00B5)
    Alias{"º", "°"},  // the ordinal sign (U+00BA), a key of Spanish keyboards, for the degree sign (U+00B0)
    Alias{"˚", "°"},  // the ring (U+02DA), a key of Macs
    Alias{"**", "^"},
};

/// `m/(s^2)` without its brackets.
void open_denominator(std::string& text) {
  const std::size_t open = text.find("/(s");
  if (open != std::string::npos && text.find(')') + 1 == text.size()) {
    text.pop_back();
    text.erase(open + 1, 1);
  }
}

/// `rad s^-1`, `rad·s⁻¹`, `m*s^-2`, `m.s-2`, `m/(s^2)` as a quotient; of characters that look alike one.
std::string as_quotient(std::string_view written) {
  std::string text(written);
  for (const Alias& lookalike : kLookalikes) {
    for (std::size_t at = text.find(lookalike.written); at != std::string::npos;
         at = text.find(lookalike.written, at)) {
      text.replace(at, lookalike.written.size(), lookalike.symbol);
      at += lookalike.symbol.size();
    }
  }
  open_denominator(text);
  for (const std::string_view dot : {"·", "⋅", "*", "."}) {
    const std::size_t at = text.rfind(dot);
    if (at != std::string::npos && text.substr(at + dot.size()).starts_with("s")) {
      text.replace(at, dot.size(), " ");
    }
  }
  for (const Alias& power : kPowers) {
    if (text.ends_with(power.written)) {
      text.replace(text.size() - power.written.size(), power.written.size(), power.symbol);
    }
  }
  return text;
}

/// True where `written` means `unit` in capitals too: words and what has degrees or radians in it. Not where case tells
/// apart what is meant: s from siemens, g from gauss, m from mega, T from t.
bool means_the_same_in_capitals(std::string_view written, const Unit& unit) {
  switch (unit.dimension) {
    case Dimension::AngularRate:
      return true;
    case Dimension::Angle:
    case Dimension::Time:
    case Dimension::One:
      return written.size() > 2;
    case Dimension::Temperature:
      return written.size() > 1;
    default:
      return false;
  }
}

/// The unit with this symbol, which is one of all_units().
const Unit* find_unit(std::string_view symbol) {
  const auto& units = all_units();
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& unit) { return unit.symbol == symbol; });
  return found == units.end() ? nullptr : &*found;
}

/// The unit that is `written` but for the case of letters. A capital M in front may be mega and stays unknown.
const Unit* find_in_any_case(std::string_view written) {
  if (written.starts_with('M')) {
    return nullptr;
  }
  const std::string lower = lower_case(written);
  for (const Alias& alias : kAliases) {
    const Unit* const unit = lower_case(alias.written) == lower ? find_unit(alias.symbol) : nullptr;
    if (unit != nullptr && means_the_same_in_capitals(written, *unit)) {
      return unit;
    }
  }
  for (const Unit& unit : all_units()) {
    if (lower_case(unit.symbol) == lower && means_the_same_in_capitals(written, unit)) {
      return &unit;
    }
  }
  return nullptr;
}

std::optional<Unit> plain_unit(std::string_view symbol) {
  const auto alias =
      std::find_if(kAliases.begin(), kAliases.end(), [symbol](const Alias& known) { return known.written == symbol; });
  const Unit* unit = find_unit(alias == kAliases.end() ? symbol : alias->symbol);
  unit = unit == nullptr ? find_in_any_case(symbol) : unit;
  return unit == nullptr ? std::nullopt : std::optional(*unit);
}

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
      {"deg/min", Dimension::AngularRate, kDegree / 60.0, 0.0},
      {"mdeg/s", Dimension::AngularRate, kDegree * 1e-3, 0.0},
      {"mrad/s", Dimension::AngularRate, 1e-3, 0.0},
      {"urad/s", Dimension::AngularRate, 1e-6, 0.0},
      {"rpm", Dimension::AngularRate, 6.0 * kDegree, 0.0},
      {"m/s^2", Dimension::SpecificForce, 1.0, 0.0},
      {"g", Dimension::SpecificForce, kStandardGravity, 0.0},
      {"mg", Dimension::SpecificForce, kStandardGravity * 1e-3, 0.0},
      {"ug", Dimension::SpecificForce, kStandardGravity * 1e-6, 0.0},
      {"mm/s^2", Dimension::SpecificForce, 1e-3, 0.0},
      {"cm/s^2", Dimension::SpecificForce, 1e-2, 0.0},
      {"mGal", Dimension::SpecificForce, 1e-5, 0.0},
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

namespace {

/// The unit of counts that are scaled and shifted into `unit`.
Result<Unit> scaled(const std::string& symbol, const WrittenScale& written, const Unit& unit) {
  if (!(written.scale > 0.0) || !std::isfinite(written.scale)) {
    return fail(ErrorCode::UnknownUnit,
                "The scale in the unit '" + symbol +
                    "' must be a positive number; write deg/s/131 for 131 counts in a deg/s, or degC/340+36.53 with an "
                    "offset.",
                {{"unit", symbol}});
  }
  if (written.offset != 0.0 && (unit.dimension == Dimension::One || unit.dimension == Dimension::Time)) {
    return fail(ErrorCode::UnknownUnit,
                "The unit '" + symbol + "' has an offset, but " +
                    (unit.dimension == Dimension::One ? "names no unit in which it is" : "a time has none") +
                    "; write for example degC/340+36.53 for a temperature of counts/340 + 36.53 degrees.",
                {{"unit", symbol}});
  }
  return Unit{written.canonical, unit.dimension, unit.factor * written.scale,
              unit.factor * written.offset + unit.offset};
}

}  // namespace

Result<Unit> parse_unit(std::string_view symbol) {
  if (auto unit = plain_unit(as_quotient(symbol))) {
    return *std::move(unit);
  }
  const auto plain = [](std::string_view written) { return plain_unit(as_quotient(written)); };
  if (const auto written = read_scale(symbol, [&](std::string_view base) { return plain(base).has_value(); })) {
    if (const auto base = plain(written->unit)) {
      return scaled(std::string(symbol), *written, *base);
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
