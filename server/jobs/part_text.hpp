#pragma once
/// What a part of a job found, as a text that is kept in the store (server/store/part_store.hpp).
///
/// Base64 of a snapshot (schema/snapshot/snapshot.hpp), behind a checksum over it, the release and the shape of the
/// value: a text of another program or a damaged one is refused, not misread.
#include "schema/snapshot/snapshot.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace driftlab::server {

/// Bytes of a value of that shape, as printable ASCII.
[[nodiscard]] std::string sealed_part(std::string_view shape, std::string_view bytes);
/// Back. Nothing for a text of another release or shape, or a damaged one.
[[nodiscard]] std::optional<std::string> opened_part(std::string_view shape, std::string_view text);

template <class T>
[[nodiscard]] std::string part_text(const T& value) {
  SnapshotWriter writer;
  writer.put(value);
  return sealed_part(SnapshotShape::of<T>(), writer.bytes());
}

/// Nothing for a text that is not such a value's by this program.
template <class T>
[[nodiscard]] std::optional<T> from_part_text(std::string_view text) {
  if (const auto bytes = opened_part(SnapshotShape::of<T>(), text)) {
    T value{};
    SnapshotReader reader(*bytes);
    reader.get(value);
    if (reader.complete()) {
      return value;
    }
  }
  return std::nullopt;
}

}  // namespace driftlab::server
