#include "schema/json/mat_file.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>

namespace driftlab {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

constexpr std::size_t kNameBytes = 64;  ///< of a field, with its zero
constexpr std::size_t kLongestName = kNameBytes - 1;
constexpr std::size_t kMostBytes = 0x7fffffff;

/// Element types (table 1-1) and array classes (table 1-3).
enum Type : std::uint32_t { Int8 = 1, UInt8 = 2, UInt16 = 4, Int32 = 5, UInt32 = 6, Double = 9, Matrix = 14 };
enum Class : std::uint32_t { Cell = 1, Struct = 2, Char = 4, Doubles = 6, Bytes = 9 };
constexpr std::uint32_t kLogical = 0x0200;

template <class Number>
void append(std::string& bytes, Number value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A tag and its data, padded to 8 bytes; up to 4 bytes fit into the tag.
std::string element(Type type, const std::string& data) {
  std::string bytes;
  if (!data.empty() && data.size() <= 4) {
    append(bytes, static_cast<std::uint16_t>(type));
    append(bytes, static_cast<std::uint16_t>(data.size()));
  } else {
    append(bytes, static_cast<std::uint32_t>(type));
    append(bytes, static_cast<std::uint32_t>(data.size()));
  }
  bytes += data;
  bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
  return bytes;
}

/// What every array begins with.
std::string array_head(std::uint32_t flags, std::size_t rows, std::size_t columns, const std::string& name) {
  std::string words;
  append(words, flags);
  append(words, std::uint32_t{0});
  std::string shape;
  append(shape, static_cast<std::int32_t>(rows));
  append(shape, static_cast<std::int32_t>(columns));
  return element(UInt32, words) + element(Int32, shape) + element(Int8, name);
}

std::string doubles(const std::vector<double>& values, std::size_t rows, const std::string& name) {
  std::string data;
  for (const double value : values) {
    append(data, value);
  }
  return element(Matrix, array_head(Doubles, rows, rows == 0 ? 0 : values.size() / rows, name) + element(Double, data));
}

/// UTF-16 code units of text that is UTF-8; what is not becomes U+FFFD.
std::vector<std::uint16_t> code_units(const std::string& text) {
  std::vector<std::uint16_t> units;
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const std::size_t more = lead < 0x80 ? 0 : lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : lead >= 0xc0 ? 1 : 4;
    std::uint32_t point = more == 0 ? lead : lead & (0x3fU >> more);
    bool sound = more < 4 && i + more < text.size();
    for (std::size_t k = 1; sound && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[i + k]);
      sound = (next & 0xc0U) == 0x80U;
      point = point << 6U | (next & 0x3fU);
    }
    i += sound ? more + 1 : 1;
    point = sound ? point : 0xfffd;
    if (point < 0x10000) {
      units.push_back(static_cast<std::uint16_t>(point));
    } else {
      units.push_back(static_cast<std::uint16_t>(0xd800U + ((point - 0x10000U) >> 10U)));
      units.push_back(static_cast<std::uint16_t>(0xdc00U + ((point - 0x10000U) & 0x3ffU)));
    }
  }
  return units;
}

std::string characters(const std::string& text, const std::string& name) {
  const std::vector<std::uint16_t> units = code_units(text);
  std::string data;
  for (const std::uint16_t unit : units) {
    append(data, unit);
  }
  return element(Matrix, array_head(Char, units.empty() ? 0 : 1, units.size(), name) + element(UInt16, data));
}

bool is_number_or_null(const Json& value) { return value.is_number() || value.is_null(); }

bool is_row(const Json& list) {
  return list.is_array() && !list.empty() && std::all_of(list.begin(), list.end(), is_number_or_null) &&
         std::any_of(list.begin(), list.end(), [](const Json& value) { return value.is_number(); });
}

