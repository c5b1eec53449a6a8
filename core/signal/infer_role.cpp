#include "core/signal/infer_role.hpp"

#include "core/signal/column_unit.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <set>
#include <string>
#include <utility>

namespace driftlab {
namespace {

struct Stem {
  std::string_view text;
  Quantity quantity;
};

constexpr std::array kStems{
    Stem{"g", Quantity::AngularRate},
    Stem{"gyr", Quantity::AngularRate},
    Stem{"gyro", Quantity::AngularRate},
    Stem{"gyroscope", Quantity::AngularRate},
    Stem{"w", Quantity::AngularRate},
    Stem{"omega", Quantity::AngularRate},
    Stem{"ω", Quantity::AngularRate},
    Stem{"rate", Quantity::AngularRate},
    Stem{"angularrate", Quantity::AngularRate},
    Stem{"angularvelocity", Quantity::AngularRate},
    Stem{"angrate", Quantity::AngularRate},
    Stem{"drehrate", Quantity::AngularRate},
    Stem{"winkelgeschwindigkeit", Quantity::AngularRate},
    Stem{"gyrorotation", Quantity::AngularRate},
    Stem{"a", Quantity::SpecificForce},
    Stem{"acc", Quantity::SpecificForce},
    Stem{"accel", Quantity::SpecificForce},
    Stem{"accelerometer", Quantity::SpecificForce},
    Stem{"acceleration", Quantity::SpecificForce},
    Stem{"beschleunigung", Quantity::SpecificForce},
    Stem{"accelerometeracceleration", Quantity::SpecificForce},
    Stem{"f", Quantity::SpecificForce},
    Stem{"specificforce", Quantity::SpecificForce},
    Stem{"wb", Quantity::AngularRate},
    Stem{"fb", Quantity::SpecificForce},
    Stem{"m", Quantity::MagneticField},
    Stem{"mag", Quantity::MagneticField},
    Stem{"magnetometer", Quantity::MagneticField},
    Stem{"magneticfield", Quantity::MagneticField},
};

/// Words beside an axis that may be anything: the unit says what is measured, `Rotation X [°/s]`.
constexpr std::array<std::string_view, 5> kByUnit{"", "rotation", "rotationrate", "angularspeed", "turnrate"};

struct UnitWord {
  std::string_view word;
  std::string_view symbol;
};

/// Units as they are written behind an underscore, where no slash can be.
constexpr std::array kUnitWords{
    UnitWord{"s", "s"},           UnitWord{"sec", "s"},
    UnitWord{"ms", "ms"},         UnitWord{"us", "us"},
    UnitWord{"ns", "ns"},         UnitWord{"dps", "deg/s"},
    UnitWord{"degps", "deg/s"},   UnitWord{"degs", "deg/s"},
    UnitWord{"radps", "rad/s"},   UnitWord{"rads", "rad/s"},
    UnitWord{"mps2", "m/s^2"},    UnitWord{"ms2", "m/s^2"},
    UnitWord{"g", "g"},           UnitWord{"mg", "mg"},
    UnitWord{"degc", "degC"},     UnitWord{"c", "degC"},
    UnitWord{"k", "K"},           UnitWord{"ut", "uT"},
    UnitWord{"seconds", "s"},     UnitWord{"celsius", "degC"},
    UnitWord{"gs", "g"},          UnitWord{"microteslas", "uT"},
    UnitWord{"mdps", "mdeg/s"},   UnitWord{"mradps", "mrad/s"},
    UnitWord{"degph", "deg/h"},   UnitWord{"ug", "ug"},
    UnitWord{"uradps", "urad/s"}, UnitWord{"urads", "urad/s"},
};

/// The same in several words.
constexpr std::array kUnitPhrases{
    UnitWord{"_deg_per_s", "_degps"},   UnitWord{"_rad_per_s", "_radps"}, UnitWord{"_m_per_s2", "_mps2"},
    UnitWord{"_deg_s", "_degps"},       UnitWord{"_rad_s", "_radps"},     UnitWord{"_mrad_s", "_mradps"},
    UnitWord{"_m_s2", "_mps2"},         UnitWord{"_m_s^2", "_mps2"},      UnitWord{"_deg_per_sec", "_degps"},
    UnitWord{"_rad_per_sec", "_radps"}, UnitWord{"_deg_h", "_degph"},     UnitWord{"_deg_per_h", "_degph"},
    UnitWord{"_mdeg_s", "_mdps"},       UnitWord{"_urad_s", "_uradps"},   UnitWord{"_µrad_s", "_uradps"},
    UnitWord{"_μrad_s", "_uradps"},     UnitWord{"_m_s²", "_mps2"},
};

/// Words in front of a quantity that do not change it.
constexpr std::array<std::string_view, 9> kPlainWords{"raw", "imu", "imu1",       "sens",        "sensor",
                                                      "all", "cal", "calibrated", "uncalibrated"};

/// The members that make a struct one of NaveGo's.
struct StructMember {
  std::string_view name;
  Quantity quantity;
  std::string_view axis;
  std::string_view unit;
};

constexpr std::array kStructMembers{
    StructMember{".t", Quantity::Time, "", "s"},
    StructMember{".wb_x", Quantity::AngularRate, "x", "rad/s"},
    StructMember{".wb_y", Quantity::AngularRate, "y", "rad/s"},
    StructMember{".wb_z", Quantity::AngularRate, "z", "rad/s"},
    StructMember{".fb_x", Quantity::SpecificForce, "x", "m/s^2"},
    StructMember{".fb_y", Quantity::SpecificForce, "y", "m/s^2"},
    StructMember{".fb_z", Quantity::SpecificForce, "z", "m/s^2"},
};

/// What may stand in brackets without being a unit: raw numbers, and clocks behind a time.
constexpr std::array<std::string_view, 20> kNoUnits{
    "raw",  "lsb",   "lsbs", "count", "counts", "adc",      "digit",         "digits", "bit",  "bits",
    "code", "codes", "tick", "ticks", "none",   "unitless", "dimensionless", "utc",    "unix", "gps"};

constexpr std::array<std::string_view, 7> kTimeNames{"t", "ts", "time", "timestamp", "zeit", "temps", "tiempo"};

/// Clocks by names that alone may be anything: times with a unit of time behind them, `epoc (ms)`, `elapsed (s)`.
constexpr std::array<std::string_view, 4> kTimeNamesWithUnit{"elapsed", "elapsedtime", "epoch", "epoc"};

/// Whose time it is, before or behind the word: `TimestampGyro [ns]`, `imu_time (s)`, `device_timestamp_us`.
constexpr std::array<std::string_view, 18> kClocks{
    "gyro",   "gyr",    "gyroscope", "acc",    "accel", "accelerometer", "mag",   "magnetometer", "imu",
    "sensor", "sample", "device",    "system", "host",  "unix",          "epoch", "utc",          "ros"};

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  return begin == std::string_view::npos ? std::string_view{}
                                         : text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// Cuts a bracketed end off `name` and returns what was inside, further brackets too; empty if there is none.
std::string_view take_bracket(std::string_view& name) {
  name = trim(name);
  if (name.size() < 2 || (name.back() != ')' && name.back() != ']')) {
    return {};
  }
  const char closing = name.back();
  const char opening = closing == ')' ? '(' : '[';
  std::size_t open = name.size() - 1;
  for (int depth = 1; depth > 0;) {
    if (open-- == 0) {
      return {};
    }
    depth += name[open] == closing ? 1 : name[open] == opening ? -1 : 0;
  }
  const std::string_view inside = name.substr(open + 1, name.size() - open - 2);
  name = trim(name.substr(0, open));
  return trim(inside);
}

bool is_letter_or_digit(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); }

void replace_all(std::string& text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

/// Letters, digits and signs beyond ASCII, in lower case: "Gyroscope x" -> "gyroscopex". A sign such as µ or ² may
/// change what is meant, so it stays and makes another name of it; a blank that does not break a line is a blank.
std::string squash(std::string_view name) {
  std::string text = lower_case(name);
  replace_all(text, "\u00a0", " ");
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x80 && !is_letter_or_digit(c); });
  return text;
}

