#pragma once
/// The lines of a text, one after the other. Internal to core/read.
#include "core/read/format.hpp"
#include "core/signal/progress.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace driftlab::text {

/// Calls `take(line, number, whole)` with each line without its end, numbered from 1; the last one is not whole if it
/// has no line feed. Errors: those of `take` and of `source`, Cancelled; LimitExceeded for a line longer than
/// `longest`, with the field `row`.
template <class Take>
[[nodiscard]] Status for_each_line_or_rest(ByteSource& source, std::size_t longest, const RunControl& control,
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
    const bool whole = end < view->size();
    std::string_view line = view->substr(0, end);
    if (!line.empty() && line.back() == '\r') {
      line.remove_suffix(1);
    }
    if (Status status = take(line, number, whole); !status) {
      return status;
    }
    source.consume(std::min(end + 1, view->size()));
  }
}

/// The same of `take(line, number)`.
template <class Take>
[[nodiscard]] Status for_each_line(ByteSource& source, std::size_t longest, const RunControl& control,
                                   const Take& take) {
  return for_each_line_or_rest(source, longest, control,
                               [&](std::string_view line, std::uint64_t number, bool) { return take(line, number); });
}

/// The same of a table, a row a line. A file that ends within a row, as where a logger lost its power, is read up to
/// there with a note: a last line that has no line feed and that `take`, which then has taken nothing of it, refuses
/// with RaggedRow or NotANumber.
template <class Take>
[[nodiscard]] Status for_each_row(ByteSource& source, std::size_t longest, const RunControl& control, ColumnSink& sink,
                                  const Take& take) {
  return for_each_line_or_rest(
      source, longest, control, [&](std::string_view line, std::uint64_t number, bool whole) -> Status {
        Status status = take(line, number);
        const bool torn = !status && !whole &&
                          (status.error().code == ErrorCode::RaggedRow || status.error().code == ErrorCode::NotANumber);
        if (torn) {
          sink.note("The file ends within a row (line " + std::to_string(number) + "); that row is left out.");
          return {};
        }
        return status;
      });
}

}  // namespace driftlab::text