double number_of(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Rows of equal length, which together are a matrix.
bool is_matrix(const Json& list) {
  return !list.empty() && std::all_of(list.begin(), list.end(), [&](const Json& row) {
    return is_row(row) && row.size() == list.front().size();
  });
}

std::string matrix(const Json& rows, const std::string& name) {
  std::vector<double> values;
  for (std::size_t column = 0; column < rows.front().size(); ++column) {  // column after column
    for (const Json& row : rows) {
      values.push_back(number_of(row[column]));
    }
  }
  return doubles(values, rows.size(), name);
}

/// A name that MATLAB takes and that is not among `taken` yet.
std::string valid_name(const std::string& name, std::set<std::string>& taken) {
  std::string valid;
  for (const char c : name) {
    const bool sound = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    valid += sound ? c : '_';
  }
  if (valid.empty() || !((valid[0] >= 'a' && valid[0] <= 'z') || (valid[0] >= 'A' && valid[0] <= 'Z'))) {
    valid.insert(0, "x");
  }
  valid = valid.substr(0, kLongestName);
  std::string unique = valid;
  for (int i = 2; !taken.insert(unique).second; ++i) {
    const std::string suffix = "_" + std::to_string(i);
    unique = valid.substr(0, kLongestName - suffix.size()) + suffix;
  }
  return unique;
}

std::string value_of(const Json& value, const std::string& name);

std::string structure(const Json& object, const std::string& name) {
  std::set<std::string> taken;
  std::string names;
  std::string fields;
  for (const auto& [member, value] : object.items()) {
    std::string field = valid_name(member, taken);
    field.resize(kNameBytes, '\0');
    names += field;
    fields += value_of(value, "");
  }
  std::string length;
  append(length, static_cast<std::int32_t>(kNameBytes));
  return element(Matrix, array_head(Struct, 1, 1, name) + element(Int32, length) + element(Int8, names) + fields);
}

std::string cells(const Json& list, const std::string& name) {
  std::string content;
  for (const Json& value : list) {
    content += value_of(value, "");
  }
  return element(Matrix, array_head(Cell, 1, list.size(), name) + content);
}

bool fits_double(const Json& value) {
  constexpr std::int64_t kMost = 9'007'199'254'740'992;  // 2^53
  if (value.is_number_unsigned()) {
    return value.get<std::uint64_t>() <= static_cast<std::uint64_t>(kMost);
  }
  const auto whole = value.is_number_integer() ? value.get<std::int64_t>() : 0;
  return -kMost <= whole && whole <= kMost;
}

std::string value_of(const Json& value, const std::string& name) {
  if (value.is_object()) {
    return structure(value, name);
  }
  if (value.is_array()) {
    if (is_row(value) && std::all_of(value.begin(), value.end(), fits_double)) {
      std::vector<double> numbers;
      std::transform(value.begin(), value.end(), std::back_inserter(numbers), number_of);
      return doubles(numbers, 1, name);
    }
    return is_matrix(value) ? matrix(value, name) : value.empty() ? doubles({}, 0, name) : cells(value, name);
  }
  if (value.is_string()) {
    return characters(value.get<std::string>(), name);
  }
  if (value.is_boolean()) {
    return element(Matrix, array_head(Bytes | kLogical, 1, 1, name) +
                               element(UInt8, std::string(1, value.get<bool>() ? '\1' : '\0')));
  }
  if (value.is_number()) {
    return fits_double(value) ? doubles({value.get<double>()}, 1, name) : characters(to_text(value), name);
  }
  return doubles({}, 0, name);
}

}  // namespace

Result<std::string> mat_file(const Json& document) {
  std::string head = "MATLAB 5.0 MAT-file, Platform: any, Created by: driftlab " DRIFTLAB_VERSION;
  head.resize(116, ' ');
  head.resize(124, '\0');  // no data of subsystems
  append(head, std::uint16_t{0x0100});
  head += "IM";
  const std::string variable = value_of(document, "result");
  if (variable.size() > kMostBytes) {
    return fail(ErrorCode::LimitExceeded, "The document is larger than the 2 GiB that a MAT file of level 5 holds.");
  }
  return head + variable;
}

}  // namespace driftlab