bool is_axis_letter(char c) { return c == 'x' || c == 'y' || c == 'z'; }

std::optional<Unit> known_unit(std::string_view symbol, Quantity quantity = Quantity::Unspecified) {
  if (symbol.empty()) {
    return std::nullopt;
  }
  auto unit = parse_unit(symbol, quantity);
  return unit ? std::optional(std::move(*unit)) : std::nullopt;
}

bool is_time_name(std::string_view squashed) {
  if (std::find(kTimeNames.begin(), kTimeNames.end(), squashed) != kTimeNames.end()) {
    return true;
  }
  return std::any_of(kClocks.begin(), kClocks.end(), [squashed](std::string_view clock) {
    const bool before = squashed.starts_with(clock);
    const std::string_view word = before                      ? squashed.substr(clock.size())
                                  : squashed.ends_with(clock) ? squashed.substr(0, squashed.size() - clock.size())
                                                              : std::string_view();
    return word == "time" || word == "timestamp" || word == "timestampsincereboot";
  });
}

/// `temp`, `temperature`, also with what is as warm in front: `gyro_temp`.
bool is_temperature_name(std::string_view squashed) {
  constexpr std::array<std::string_view, 9> kDevices{"",      "gyro",          "gyr", "gyroscope", "acc",
                                                     "accel", "accelerometer", "imu", "sensor"};
  return std::any_of(kDevices.begin(), kDevices.end(), [squashed](std::string_view device) {
    const std::string_view word = squashed.starts_with(device) ? squashed.substr(device.size()) : std::string_view();
    return word == "temp" || word == "temperature";
  });
}

