#pragma once
/// The head of an answer: its status line and its header fields, as text.
///
/// Beast's serializer goes over the five parts of every field one by one, once for each layer of buffers that it stands
/// in, which costs the short answers that are read most (tests/RELIABILITY.md, "Speed of the doors").
#include "server/http/message.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab::server {

/// What the answer itself does not say.
struct AnswerFrame {
  std::string_view request_id;
  std::optional<std::uint64_t> length = std::nullopt;  ///< of the body; nothing: it ends with the connection
  bool closes = false;                                 ///< the connection does, behind this answer
};

/// Whether an answer of that status has content, of which its head says type and length: not 204 and 304.
[[nodiscard]] constexpr bool has_content(int status) { return status != 204 && status != 304; }

/// HTTP/1.1 status line and fields with the empty line behind them. Every answer says that its type is not to be
/// guessed, what a page of it may load, and that it is not kept unasked, where it says nothing else of these itself.
/// An answer without content has neither type nor length.
[[nodiscard]] std::string answer_head(const Response& response, const AnswerFrame& frame);

}  // namespace driftlab::server
