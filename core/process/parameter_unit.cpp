#include "core/process/parameter_unit.hpp"

#include "core/signal/angle.hpp"

#include <array>
#include <cctype>
#include <cmath>
#include <string>

namespace driftlab {
namespace {

struct Base {
  std::string_view symbol;
  ParameterUnitValue value;
};

constexpr std::array kBases{
    Base{"rad", {1.0, 2, 0, 0}},
    Base{"mrad", {1e-3, 2, 0, 0}},
    Base{"deg", {kDegree, 2, 0, 0}},
    Base{"arcsec", {kDegree / 3600.0, 2, 0, 0}},
    Base{"m", {1.0, 0, 2, 0}},
    Base{"mm", {1e-3, 0, 2, 0}},
    Base{"g", {kStandardGravity, 0, 2, -4}},
    Base{"mg", {kStandardGravity * 1e-3, 0, 2, -4}},
    Base{"ug", {kStandardGravity * 1e-6, 0, 2, -4}},
    Base{"s", {1.0, 0, 0, 2}},
    Base{"ms", {1e-3, 0, 0, 2}},
    Base{"us", {1e-6, 0, 0, 2}},
    Base{"min", {60.0, 0, 0, 2}},
    Base{"h", {3600.0, 0, 0, 2}},
    Base{"hr", {3600.0, 0, 0, 2}},
    Base{"Hz", {1.0, 0, 0, -2}},
    Base{"dps", {kDegree, 2, 0, -2}},
    Base{"ppm", {1e-6, 0, 0, 0}},
    Base{"1", {1.0, 0, 0, 0}},
};

/// Reads a unit expression from left to right.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  bool read(ParameterUnitValue& value) {
    double sign = 1.0;
    for (;;) {
      ParameterUnitValue factor;
      double power = 1.0;
      if (!read_factor(factor, power)) {
        return false;
      }
      const double exponent = sign * power;
      value.factor *= std::pow(factor.factor, exponent);
      value.angle += static_cast<int>(std::lround(exponent * factor.angle));
      value.length += static_cast<int>(std::lround(exponent * factor.length));
      value.second += static_cast<int>(std::lround(exponent * factor.second));
      if (rest_.empty()) {
        return true;
      }
      if (rest_.front() != '*' && rest_.front() != '/') {
        return false;
      }
      sign = rest_.front() == '/' ? -1.0 : 1.0;
      rest_.remove_prefix(1);
    }
  }

 private:
  bool read_factor(ParameterUnitValue& factor, double& power) {
    if (rest_.starts_with("sqrt(")) {
      rest_.remove_prefix(5);
      if (!read_symbol(factor) || rest_.empty() || rest_.front() != ')') {
        return false;
      }
      rest_.remove_prefix(1);
      power = 0.5;
      return true;
    }
    if (!read_symbol(factor)) {
      return false;
    }
    if (rest_.size() >= 2 && rest_.front() == '^' && std::isdigit(static_cast<unsigned char>(rest_[1])) != 0) {
      power = rest_[1] - '0';
      rest_.remove_prefix(2);
    }
    return true;
  }

  bool read_symbol(ParameterUnitValue& factor) {
    std::size_t length = 0;
    while (length < rest_.size() && std::isalnum(static_cast<unsigned char>(rest_[length])) != 0) {
      ++length;
    }
    for (const Base& base : kBases) {
      if (base.symbol == rest_.substr(0, length)) {
        factor = base.value;
        rest_.remove_prefix(length);
        return true;
      }
    }
    return false;
  }

  std::string_view rest_;
};

}  // namespace

Result<ParameterUnitValue> parse_parameter_unit(std::string_view text) {
  ParameterUnitValue value;
  if (!Reader(text).read(value)) {
    return fail(ErrorCode::UnknownUnit, "The unit '" + std::string(text) + "' of a parameter is not understood.",
                {{"unit", std::string(text)}});
  }
  return value;
}

Result<double> parameter_factor(std::string_view symbol, Dimension channel, const ParameterSpec& spec) {
  const auto unit = parse_parameter_unit(symbol);
  if (!unit) {
    return fail(unit.error());
  }
  int angle = 0;
  int length = 0;
  int second = spec.second_power_halves;
  if (spec.channel_power == 1 && channel == Dimension::AngularRate) {
    angle = 2;
    second -= 2;
  } else if (spec.channel_power == 1 && channel == Dimension::SpecificForce) {
    length = 2;
    second -= 4;
  }
  if (unit->angle != angle || unit->length != length || unit->second != second) {
    return fail(ErrorCode::UnitMismatch,
                "The unit '" + std::string(symbol) + "' does not fit the parameter " + std::string(spec.name) + ".",
                {{"unit", std::string(symbol)}});
  }
  return unit->factor;
}

bool measures(const ParameterUnitValue& unit, Quantity quantity, int per_seconds) {
  const int seconds = unit.second + 2 * per_seconds;  // exponents in halves
  return quantity == Quantity::Unspecified ||
         (quantity == Quantity::AngularRate ? unit.angle == 2 && unit.length == 0 && seconds == -2
                                            : unit.angle == 0 && unit.length == 2 && seconds == -4);
}

}  // namespace driftlab
