#pragma once
/// The lines of a text, one after the other. Internal to core/read.
#include "core/read/byte_source.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace driftlab::text {

/// Calls `take(line, number)` with each line without its end, numbered from 1. Errors: those of `take` and of `source`,
/// Cancelled; LimitExceeded for a line longer than `longest`, with the field `row`.
template <class Take>
[[nodiscard]] Status for_each_line(ByteSource& source, std::size_t longest, const RunControl& control,
                                   const Take& take) {
  for (std::uint64_t number = 1;; ++number) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view(longest + 1);
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return {};
    }
    const std::size_t end = std::min(view->find('\n'), view->size());
    if (end > longest) {
      const std::string row = std::to_string(number);
      return fail(ErrorCode::LimitExceeded, "Line " + row + " is longer than " + std::to_string(longest) + " bytes.",
                  {{"row", row}});
    }
    std::string_view line = view->substr(0, end);
    if (!line.empty() && line.back() == '\r') {
      line.remove_suffix(1);
    }
    if (Status status = take(line, number); !status) {
      return status;
    }
    source.consume(std::min(end + 1, view->size()));
  }
}

}  // namespace driftlab::text
