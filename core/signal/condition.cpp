#include "core/signal/condition.hpp"

#include "core/signal/angle.hpp"
#include "core/signal/number.hpp"
#include "core/signal/text.hpp"

#include <array>
#include <cmath>
#include <vector>

namespace driftlab {
namespace {

constexpr std::array kKinds{
    ConditionKind::Static,  ConditionKind::ConstantRate, ConditionKind::ConstantAngularAcceleration,
    ConditionKind::Profile, ConditionKind::SixPosition,  ConditionKind::Drive};

/// deg/s^2 and rad/s^2 are units of a condition only, so they live here and not in the unit table.
Result<double> angular_acceleration_factor(std::string_view unit) {
  if (unit == "deg/s^2") {
    return kDegree;
  }
  if (unit == "rad/s^2") {
    return 1.0;
  }
  return fail(ErrorCode::UnknownUnit,
              "The unit '" + std::string(unit) + "' does not measure an angular acceleration; use deg/s^2 or rad/s^2.",
              {{"unit", std::string(unit)}});
}

Result<double> angular_rate_factor(std::string_view symbol) {
  auto unit = parse_unit(symbol);
  if (!unit) {
    return fail(unit.error());
  }
  if (unit->dimension != Dimension::AngularRate) {
    return fail(ErrorCode::UnitMismatch,
                "The unit '" + std::string(symbol) + "' does not measure an angular rate; use deg/s, rad/s or deg/h.",
                {{"unit", std::string(symbol)}});
  }
  if (unit->offset != 0.0) {
    return fail(ErrorCode::UnitMismatch,
                "The unit '" + std::string(symbol) + "' has an offset, which a condition does not take; use deg/s.",
                {{"unit", std::string(symbol)}});
  }
  return unit->factor;
}

Result<double> condition_unit_factor(ConditionKind kind, std::string_view unit) {
  return kind == ConditionKind::ConstantRate ? angular_rate_factor(unit) : angular_acceleration_factor(unit);
}

bool has_value(ConditionKind kind) {
  return kind == ConditionKind::ConstantRate || kind == ConditionKind::ConstantAngularAcceleration;
}

tl::unexpected<Error> misfit(ConditionKind kind, const std::string& what, const std::string& parameter) {
  return fail(ErrorCode::InvalidArgument, "A condition of kind '" + std::string(name_of(kind)) + "' " + what + ".",
              {{"parameter", parameter}});
}

}  // namespace

std::string_view name_of(ConditionKind kind) {
  switch (kind) {
    case ConditionKind::Static:
      return "static";
    case ConditionKind::ConstantRate:
      return "constant_rate";
    case ConditionKind::ConstantAngularAcceleration:
      return "constant_angular_acceleration";
    case ConditionKind::Profile:
      return "profile";
    case ConditionKind::SixPosition:
      return "six_position";
    case ConditionKind::Drive:
      return "drive";
  }
  return "static";
}

Result<ConditionKind> parse_condition_kind(std::string_view name) {
  std::string known;
  for (const ConditionKind kind : kKinds) {
    if (name_of(kind) == name) {
      return kind;
    }
    known += known.empty() ? "" : ", ";
    known += name_of(kind);
  }
  return fail(ErrorCode::UnknownCondition,
              "The condition '" + std::string(name) + "' is not known; known conditions are " + known + ".",
              {{"condition", std::string(name)}});
}

Result<Condition> make_condition(const WrittenCondition& written) {
  auto kind = parse_condition_kind(written.kind);
  if (!kind) {
    return fail(kind.error());
  }
  Condition condition;
  condition.kind = *kind;
  const bool wants_axis = has_value(*kind) || *kind == ConditionKind::SixPosition;
  if (wants_axis != written.axis.has_value()) {
    return misfit(*kind, wants_axis ? "needs an axis (x, y or z)" : "takes no axis", "axis");
  }
  if (written.axis) {
    if (*written.axis != "x" && *written.axis != "y" && *written.axis != "z") {
      return misfit(*kind, "needs an axis x, y or z, not '" + *written.axis + "'", "axis");
    }
    condition.axis = *written.axis;
  }
  if (has_value(*kind) != written.value.has_value()) {
    return misfit(*kind, has_value(*kind) ? "needs a value" : "takes no value", "value");
  }
  if (has_value(*kind) != written.unit.has_value()) {
    return misfit(*kind, has_value(*kind) ? "needs a unit for its value" : "takes no unit", "unit");
  }
  if (written.value && written.unit) {
    if (!std::isfinite(*written.value)) {
      return misfit(*kind, "needs a finite value", "value");
    }
    auto factor = condition_unit_factor(*kind, *written.unit);
    if (!factor) {
      return fail(factor.error());
    }
    condition.unit = *written.unit;
    condition.value = *written.value * *factor;
  }
  if ((*kind == ConditionKind::SixPosition) != written.direction.has_value()) {
    return misfit(*kind, *kind == ConditionKind::SixPosition ? "needs a direction (up or down)" : "takes no direction",
                  "direction");
  }
  if (written.direction) {
    if (*written.direction != "up" && *written.direction != "down") {
      return misfit(*kind, "needs a direction up or down, not '" + *written.direction + "'", "direction");
    }
    condition.up = *written.direction == "up";
  }
  if (written.heading_deg) {
    if (*kind != ConditionKind::Static) {
      return misfit(*kind, "takes no heading", "heading_deg");
    }
    if (!(*written.heading_deg >= -360.0 && *written.heading_deg <= 360.0)) {
      return misfit(*kind, "needs a heading from -360 to 360 degrees", "heading_deg");
    }
    const double turned = std::fmod(*written.heading_deg + 360.0, 360.0);
    condition.heading_deg = turned;
  }
  return condition;
}

Result<Condition> parse_condition(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, ':');
  WrittenCondition written;
  written.kind = parts[0];
  auto kind = parse_condition_kind(written.kind);
  if (!kind) {
    return fail(kind.error());
  }
  const std::size_t most = has_value(*kind)                      ? 4
                           : *kind == ConditionKind::SixPosition ? 3
                           : *kind == ConditionKind::Static      ? 2
                                                                 : 1;
  if (parts.size() > most) {
    return misfit(*kind, "has too many parts: '" + std::string(text) + "'", "condition");
  }
  if (*kind == ConditionKind::Static) {
    if (parts.size() > 1) {
      written.heading_deg = parse_double(parts[1]);
      if (!written.heading_deg) {
        return misfit(*kind,
                      "takes no axis; a number behind it is a heading in degrees, not '" + std::string(parts[1]) + "'",
                      "condition");
      }
    }
    return make_condition(written);
  }
  if (parts.size() > 1) {
    written.axis = parts[1];
  }
  if (*kind == ConditionKind::SixPosition) {
    if (parts.size() > 2) {
      written.direction = parts[2];
    }
    return make_condition(written);
  }
  if (parts.size() > 2) {
    written.value = parse_double(parts[2]);
    if (!written.value) {
      return misfit(*kind, "needs a number as value, not '" + std::string(parts[2]) + "'", "value");
    }
  }
  if (parts.size() > 3) {
    written.unit = parts[3];
  }
  return make_condition(written);
}

