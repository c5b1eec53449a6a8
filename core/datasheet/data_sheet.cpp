#include "core/datasheet/data_sheet.hpp"

#include "core/signal/unit.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numbers>

namespace driftlab {
namespace {

constexpr double kSecondsPerHour = 3600.0;
constexpr double kRootHour = 60.0;  ///< sqrt(s) in one sqrt(h)

/// A text without what people put between letters, and where something stood before a letter.
struct Folded {
  std::string letters;
  std::vector<bool> begins;  ///< one per letter, and one for the end
};

Folded fold(std::string_view text) {
  Folded folded;
  bool apart = true;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (std::isalnum(u) == 0) {
      apart = true;
      continue;
    }
    folded.letters += static_cast<char>(std::toupper(u));
    folded.begins.push_back(apart);
    apart = false;
  }
  folded.begins.push_back(true);
  return folded;
}

/// Order codes that manufacturers put behind a name: reel, package, temperature range.
constexpr std::array kOrderCodes{"TR",    "T",     "ETR", "BMLZ", "AMLZ", "MLZ", "CMLZ",
                                 "BMLZP", "AMLZP", "P",   "A",    "USTR", "V"};

/// Whether what follows a name at `end` leaves it that name.
bool ends_well(const Folded& text, std::size_t end, bool any_code) {
  if (any_code || text.begins[end]) {
    return true;
  }
  std::size_t next = end;
  while (!text.begins[next]) {
    ++next;
  }
  const std::string code = text.letters.substr(end, next - end);
  return std::find(kOrderCodes.begin(), kOrderCodes.end(), code) != kOrderCodes.end();
}

struct Match {
  std::size_t first = 0;
  std::size_t length = 0;
  const DataSheet* sheet = nullptr;
};

void find_all(const Folded& text, std::string_view spelling, const DataSheet* sheet, std::vector<Match>& found) {
  const bool any_code = spelling.ends_with('*');
  const std::string name = fold(spelling).letters;
  for (std::size_t at = text.letters.find(name); at != std::string::npos; at = text.letters.find(name, at + 1)) {
    if (text.begins[at] && ends_well(text, at + name.size(), any_code)) {
      found.push_back({at, name.size(), sheet});
    }
  }
}

bool overlap(const Match& a, const Match& b) { return a.first < b.first + b.length && b.first < a.first + a.length; }

/// The letters of a text without the words in which its maker is named: `Xsens MTi` is MTI beside a sheet of Xsens.
std::string letters_beside(std::string_view text, std::string_view manufacturer) {
  const Folded folded = fold(text);
  const std::string maker = fold(manufacturer).letters;
  std::string left;
  for (std::size_t first = 0; first < folded.letters.size();) {
    std::size_t end = first + 1;
    while (!folded.begins[end]) {
      ++end;
    }
    const std::string word = folded.letters.substr(first, end - first);
    left += word.size() > 2 && maker.find(word) != std::string::npos ? "" : word;
    first = end;
  }
  return left;
}

constexpr std::size_t kFewestLetters = 3;  ///< of which a longer name can be told: `MTi`

/// The names, as their manufacturers write them, that begin with a text that is none of them.
std::vector<std::string_view> names_that_begin_with(std::string_view text) {
  std::vector<std::string_view> names;
  for (const DataSheet* const sheet : data_sheets()) {
    const std::string begun = letters_beside(text, sheet->manufacturer);
    if (begun.size() < kFewestLetters) {
      continue;
    }
    if (fold(sheet->name).letters.starts_with(begun)) {
      names.push_back(sheet->name);
      continue;
    }
    for (const std::string_view spelling : sheet->also) {
      if (!spelling.ends_with('*') && fold(spelling).letters.starts_with(begun)) {
        names.push_back(spelling);
      }
    }
  }
  return names;
}

std::string listed(const std::vector<std::string_view>& names) {
  std::string text;
  for (const std::string_view name : names) {
    text.append(text.empty() ? "" : ", ").append(name);
  }
  return text;
}

std::string refusal(std::string_view name, const std::vector<const DataSheet*>& named) {
  const std::string quoted = "'" + std::string(name) + "'";
  std::vector<std::string_view> names;
  for (const DataSheet* const sheet : named.empty() ? data_sheets() : named) {
    names.push_back(sheet->name);
  }
  if (!named.empty()) {
    return quoted + " names several sensors: " + listed(names) + ". Name one of them.";
  }
  if (const auto longer = names_that_begin_with(name); !longer.empty()) {
    return quoted + " is not the whole name of a sensor. Known names that begin so: " + listed(longer) +
           ". Write one of them whole.";
  }
  return "There is no data sheet of " + quoted + ". Known are " + listed(names) + ".";
}

double si(double value, std::string_view unit) {
  const auto known = parse_unit(unit);
  return known ? value * known->factor : value;
}

}  // namespace