Quantity quantity_of(std::string_view stem, const std::optional<Unit>& unit) {
  if (unit && std::find(kByUnit.begin(), kByUnit.end(), stem) != kByUnit.end()) {
    switch (unit->dimension) {
      case Dimension::AngularRate:
        return Quantity::AngularRate;
      case Dimension::SpecificForce:
        return Quantity::SpecificForce;
      case Dimension::MagneticField:
        return Quantity::MagneticField;
      default:
        return Quantity::Unspecified;
    }
  }
  const auto found =
      std::find_if(kStems.begin(), kStems.end(), [stem](const Stem& known) { return known.text == stem; });
  return found == kStems.end() ? Quantity::Unspecified : found->quantity;
}

/// "xaxis", "gyroxaxis" without the word behind the axis.
std::string_view without_word_axis(std::string_view squashed) {
  constexpr std::string_view kAxis = "axis";
  const std::size_t kept = squashed.size() - std::min(squashed.size(), kAxis.size());
  return squashed.ends_with(kAxis) && kept > 0 && is_axis_letter(squashed[kept - 1]) ? squashed.substr(0, kept)
                                                                                     : squashed;
}

/// The role of a name from which the unit has been cut off.
std::optional<ColumnRole> infer_bare(std::string_view name, const std::optional<Unit>& unit) {
  const std::string squashed = squash(name);
  if (is_time_name(squashed)) {
    return ColumnRole{Quantity::Time, "", unit};
  }
  if (unit && unit->dimension == Dimension::Time &&
      std::find(kTimeNamesWithUnit.begin(), kTimeNamesWithUnit.end(), squashed) != kTimeNamesWithUnit.end()) {
    return ColumnRole{Quantity::Time, "", unit};
  }
  if (squashed == "millis") {
    return ColumnRole{Quantity::Time, "", known_unit("ms")};
  }
  if (squashed == "secondselapsed") {
    return ColumnRole{Quantity::Time, "", known_unit("s")};
  }
  if (is_temperature_name(squashed)) {
    return ColumnRole{Quantity::Temperature, "", unit};
  }
  if (squashed.empty()) {
    return std::nullopt;
  }
  for (const auto& [turn, axis] : {std::pair{"roll", "x"}, std::pair{"pitch", "y"}, std::pair{"yaw", "z"}}) {
    if (squashed == std::string(turn) + "rate") {
      return ColumnRole{Quantity::AngularRate, axis, unit};
    }
  }
  const std::string_view whole = without_word_axis(squashed);
  const std::array<std::pair<char, std::string_view>, 2> splits{
      std::pair{whole.back(), whole.substr(0, whole.size() - 1)}, std::pair{whole.front(), whole.substr(1)}};
  for (const auto& [axis, stem] : splits) {
    const Quantity quantity = is_axis_letter(axis) ? quantity_of(stem, unit) : Quantity::Unspecified;
    if (quantity != Quantity::Unspecified) {
      return ColumnRole{quantity, std::string(1, axis), unit};
    }
  }
  return std::nullopt;
}

