#pragma once
/// The layout of a DataFlash message from the one that declares it (FMT). Internal to core/read.
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::dataflash {

inline constexpr std::size_t kHead = 3;  ///< bytes of mark and number in front of a message

/// A letter, which says how the bytes are read, and their place in the message.
struct Field {
  char letter = 0;
  std::size_t place = 0;
};

/// A message as it was declared.
struct Declared {
  std::size_t bytes = 0;  ///< with its head
  std::string name;
  std::map<std::string, Field, std::less<>> fields;  ///< by label

  /// The place of a field of one of those letters.
  [[nodiscard]] std::optional<std::size_t> find(std::string_view label, std::string_view letters) const;
};

/// From the body of an FMT message of 86 bytes. Nothing where a letter is not known or the fields do not fill the
/// message.
[[nodiscard]] std::optional<Declared> declared_by(std::string_view body);

/// Whether the field is one number, and the number: hundredths (c, C, e, E) and 1e-7 deg (L) in whole units. The
/// message holds the field.
[[nodiscard]] bool is_number(const Field& field);
[[nodiscard]] double number_at(std::string_view message, const Field& field);

}  // namespace driftlab::dataflash
