#include "core/read/dataflash_format.hpp"

#include "core/read/little_endian.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace driftlab::dataflash {
namespace {

struct Letter {
  char letter;
  std::size_t bytes;
  double (*load)(std::string_view message, std::size_t at);  ///< null: no number
  double unit;                                               ///< what the number counts
};

template <class Number>
constexpr Letter number(char letter, double unit = 1.0) {
  return {letter, sizeof(Number),
          [](std::string_view message, std::size_t at) { return static_cast<double>(load_at<Number>(message, at)); },
          unit};
}

constexpr Letter bytes(char letter, std::size_t count) { return {letter, count, nullptr, 0.0}; }

constexpr std::array kLetters{
    number<std::int8_t>('b'),
    number<std::uint8_t>('B'),
    number<std::uint8_t>('M'),
    number<std::int16_t>('h'),
    number<std::uint16_t>('H'),
    number<std::int16_t>('c', 0.01),
    number<std::uint16_t>('C', 0.01),
    bytes('g', 2),
    number<std::int32_t>('i'),
    number<std::uint32_t>('I'),
    number<float>('f'),
    bytes('n', 4),
    number<std::int32_t>('e', 0.01),
    number<std::uint32_t>('E', 0.01),
    number<std::int32_t>('L', 1e-7),
    number<double>('d'),
    number<std::int64_t>('q'),
    number<std::uint64_t>('Q'),
    bytes('N', 16),
    bytes('a', 64),
    bytes('Z', 64),
};

const Letter* find_letter(char letter) {
  const auto found =
      std::find_if(kLetters.begin(), kLetters.end(), [letter](const Letter& known) { return known.letter == letter; });
  return found == kLetters.end() ? nullptr : &*found;
}

/// `bytes` up to its first zero.
std::string_view padded_text(std::string_view bytes) {
  return bytes.substr(0, std::min(bytes.find('\0'), bytes.size()));
}

}  // namespace

std::optional<std::size_t> Declared::find(std::string_view label, std::string_view letters) const {
  const auto found = fields.find(label);
  return found != fields.end() && letters.find(found->second.letter) != std::string_view::npos
             ? std::optional(found->second.place)
             : std::nullopt;
}

std::optional<Declared> declared_by(std::string_view body) {
  Declared message;
  message.bytes = static_cast<unsigned char>(body[1]);
  message.name = padded_text(body.substr(2, 4));
  std::string_view labels = padded_text(body.substr(22, 64));
  std::size_t place = kHead;
  for (const char letter : padded_text(body.substr(6, 16))) {
    const std::size_t comma = std::min(labels.find(','), labels.size());
    message.fields.emplace(labels.substr(0, comma), Field{letter, place});
    labels.remove_prefix(std::min(comma + 1, labels.size()));
    const Letter* const known = find_letter(letter);
    if (known == nullptr) {
      return std::nullopt;
    }
    place += known->bytes;
  }
  return place == message.bytes ? std::optional(std::move(message)) : std::nullopt;
}

bool is_number(const Field& field) {
  const Letter* const known = find_letter(field.letter);
  return known != nullptr && known->load != nullptr;
}

double number_at(std::string_view message, const Field& field) {
  const Letter* const known = find_letter(field.letter);
  return known == nullptr || known->load == nullptr ? 0.0 : known->load(message, field.place) * known->unit;
}

}  // namespace driftlab::dataflash