/// The unit that is the last word of a name, `dps`, `m/s²`, `µg`: one of kUnitWords, in any case, or as it is written
/// in brackets. A sign that is not understood makes it none.
std::optional<Unit> unit_of_word(std::string_view written) {
  if (auto unit = known_unit(written)) {
    return unit->dimension == Dimension::One ? std::nullopt : std::move(unit);
  }
  std::string word = lower_case(written);
  for (const auto& [sign, letter] : {std::pair{"µ", "u"}, std::pair{"μ", "u"}, std::pair{"²", "2"}}) {
    replace_all(word, sign, letter);
  }
  const bool quotient = word.find('/') != std::string::npos;
  std::erase_if(word, [](char c) { return c == '/' || c == '^'; });
  const auto known =
      std::find_if(kUnitWords.begin(), kUnitWords.end(), [&](const UnitWord& w) { return w.word == word; });
  return known == kUnitWords.end() || (quotient && known->symbol.find('/') == std::string_view::npos)
             ? std::nullopt
             : known_unit(known->symbol);
}

/// `time_ms`, `gyro_x_dps`, `fx_mps2`: the last word is a unit, if what is before it is a quantity which that measures.
std::optional<ColumnRole> infer_suffixed(std::string_view name) {
  const std::size_t cut = name.find_last_of("_ ");
  if (cut == std::string_view::npos) {
    return std::nullopt;
  }
  const std::optional<Unit> unit = unit_of_word(name.substr(cut + 1));
  auto role = unit ? infer_bare(name.substr(0, cut), unit) : std::nullopt;
  return role && measures(*unit, role->quantity) ? role : std::nullopt;
}

/// `acc_x/mg`, `t/s`, `wz/°/s`: the quantity by its unit, as DIN 1313 heads a table.
std::optional<ColumnRole> infer_quotient(std::string_view name) {
  for (std::size_t at = name.find('/'); at != std::string_view::npos; at = name.find('/', at + 1)) {
    const std::optional<Unit> unit = unit_of_word(trim(name.substr(at + 1)));
    auto role = unit ? infer_bare(name.substr(0, at), unit) : std::nullopt;
    if (role && measures(*unit, role->quantity)) {
      return role;
    }
  }
  return std::nullopt;
}

/// `name` without plain words in front: "imu_gyr_x" -> "gyr_x", "SENSgyro_x" -> "gyro_x". Itself if there are none.
std::string_view without_plain_words(std::string_view name) {
  if (name.starts_with("SENS")) {
    name.remove_prefix(4);
  }
  while (true) {
    const std::size_t cut = name.find_first_of("_. ");
    if (cut == std::string_view::npos ||
        std::find(kPlainWords.begin(), kPlainWords.end(), squash(name.substr(0, cut))) == kPlainWords.end()) {
      return name;
    }
    name.remove_prefix(cut + 1);
  }
}

/// The name with a unit of several words written as one.
std::string with_short_unit(std::string_view name) {
  std::string text(name);
  for (const UnitWord& phrase : kUnitPhrases) {
    if (lower_case(text).ends_with(phrase.word)) {
      text.replace(text.size() - phrase.word.size(), phrase.word.size(), phrase.symbol);
    }
  }
  return text;
}

