#pragma once
/// Numbers and stretches of a little-endian binary recording. Internal to core/read.
#include "core/read/byte_source.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace driftlab {

static_assert(std::endian::native == std::endian::little, "the readers of binary recordings copy little-endian words");

/// The number at byte `at` of `bytes`, which holds it, of any alignment.
template <class Number>
[[nodiscard]] Number load_at(std::string_view bytes, std::size_t at) {
  Number value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Takes up to `count` bytes and says how many there were: fewer only where the input ends. Errors: those of `source`,
/// Cancelled.
[[nodiscard]] inline Result<std::uint64_t> skip_bytes(ByteSource& source, std::uint64_t count,
                                                      const RunControl& control) {
  std::uint64_t taken = 0;
  while (taken < count) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view();
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      break;
    }
    const std::size_t piece = std::min<std::uint64_t>(count - taken, view->size());
    source.consume(piece);
    taken += piece;
  }
  return taken;
}

}  // namespace driftlab
