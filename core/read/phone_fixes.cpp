#include "core/read/phone_fixes.hpp"

#include "core/signal/infer_role.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <string>

namespace driftlab {
namespace {

/// A column of a receiver, by what the applications call it.
struct FixColumn {
  std::string_view word;  ///< in small letters, without blanks and what follows them in brackets
  std::string_view name;
  bool negative_is_none;
};

/// Of those with one name the first is taken.
constexpr std::array kFixColumns{FixColumn{"latitude", "gnss_latitude (deg)", false},
                                 FixColumn{"longitude", "gnss_longitude (deg)", false},
                                 FixColumn{"altitudewgs84", "gnss_height (m)", false},
                                 FixColumn{"altitudeabovemeansealevel", "gnss_altitude (m)", false},
                                 FixColumn{"height", "gnss_altitude (m)", false},
                                 FixColumn{"speed", "gnss_speed (m/s)", true},
                                 FixColumn{"velocity", "gnss_speed (m/s)", true},
                                 FixColumn{"bearing", "gnss_course (deg)", true},
                                 FixColumn{"direction", "gnss_course (deg)", true},
                                 FixColumn{"horizontalaccuracy", "gnss_sd_horizontal (m)", true},
                                 FixColumn{"verticalaccuracy", "gnss_sd_vertical (m)", true},
                                 FixColumn{"speedaccuracy", "gnss_sd_speed (m/s)", true},
                                 FixColumn{"satellites", "gnss_satellites", true}};

/// Both applications have an `altitude`: above the ellipsoid where the names are those of Sensor Logger.
constexpr std::string_view kAltitude = "altitude";

std::string word_of(std::string_view header) {
  std::string word;
  for (const char c : header.substr(0, header.find('('))) {
    if (c != ' ') {
      word += lower_case(c);
    }
  }
  return word;
}

bool is_time(const std::string& header) {
  const ColumnRole role = infer_role(header);
  return role.quantity == Quantity::Time && role.unit && role.unit->dimension == Dimension::Time;
}

std::vector<double> without_negative(const std::vector<double>& values) {
  std::vector<double> kept = values;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i] < 0.0) {
      kept[i] = missing_sample(Missing::Empty, i + 1);
    }
  }
  return kept;
}

}  // namespace

int holds_fixes(std::string_view stem) { return stem == "locationgps" ? 2 : stem == "location" ? 1 : 0; }

std::optional<PhoneFixes> read_fixes(const MemoryTable& table) {
  const auto time = std::find_if(table.names.begin(), table.names.end(), is_time);
  if (time == table.names.end()) {
    return std::nullopt;
  }
  std::vector<std::string> words(table.names.size());
  std::transform(table.names.begin(), table.names.end(), words.begin(), word_of);
  const auto find = [&](std::string_view word) -> const std::vector<double>* {
    const auto found = std::find(words.begin(), words.end(), word);
    return found == words.end() ? nullptr : &table.columns[static_cast<std::size_t>(found - words.begin())];
  };
  PhoneFixes fixes{{"gnss_time (s)"}, {table.columns[static_cast<std::size_t>(time - table.names.begin())]}};
  const auto take = [&](std::string_view name, const std::vector<double>* values, bool negative_is_none) {
    if (values != nullptr && std::find(fixes.names.begin(), fixes.names.end(), name) == fixes.names.end()) {
      fixes.names.emplace_back(name);
      fixes.columns.push_back(negative_is_none ? without_negative(*values) : *values);
    }
  };
  for (const FixColumn& column : kFixColumns) {
    take(column.name, find(column.word), column.negative_is_none);
  }
  take(find("bearing") != nullptr ? "gnss_height (m)" : "gnss_altitude (m)", find(kAltitude), false);
  if (find("latitude") == nullptr || find("longitude") == nullptr) {
    return std::nullopt;
  }
  if (const auto* const accuracy = find("horizontalaccuracy"); accuracy != nullptr) {
    for (std::size_t i = 0; i < accuracy->size(); ++i) {
      if ((*accuracy)[i] < 0.0) {
        fixes.columns[1][i] = fixes.columns[2][i] = missing_sample(Missing::Empty, i + 1);
      }
    }
  }
  return fixes;
}

}  // namespace driftlab