/// `gyro_rad[0]`, `accelerometer_m_s2[2]` with the axis as a letter, `gyro_x_radps`, `accelerometer_z_mps2`: what PX4's
/// ulog2csv writes, whose `gyro_rad` are rad/s. Itself where there is no quantity in front: an `a[0]` may be anything.
std::string with_axis_of_index(std::string_view name) {
  constexpr std::size_t kIndex = std::string_view("[0]").size();
  if (name.size() <= kIndex || !name.ends_with(']') || name[name.size() - kIndex] != '[' ||
      name[name.size() - 2] < '0' || name[name.size() - 2] > '2') {
    return std::string(name);
  }
  const std::string axis{'_', static_cast<char>('x' + (name[name.size() - 2] - '0'))};
  const std::string array = with_short_unit(name.substr(0, name.size() - kIndex));
  const auto is_quantity = [](std::string_view text) {
    const std::string stem = squash(text);
    return stem.size() > 2 && quantity_of(stem, std::nullopt) != Quantity::Unspecified;
  };
  if (is_quantity(array)) {
    return array + axis;
  }
  const std::size_t cut = std::min(array.rfind('_'), array.size());
  if (!is_quantity(array.substr(0, cut))) {
    return std::string(name);
  }
  const std::string unit = array.substr(cut);
  return array.substr(0, cut) + axis + (lower_case(unit) == "_rad" ? "_radps" : unit);
}

/// The name as it is read. `linear_acceleration_x` is what ROS calls a specific force; phones write it in words of
/// their own, `Linear Acceleration x`, for one without gravity, which is none.
std::string as_read(std::string_view written) {
  constexpr std::string_view kLinear = "linear_";
  std::string_view name = without_plain_words(written);
  if (lower_case(name).starts_with("linear_acceleration")) {
    name.remove_prefix(kLinear.size());
  }
  return with_short_unit(with_axis_of_index(name));
}

/// `+0100`, `-05:00`, `UTC+1`, `GMT`: what phones write behind a time of day.
bool is_time_zone(std::string_view bracket) {
  const std::string text = lower_case(bracket);
  const bool named = text.starts_with("utc") || text.starts_with("gmt");
  const std::string_view shift = std::string_view(text).substr(named ? 3 : 0);
  return shift.empty() ? named
                       : (shift.front() == '+' || shift.front() == '-') && shift.size() > (named ? 1 : 4) &&
                             shift.find_first_not_of("0123456789:", 1) == std::string_view::npos;
}

bool states_no_unit(std::string_view bracket) {
  return bracket == "-" || is_time_zone(bracket) ||
         std::find(kNoUnits.begin(), kNoUnits.end(), squash(bracket)) != kNoUnits.end();
}

/// True for `T (°C)`, `T(°)`, `T [F]`: no time, where a unit of temperature or the sign of degrees stands behind it.
bool is_letter_of_temperature(std::string_view name, std::string_view bracket) {
  if (squash(name) != "t") {
    return false;
  }
  const auto unit = known_unit(bracket, Quantity::Temperature);
  return unit ? unit->dimension == Dimension::Temperature || unit->dimension == Dimension::Angle
              : squash(bracket) == "f" || bracket == "°F" || squash(bracket) == "degf";
}

/// A name as it is read, its unit in brackets apart.
struct NameParts {
  std::string name;
  std::string bracket;
};

NameParts parts_of(std::string_view written) {
  const std::string text = as_read(written);
  std::string_view name = text;
  const std::string_view bracket = take_bracket(name);
  return {is_letter_of_temperature(name, bracket) ? "temp" : std::string(name), std::string(bracket)};
}

/// A unit in brackets that is not known, behind a name that says what is measured. Of a temperature also one that
/// measures something else, as the sign of degrees alone.
struct UnknownUnit {
  Quantity quantity;
  std::string symbol;
  Error error;
};

std::optional<UnknownUnit> unknown_unit(std::string_view written) {
  const auto [name, bracket] = parts_of(written);
  const auto role = infer_bare(name, std::nullopt);
  if (bracket.empty() || states_no_unit(bracket) || !role) {
    return std::nullopt;
  }
  auto unit = parse_unit(bracket, role->quantity);
  if (unit && (role->quantity != Quantity::Temperature || measures(*unit, Quantity::Temperature))) {
    return std::nullopt;
  }
  return UnknownUnit{role->quantity, bracket, unit ? Error{} : std::move(unit).error()};
}

/// True for a name that is that of a sensor by what as_read() makes of it, or a temperature by one letter or of one
/// device: beside a column that is so by its plain name it is another thing.
bool is_second_choice(std::string_view written, Quantity quantity) {
  const std::string text = as_read(written);
  return text != with_short_unit(without_plain_words(written)) ||
         (quantity == Quantity::Temperature && !squash(text).starts_with("temp"));
}

}  // namespace

