#include "core/navigate/drive/drive.hpp"
#include "core/signal/angle.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab::drive {
namespace {

constexpr double kCourseSpeed = 0.5;       ///< [m/s]: below it there is no course
constexpr double kFarAway = 200e3;         ///< [m]: a fix this far from the middle of the drive is none
constexpr double kUnknownVertical = 10.0;  ///< [m/s]: standard deviation of a vertical velocity that nobody measured

constexpr std::size_t kEnoughToVary = 10;  ///< numbers: a column with more that are all the same says nothing

// Of a file that repeats each fix until the next. Chosen, not measured.
constexpr double kMovingOn = 1.0;        ///< [m/s] between two fixes: the vehicle has moved
constexpr double kNextFix = 3.0;         ///< [s]: rows farther apart are not compared
constexpr std::size_t kRowsToTell = 50;  ///< while it moves

using Column = std::optional<std::vector<double>>;

struct FixColumns {
  Column lat, lon, height, x, y, z;
  Column north, east, down, up, speed, course;
  Column sd_north, sd_east, sd_down, sd_horizontal, sd_vertical, sd_speed;
  Column type;
};

Result<FixColumns> columns_of_fixes(const GnssSource& source, const Table& table) {
  FixColumns columns;
  struct Wanted {
    Column* into;
    Quantity quantity;
    std::string_view axis;
  };
  const Wanted wanted[] = {
      {&columns.lat, Quantity::GnssPosition, "lat"},
      {&columns.lon, Quantity::GnssPosition, "lon"},
      {&columns.height, Quantity::GnssPosition, "height"},
      {&columns.x, Quantity::GnssPosition, "x"},
      {&columns.y, Quantity::GnssPosition, "y"},
      {&columns.z, Quantity::GnssPosition, "z"},
      {&columns.north, Quantity::GnssVelocity, "north"},
      {&columns.east, Quantity::GnssVelocity, "east"},
      {&columns.down, Quantity::GnssVelocity, "down"},
      {&columns.up, Quantity::GnssVelocity, "up"},
      {&columns.speed, Quantity::GnssSpeed, ""},
      {&columns.course, Quantity::GnssCourse, ""},
      {&columns.sd_north, Quantity::GnssAccuracy, "north"},
      {&columns.sd_east, Quantity::GnssAccuracy, "east"},
      {&columns.sd_down, Quantity::GnssAccuracy, "down"},
      {&columns.sd_horizontal, Quantity::GnssAccuracy, "horizontal"},
      {&columns.sd_vertical, Quantity::GnssAccuracy, "vertical"},
      {&columns.sd_speed, Quantity::GnssAccuracy, "speed"},
      {&columns.type, Quantity::FixType, ""},
  };
  for (const Wanted& one : wanted) {
    auto found = find_quantity(table, source.source, one.quantity, one.axis);
    if (!found) {
      return fail(found.error());
    }
    *one.into = std::move(*found);
  }
  if (!source.fix_types.empty() && !columns.type) {
    return fail(ErrorCode::InvalidArgument,
                "Only fixes of stated types are to be used (fix_types), but no column says the fix_type of a fix.",
                {{"parameter", "gnss.fix_types"}});
  }
  const bool geodetic = columns.lat && columns.lon;
  const bool cartesian = columns.x && columns.y && columns.z;
  if (!geodetic && !cartesian) {
    return fail(ErrorCode::InvalidArgument,
                "The fixes need gnss_position along lat and lon, or along x, y and z of the Earth-fixed frame.",
                {{"parameter", "gnss.columns"}});
  }
  return columns;
}

/// The number that the column has in every row that has a time and a number; nothing where it varies.
std::optional<double> constant_of(const Column& column, const StampedRows& stamped) {
  std::optional<double> first;
  std::size_t numbers = 0;
  for (std::size_t k = 0; column && k < stamped.row.size(); ++k) {
    const double value = (*column)[stamped.row[k]];
    if (!std::isfinite(value)) {
      continue;
    }
    if (first && value != *first) {
      return std::nullopt;
    }
    first = value;
    ++numbers;
  }
  return numbers > kEnoughToVary ? first : std::nullopt;
}

/// Latitude, longitude and height, which is 0 where the row has none; or x, y and z.
std::array<double, 3> position_at(const FixColumns& c, std::size_t row) {
  const auto at = [row](const Column& column) { return column ? (*column)[row] : 0.0; };
  const double height = std::isfinite(at(c.height)) ? at(c.height) : 0.0;
  return c.lat ? std::array{at(c.lat), at(c.lon), height} : std::array{at(c.x), at(c.y), at(c.z)};
}

/// Whether two rows hold one fix: receivers state the height at another moment than the place.
bool same_place(const FixColumns& c, const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return a[0] == b[0] && a[1] == b[1] && (c.lat || a[2] == b[2]);
}

Vector3 place_of(const FixColumns& c, const std::array<double, 3>& numbers) {
  return c.lat ? to_ecef({numbers[0], numbers[1], numbers[2]}) : Vector3(numbers[0], numbers[1], numbers[2]);
}

bool holds_no_position(const std::array<double, 3>& numbers) {
  return !std::isfinite(numbers[0]) || !std::isfinite(numbers[1]) || (numbers[0] == 0.0 && numbers[1] == 0.0);
}

/// Whether the file repeats each fix until the next one, as a table at the rate of the unit does, though the document
/// does not say so: while the vehicle moves, at least every second row repeats position and velocity of the row before.
/// A receiver at rest may give the same numbers again and again, and one with few digits the same position.
bool repeats_until_the_next(const FixColumns& c, const StampedRows& stamped) {
  const auto same = [&](std::size_t a, std::size_t b) {
    const auto equal = [&](const Column& column) { return !column || (*column)[a] == (*column)[b]; };
    return same_place(c, position_at(c, a), position_at(c, b)) && equal(c.north) && equal(c.east) && equal(c.speed) &&
           equal(c.course);
  };
  std::size_t rows = 0;
  std::size_t repeats = 0;
  std::size_t last = 0;  // row at which the fix was new
  for (std::size_t k = 1; k < stamped.row.size(); ++k) {
    if (same(stamped.row[k], stamped.row[k - 1])) {
      continue;
    }
    const auto before = position_at(c, stamped.row[last]);
    const auto now = position_at(c, stamped.row[k]);
    const double step = stamped.time_s[k] - stamped.time_s[last];
    if (!holds_no_position(before) && !holds_no_position(now) && step < kNextFix &&
        (place_of(c, now) - place_of(c, before)).norm() > kMovingOn * step) {
      rows += k - last;
      repeats += k - last - 1;
    }
    last = k;
  }
  return rows > kRowsToTell && 2 * repeats >= rows;
}

bool is_accuracy(double stated) { return std::isfinite(stated) && stated > 0.0; }

double sd_at(const Column& column, std::size_t row, double otherwise) {
  return column && is_accuracy((*column)[row]) ? (*column)[row] : otherwise;
}

/// A stated accuracy that is no number above 0: the document's stands in its place.
bool lacks_accuracy(const FixColumns& c, std::size_t row) {
  const auto lacks = [&](const Column& stated) { return stated && !is_accuracy((*stated)[row]); };
  return lacks(c.sd_north) || lacks(c.sd_east) || lacks(c.sd_down) || lacks(c.sd_horizontal) || lacks(c.sd_vertical) ||
         lacks(c.sd_speed);
}

void set_velocity(const FixColumns& c, std::size_t i, const GnssSource& source, bool believe, Fix& fix) {
  fix.velocity_sd_m_s = source.velocity_sd_m_s;
  if (c.north && c.east) {
    const bool vertical = c.down || c.up;
    const double down = c.down ? (*c.down)[i] : c.up ? -(*c.up)[i] : 0.0;
    fix.velocity_ned_m_s = Vector3((*c.north)[i], (*c.east)[i], down);
    if (!vertical) {
      fix.velocity_sd_m_s.z() = kUnknownVertical;
    }
    fix.has_course = std::hypot((*c.north)[i], (*c.east)[i]) >= kCourseSpeed;
  } else if (c.speed && c.course) {
    const double speed = (*c.speed)[i];
    const double course = (*c.course)[i];
    fix.has_course = speed >= kCourseSpeed && std::isfinite(course);
    if (fix.has_course) {
      fix.velocity_ned_m_s = Vector3(speed * std::cos(course), speed * std::sin(course), 0.0);
    } else if (std::isfinite(speed) && speed < kCourseSpeed) {
      fix.velocity_ned_m_s = Vector3::Zero();  // within its speed, whatever the direction
      fix.velocity_sd_m_s.head<2>().setConstant(std::max(kCourseSpeed, source.velocity_sd_m_s.x()));
    }
    fix.velocity_sd_m_s.z() = kUnknownVertical;
  }
  if (fix.velocity_ned_m_s && !fix.velocity_ned_m_s->allFinite()) {
    fix.velocity_ned_m_s.reset();
    fix.has_course = false;
  }
  if (believe && c.sd_speed && fix.velocity_ned_m_s) {
    const double sd = sd_at(c.sd_speed, i, source.velocity_sd_m_s.x());
    fix.velocity_sd_m_s.head<2>().setConstant(std::max(sd, 1e-3));
    if (fix.velocity_sd_m_s.z() < kUnknownVertical) {
      fix.velocity_sd_m_s.z() = std::max(sd, 1e-3);
    }
  }
}

}  // namespace

