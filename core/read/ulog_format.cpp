#include "core/read/ulog_format.hpp"

#include "core/read/little_endian.hpp"

#include <array>
#include <charconv>

namespace driftlab::ulog {
namespace {

constexpr std::size_t kMostBytes = 65535;
constexpr int kDeepest = 8;

struct Basic {
  std::string_view name;
  std::size_t bytes;
  double (*load)(std::string_view data, std::size_t at);
};

template <class Number>
constexpr Basic basic(std::string_view name) {
  return {name, sizeof(Number),
          [](std::string_view data, std::size_t at) { return static_cast<double>(load_at<Number>(data, at)); }};
}

constexpr std::array kBasics{
    basic<std::int8_t>("int8_t"),   basic<std::uint8_t>("uint8_t"),   basic<std::uint8_t>("bool"),
    basic<std::int8_t>("char"),     basic<std::int16_t>("int16_t"),   basic<std::uint16_t>("uint16_t"),
    basic<std::int32_t>("int32_t"), basic<std::uint32_t>("uint32_t"), basic<float>("float"),
    basic<std::int64_t>("int64_t"), basic<std::uint64_t>("uint64_t"), basic<double>("double"),
};

std::size_t basic_bytes(std::string_view type) {
  for (const Basic& basic : kBasics) {
    if (basic.name == type) {
      return basic.bytes;
    }
  }
  return 0;
}

struct Field {
  std::string_view type;
  std::string_view name;
  std::size_t count = 1;
};

/// Takes the next field off `text`; nothing at its end and where it is no field.
std::optional<Field> take_field(std::string_view& text) {
  const std::size_t end = text.find(';');
  if (end == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view one = text.substr(0, end);
  text.remove_prefix(end + 1);
  const std::size_t space = one.find(' ');
  if (space == std::string_view::npos) {
    return std::nullopt;
  }
  Field field{one.substr(0, space), one.substr(space + 1)};
  if (const std::size_t open = field.type.find('['); open != std::string_view::npos) {
    const char* const last = one.data() + space;
    const auto [stop, error] = std::from_chars(one.data() + open + 1, last, field.count);
    if (error != std::errc{} || stop + 1 != last || *stop != ']' || field.count == 0 || field.count > kMostBytes) {
      return std::nullopt;
    }
    field.type = field.type.substr(0, open);
  }
  return field;
}

/// Bytes of a message; 0 where it has no size. Every leaf counts at least a byte, so that the bound on bytes is one on
/// the work.
std::size_t size_of(const Definitions& definitions, std::string_view type, int depth, std::size_t room) {
  if (const std::size_t basic = basic_bytes(type); basic > 0) {
    return basic;
  }
  const auto found = definitions.find(type);
  if (found == definitions.end() || depth == kDeepest) {
    return 0;
  }
  std::string_view rest = found->second;
  std::size_t bytes = 0;
  while (!rest.empty()) {
    const auto field = take_field(rest);
    if (!field) {
      return 0;
    }
    const std::size_t one = size_of(definitions, field->type, depth + 1, room - bytes);
    if (one == 0 || one * field->count > room - bytes) {
      return 0;
    }
    bytes += one * field->count;
  }
  return bytes;
}

}  // namespace

std::optional<Place> find_field(const Definitions& definitions, std::string_view message, std::string_view name) {
  const auto found = definitions.find(message);
  if (found == definitions.end()) {
    return std::nullopt;
  }
  std::string_view rest = found->second;
  Place place;
  while (!rest.empty()) {
    const auto field = take_field(rest);
    if (!field) {
      return std::nullopt;
    }
    if (field->name == name) {
      place.type = field->type;
      place.count = field->count;
      const bool fits = basic_bytes(place.type) * place.count <= kMostBytes - place.offset;
      return basic_bytes(place.type) > 0 && fits ? std::optional(place) : std::nullopt;
    }
    const std::size_t one = size_of(definitions, field->type, 0, kMostBytes - place.offset);
    if (one == 0 || one * field->count > kMostBytes - place.offset) {
      return std::nullopt;
    }
    place.offset += one * field->count;
  }
  return std::nullopt;
}

std::size_t bytes_of(const Place& place) { return basic_bytes(place.type); }

double number_at(std::string_view data, const Place& place) {
  for (const Basic& basic : kBasics) {
    if (basic.name == place.type) {
      return basic.load(data, place.offset);
    }
  }
  return 0.0;
}

}  // namespace driftlab::ulog