Status check_bracketed_unit(std::string_view written) {
  const auto unknown = unknown_unit(written);
  if (!unknown || unknown->quantity == Quantity::Temperature) {
    return {};
  }
  return fail(ErrorCode::UnknownUnit, "Column '" + std::string(written) + "': " + unknown->error.message,
              {{"column", std::string(written)}, {"unit", unknown->symbol}});
}

std::string unknown_unit_of_temperature(std::string_view name) {
  const auto unknown = unknown_unit(name);
  return unknown && unknown->quantity == Quantity::Temperature ? unknown->symbol : std::string();
}

std::string unread_unit(std::string_view name) {
  const std::string_view bracket = take_bracket(name);
  const bool index = bracket.find_first_not_of("0123456789") == std::string_view::npos;
  return index || states_no_unit(bracket) || known_unit(bracket) ? std::string() : std::string(bracket);
}

bool states_unit(std::string_view name) {
  const auto unit = known_unit(take_bracket(name));
  return unit && unit->dimension != Dimension::One;
}

std::vector<std::string> inertial_structs(const ColumnNames& names) {
  std::vector<std::string> structs;
  const std::set<std::string_view> known(names.begin(), names.end());
  for (const std::string& name : names) {
    if (!name.ends_with(".t")) {
      continue;
    }
    const std::string of = name.substr(0, name.size() - 2);
    if (std::all_of(kStructMembers.begin(), kStructMembers.end(),
                    [&](const StructMember& member) { return known.contains(of + std::string(member.name)); })) {
      structs.push_back(of);
    }
  }
  return structs;
}

bool reads_names(const RecordingSpec& spec) {
  return std::all_of(spec.columns.begin(), spec.columns.end(),
                     [](const auto& stated) { return stated.second.quantity == Quantity::Time; });
}

std::vector<ColumnRole> infer_roles(const ColumnNames& names) {
  const std::vector<std::string> found = inertial_structs(names);
  const std::set<std::string, std::less<>> structs(found.begin(), found.end());
  std::vector<ColumnRole> roles;
  for (const std::string& name : names) {
    const std::size_t dot = std::min(name.rfind('.'), name.size());
    const auto member = std::find_if(kStructMembers.begin(), kStructMembers.end(),
                                     [&](const StructMember& known) { return known.name == name.substr(dot); });
    const bool known = member != kStructMembers.end() && structs.contains(name.substr(0, dot));
    roles.push_back(known ? ColumnRole{member->quantity, std::string(member->axis), known_unit(member->unit)}
                          : infer_role(name));
  }
  std::vector<bool> second(names.size());
  std::transform(names.begin(), names.end(), roles.begin(), second.begin(),
                 [](const std::string& name, const ColumnRole& role) { return is_second_choice(name, role.quantity); });
  const auto comes_first = [&](std::size_t j, std::size_t i) {
    return !second[j] || (roles[i].quantity == Quantity::Temperature && j < i);  // of devices the first will do
  };
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (std::size_t j = 0; j < names.size() && second[i]; ++j) {
      if (roles[j].quantity == roles[i].quantity && roles[j].axis == roles[i].axis && comes_first(j, i)) {
        roles[i] = {};
        break;
      }
    }
  }
  return roles;
}

ColumnRole infer_role(std::string_view written) {
  const auto [name, bracket] = parts_of(written);
  if (bracket.empty()) {
    for (const auto infer : {infer_suffixed, infer_quotient}) {
      if (auto role = infer(name)) {
        return *role;
      }
    }
  }
  const auto bare = infer_bare(name, std::nullopt);
  const Quantity quantity = bare ? bare->quantity : Quantity::Unspecified;
  ColumnRole role = infer_bare(name, known_unit(bracket, quantity)).value_or(ColumnRole{});
  if (role.quantity == Quantity::Temperature && role.unit && !measures(*role.unit, role.quantity)) {
    role.unit.reset();
  }
  return role;
}

}  // namespace driftlab
