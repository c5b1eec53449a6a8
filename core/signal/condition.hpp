#pragma once
/// The dynamic condition under which a recording was made (spec/study.md). It defines the true value of the measured
/// quantity.
#include "core/signal/result.hpp"
#include "core/signal/unit.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace driftlab {

enum class ConditionKind {
  Static,                       ///< at rest; the rotation reference is 0
  ConstantRate,                 ///< `value` [rad/s] about `axis`
  ConstantAngularAcceleration,  ///< `value` [rad/s^2] about `axis`, from rest at the first sample of the file
  Profile,                      ///< any motion, with a reference column
  SixPosition,                  ///< `axis` up or down; the specific-force reference is +-g
  Drive,                        ///< free motion
};

/// A condition as a value. `value` is SI (rad/s or rad/s^2); `unit` remembers how the user wrote it.
struct Condition {
  ConditionKind kind = ConditionKind::Static;
  std::string axis;             ///< "x", "y", "z"; empty where the kind has none
  std::optional<double> value;  ///< SI; only for the two constant kinds
  std::string unit;             ///< deg/s, rad/s, deg/h, deg/s^2, rad/s^2; empty where the kind has no value
  std::optional<bool> up;       ///< six_position only
  /// Of a recording at rest that states it: where the sensor points, clockwise from any fixed direction [deg], 0 to
  /// 360.
  std::optional<double> heading_deg = {};

  friend bool operator==(const Condition&, const Condition&) = default;
};

[[nodiscard]] std::string_view name_of(ConditionKind kind);

/// Error: UnknownCondition, naming what was written and what is known.
[[nodiscard]] Result<ConditionKind> parse_condition_kind(std::string_view name);

/// Checks a condition assembled from its written parts and converts its value to SI.
/// Errors: UnknownCondition, UnknownUnit, UnitMismatch, InvalidArgument (a member missing or superfluous for the kind).
struct WrittenCondition {
  std::string kind;
  std::optional<std::string> axis;
  std::optional<double> value;
  std::optional<std::string> unit;
  std::optional<std::string> direction;
  std::optional<double> heading_deg = {};
};
[[nodiscard]] Result<Condition> make_condition(const WrittenCondition& written);

/// The compact one-word form used in query strings and on the command line: `static`, `static:90` (at a heading),
/// `constant_rate:z:9:deg/s`, `constant_angular_acceleration:z:1:deg/s^2`, `profile`, `six_position:x:up`, `drive`.
[[nodiscard]] Result<Condition> parse_condition(std::string_view text);

/// The compact form of a condition; parse_condition(text) gives it back.
[[nodiscard]] std::string to_text(const Condition& condition);

/// A short label for people: "static", "static, heading 90 deg", "9 deg/s about z", "1 deg/s^2 about z", "x up".
[[nodiscard]] std::string label(const Condition& condition);

/// The condition of a table's row: recordings at rest at several headings are replicates of one condition.
[[nodiscard]] Condition without_heading(Condition condition);

/// The value in the unit the user wrote; empty where the kind has none.
[[nodiscard]] std::optional<double> written_value(const Condition& condition);

}  // namespace driftlab