Result<std::vector<Fix>> fixes_of(const GnssSource& source, const Table& table, const StampedRows& stamped,
                                  FileFacts& facts) {
  auto columns = columns_of_fixes(source, table);
  if (!columns) {
    return fail(columns.error());
  }
  const FixColumns& c = *columns;
  const auto is_constant = [&](const Column& column) { return constant_of(column, stamped).has_value(); };
  facts.accuracy_constant = is_constant(c.sd_horizontal) || is_constant(c.sd_north) || is_constant(c.sd_east);
  facts.speed_accuracy_constant = is_constant(c.sd_speed);
  facts.vertical_accuracy_constant = is_constant(c.sd_vertical) || is_constant(c.sd_down);
  facts.height_zero = constant_of(c.height, stamped) == 0.0;
  facts.course_constant = is_constant(c.course);
  if (facts.course_constant) {
    columns->course.reset();
  }
  const bool hold = source.hold || repeats_until_the_next(c, stamped);
  std::vector<Fix> fixes;
  std::array<double, 3> before{};
  double before_s = 0.0;
  for (std::size_t k = 0; k < stamped.row.size(); ++k) {
    const std::size_t i = stamped.row[k];
    const std::array<double, 3> numbers = position_at(c, i);
    if (holds_no_position(numbers)) {
      ++facts.incomplete;
      continue;
    }
    const bool again = !fixes.empty() && stamped.time_s[k] <= before_s;
    if (!fixes.empty() && (again || (hold && same_place(c, numbers, before)))) {
      ++facts.held;
      continue;
    }
    if (c.type && !source.fix_types.empty()) {
      const double type = (*c.type)[i];
      const bool wanted = std::any_of(source.fix_types.begin(), source.fix_types.end(),
                                      [&](int good) { return type == static_cast<double>(good); });
      if (!wanted) {
        ++facts.other_types;
        facts.without_type += std::isfinite(type) ? 0 : 1;
        continue;
      }
    }
    before = numbers;
    before_s = stamped.time_s[k];
    Fix fix;
    fix.time_s = stamped.time_s[k];
    if (c.lat && (std::abs(numbers[0]) > 0.5 * std::numbers::pi || std::abs(numbers[1]) > 2.0 * std::numbers::pi)) {
      return fail(ErrorCode::InvalidArgument,
                  "A latitude lies beyond 90 deg or a longitude beyond 360: latitude and longitude are swapped, or "
                  "their unit is not the stated one.",
                  {{"parameter", "gnss.columns"}});
    }
    fix.position_ecef_m = place_of(c, numbers);
    fix.position_sd_m = source.position_sd_m;
    if (!facts.accuracy_constant) {
      if (c.sd_north && c.sd_east) {
        fix.position_sd_m.x() = sd_at(c.sd_north, i, source.position_sd_m.x());
        fix.position_sd_m.y() = sd_at(c.sd_east, i, source.position_sd_m.y());
        if (!facts.vertical_accuracy_constant) {
          fix.position_sd_m.z() = sd_at(c.sd_down, i, source.position_sd_m.z());
        }
      } else if (c.sd_horizontal) {  // of both coordinates together, as phones state it
        const double sd = sd_at(c.sd_horizontal, i, source.position_sd_m.x());
        fix.position_sd_m = {sd, sd, 2.0 * sd};
      }
    }
    if (c.sd_vertical && !facts.vertical_accuracy_constant) {
      fix.position_sd_m.z() = sd_at(c.sd_vertical, i, fix.position_sd_m.z());
    }
    fix.position_sd_m = fix.position_sd_m.cwiseMax(1e-3);
    facts.without_accuracy += lacks_accuracy(c, i) ? 1 : 0;
    if (source.geoid || facts.height_zero || !(c.height || c.z)) {
      fix.position_sd_m.z() = std::max(fix.position_sd_m.z(), 10.0);  // the height is nobody's
    }
    set_velocity(c, i, source, !facts.speed_accuracy_constant, fix);
    fixes.push_back(fix);
  }
  if (fixes.size() < 4) {
    return fail(ErrorCode::TooFewSamples,
                "Fewer than 4 fixes can be used; are fix_types and the columns of the position right?");
  }
  std::array<std::vector<double>, 3> coordinates;
  for (const Fix& fix : fixes) {
    for (std::size_t k = 0; k < 3; ++k) {
      coordinates[k].push_back(fix.position_ecef_m(static_cast<Eigen::Index>(k)));
    }
  }
  Vector3 middle;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = coordinates[k].begin() + static_cast<std::ptrdiff_t>(coordinates[k].size() / 2);
    std::nth_element(coordinates[k].begin(), at, coordinates[k].end());
    middle(static_cast<Eigen::Index>(k)) = *at;
  }
  const std::size_t all = fixes.size();
  std::erase_if(fixes, [&](const Fix& fix) { return (fix.position_ecef_m - middle).norm() > kFarAway; });
  facts.far_away = all - fixes.size();
  if (hold && facts.far_away > 0 && fixes.size() > 1) {
    fixes.erase(fixes.begin());  // it may be as old as the file
  }
  return fixes;
}

}  // namespace driftlab::drive
