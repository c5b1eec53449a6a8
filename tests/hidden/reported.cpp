#include "tests/hidden/reported.hpp"

#include <cmath>
#include <numbers>

namespace driftlab::hidden {

using investigate::Cause;
using investigate::MeanEffect;

namespace {

struct Word {
  std::string_view symbol;
  WrittenUnit unit;
};

const std::array kWords{Word{"1", {1.0, {}}},
                        Word{"ppm", {1e6, {}}},
                        Word{"rad", {1.0, {1.0, 0.0, 0.0, 0.0}}},
                        Word{"deg", {180.0 / std::numbers::pi, {1.0, 0.0, 0.0, 0.0}}},
                        Word{"m", {1.0, {0.0, 1.0, 0.0, 0.0}}},
                        Word{"s", {1.0, {0.0, 0.0, 1.0, 0.0}}},
                        Word{"h", {1.0 / 3600.0, {0.0, 0.0, 1.0, 0.0}}},
                        Word{"Hz", {1.0, {0.0, 0.0, -1.0, 0.0}}},
                        Word{"K", {1.0, {0.0, 0.0, 0.0, 1.0}}},
                        Word{"degC", {1.0, {0.0, 0.0, 0.0, 1.0}}}};

WrittenUnit raised(WrittenUnit unit, double power) {
  unit.per_si = std::pow(unit.per_si, power);
  for (double& p : unit.powers) {
    p *= power;
  }
  return unit;
}

/// product := factor (('/' | '*') factor)*, factor := (word | '(' product ')' | 'sqrt(' product ')') ['^' digit]
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(text) {}

  std::optional<WrittenUnit> whole() {
    const std::optional<WrittenUnit> unit = product();
    return rest_.empty() ? unit : std::nullopt;
  }

 private:
  std::optional<WrittenUnit> product() {
    std::optional<WrittenUnit> unit = factor();
    while (unit && (rest_.starts_with('/') || rest_.starts_with('*'))) {
      const double power = rest_.front() == '/' ? -1.0 : 1.0;
      rest_.remove_prefix(1);
      const std::optional<WrittenUnit> next = factor();
      if (!next) {
        return std::nullopt;
      }
      const WrittenUnit with = raised(*next, power);
      unit->per_si *= with.per_si;
      for (std::size_t k = 0; k < unit->powers.size(); ++k) {
        unit->powers[k] += with.powers[k];
      }
    }
    return unit;
  }

  std::optional<WrittenUnit> factor() {
    std::optional<WrittenUnit> unit;
    double power = 1.0;
    const bool root = take("sqrt(");
    if (root || take("(")) {
      unit = product();
      power = root ? 0.5 : 1.0;
      if (!take(")")) {
        return std::nullopt;
      }
    } else {
      unit = word();
    }
    if (unit && take("^")) {
      if (rest_.empty() || rest_.front() < '1' || rest_.front() > '9') {
        return std::nullopt;
      }
      power *= rest_.front() - '0';
      rest_.remove_prefix(1);
    }
    return unit ? std::optional(raised(*unit, power)) : std::nullopt;
  }

  std::optional<WrittenUnit> word() {
    const std::string_view name = rest_.substr(0, rest_.find_first_of("/*^()"));
    for (const Word& known : kWords) {
      if (known.symbol == name) {
        rest_.remove_prefix(name.size());
        return known.unit;
      }
    }
    return std::nullopt;
  }

  bool take(std::string_view text) {
    if (!rest_.starts_with(text)) {
      return false;
    }
    rest_.remove_prefix(text.size());
    return true;
  }

  std::string_view rest_;
};

}  // namespace

bool WrittenUnit::measures_as(const WrittenUnit& other) const { return powers == other.powers; }

std::optional<WrittenUnit> read_unit(std::string_view symbol) { return Reader(symbol).whole(); }

std::string in_unit_of_channel(std::string_view equation_unit, Quantity quantity) {
  std::string unit(equation_unit);
  if (const std::size_t at = unit.find('y'); at != std::string::npos) {
    unit.replace(at, 1, quantity == Quantity::SpecificForce ? "(m/s^2)" : "(rad/s)");
  }
  return unit;
}

std::optional<double> hidden_value(const Case& hidden, const Cause& cause, std::string_view parameter) {
  const std::vector<double>& values = hidden.effect.values;
  const MeanEffect* const mean = cause.as<MeanEffect>();
  for (std::size_t k = 0; k < cause.parameters.size(); ++k) {
    if (cause.parameters[k].name != parameter) {
      continue;
    }
    if (mean != nullptr && !mean->shape_of_parameter.empty()) {
      return values.size() > 1 && values[1] == mean->shape_of_parameter[k] ? std::optional(values[0]) : std::nullopt;
    }
    return k < values.size() ? std::optional(values[k]) : std::nullopt;
  }
  return std::nullopt;
}

Interval twice_as_long(const Estimate& estimate) {
  const double value = estimate.value;
  const Interval ci = estimate.ci95;
  // What is known exactly, a count or a clipped value, is known to the digits of the file.
  const double digits = 1e-6 * std::fabs(value);
  if (ci.low * value > 0.0 && ci.high * value > 0.0) {
    return {ci.low * (ci.low / value) - digits, ci.high * (ci.high / value) + digits};
  }
  return {2.0 * ci.low - value - digits, 2.0 * ci.high - value + digits};
}

}  // namespace driftlab::hidden