const SensorSheet* DataSheet::find(Quantity quantity) const {
  const auto found = std::find_if(sensors.begin(), sensors.end(),
                                  [&](const SensorSheet& sensor) { return sensor.quantity == quantity; });
  return found == sensors.end() ? nullptr : &*found;
}

std::string DataSheet::source() const {
  const std::string text = std::string(manufacturer) + " " + std::string(document);
  return revision.empty() ? text : text + ", revision " + std::string(revision);
}

std::vector<const DataSheet*> sheets_named_in(std::string_view text) {
  const Folded folded = fold(text);
  std::vector<Match> found;
  for (const DataSheet* const sheet : data_sheets()) {
    find_all(folded, sheet->name, sheet, found);
    for (const std::string_view spelling : sheet->also) {
      find_all(folded, spelling, sheet, found);
    }
  }
  std::vector<const DataSheet*> named;
  for (const DataSheet* const sheet : data_sheets()) {
    const bool stands = std::any_of(found.begin(), found.end(), [&](const Match& match) {
      return match.sheet == sheet && std::none_of(found.begin(), found.end(), [&](const Match& other) {
               return other.sheet != sheet && other.length > match.length && overlap(match, other);
             });
    });
    if (stands) {
      named.push_back(sheet);
    }
  }
  return named;
}

Result<const DataSheet*> find_data_sheet(std::string_view name) {
  const std::vector<const DataSheet*> named = sheets_named_in(name);
  if (named.size() == 1) {
    return named.front();
  }
  return fail(ErrorCode::NotFound, refusal(name, named), {{"parameter", "model"}});
}

std::optional<KnownSensor> known_sensor(std::span<const std::string> texts, Quantity quantity) {
  for (const std::string& text : texts) {
    std::vector<KnownSensor> found;
    for (const DataSheet* const sheet : sheets_named_in(text)) {
      if (const SensorSheet* const sensor = sheet->find(quantity)) {
        found.push_back({sheet, sensor});
      }
    }
    if (found.size() == 1) {
      return found.front();
    }
    if (found.size() > 1) {
      return std::nullopt;
    }
  }
  return std::nullopt;
}

std::optional<double> stated_density_si(const SensorSheet& sensor, std::string_view axis) {
  if (sensor.random_walk) {
    const std::string_view integral = sensor.quantity == Quantity::AngularRate ? "deg" : "m";
    return si(*sensor.random_walk, integral) / kRootHour;
  }
  const auto& density = axis == "z" && sensor.noise_density_z ? sensor.noise_density_z : sensor.noise_density;
  return density ? std::optional(si(*density, sensor.unit) / std::numbers::sqrt2) : std::nullopt;
}

std::optional<double> stated_bias_stability_si(const SensorSheet& sensor) {
  if (!sensor.bias_stability) {
    return std::nullopt;
  }
  return sensor.quantity == Quantity::AngularRate ? si(*sensor.bias_stability, "deg") / kSecondsPerHour
                                                  : *sensor.bias_stability * 1e-6 * kStandardGravity;
}

}  // namespace driftlab
