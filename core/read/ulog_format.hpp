#pragma once
/// The layout of a ULog message from the text that declares it. Internal to core/read.
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::ulog {

/// `name:type field;type[n] field;...` by name, as the file declares them.
using Definitions = std::map<std::string, std::string, std::less<>>;

/// Where a field of a basic type lies in the data of a message.
struct Place {
  std::size_t offset = 0;
  std::string_view type;  ///< `float`, `uint64_t`, ...; points into the definitions
  std::size_t count = 1;  ///< 3 for `float[3]`
};

/// The field of a declared message. Nothing where the message is not declared, lacks the field, or is declared in
/// a way that has no size: an unknown type, a type inside itself, more than the 65535 bytes that a message can have.
[[nodiscard]] std::optional<Place> find_field(const Definitions& definitions, std::string_view message,
                                              std::string_view field);

/// Bytes of one number at a place that find_field gave.
[[nodiscard]] std::size_t bytes_of(const Place& place);

/// The number there in the data of a message, which reach behind it. A whole number beyond 2^53 is rounded.
[[nodiscard]] double number_at(std::string_view data, const Place& place);

}  // namespace driftlab::ulog