std::optional<double> written_value(const Condition& condition) {
  if (!condition.value) {
    return std::nullopt;
  }
  const auto factor = condition_unit_factor(condition.kind, condition.unit);
  if (!factor) {
    return std::nullopt;
  }
  // Conversion to SI and back may cost the last bit; fifteen digits give back what the user wrote.
  char buffer[32];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, *condition.value / *factor, std::chars_format::general, 15);
  return parse_double({buffer, end.ptr});
}

std::string to_text(const Condition& condition) {
  std::string text(name_of(condition.kind));
  if (!condition.axis.empty()) {
    text += ":" + condition.axis;
  }
  if (const auto value = written_value(condition)) {
    text += ":" + to_text(*value) + ":" + condition.unit;
  }
  if (condition.up) {
    text += *condition.up ? ":up" : ":down";
  }
  if (condition.heading_deg) {
    text += ":" + to_text(*condition.heading_deg);
  }
  return text;
}

std::string label(const Condition& condition) {
  if (const auto value = written_value(condition)) {
    return to_text(*value) + " " + condition.unit + " about " + condition.axis;
  }
  if (condition.up) {
    return condition.axis + (*condition.up ? " up" : " down");
  }
  const std::string name(name_of(condition.kind));
  return condition.heading_deg ? name + ", heading " + to_text(*condition.heading_deg) + " deg" : name;
}

Condition without_heading(Condition condition) {
  condition.heading_deg.reset();
  return condition;
}

}  // namespace driftlab
