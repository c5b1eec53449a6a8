#pragma once
/// gzip as a content coding (RFC 9110 section 8.4).
///
/// A compressed answer is another representation and has a tag of its own: `"rec_1-r1"` becomes `"rec_1-r1-gzip"`. What
/// a client sends back in If-Match and If-None-Match is compared without that ending (`plain_tag`), so that either
/// representation may be read before a change.
#include "server/http/message.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// Answers shorter than this are sent as they are: less would be saved than the headers cost.
inline constexpr std::size_t kSmallestCompressed = 1024;

/// Levels of zlib: what is packed anew for each answer, and what is packed once and kept.
inline constexpr int kQuick = 6;
inline constexpr int kThorough = 9;

/// `text` in the gzip format, the same bytes each time. Empty where there is no memory for it.
[[nodiscard]] std::string gzip(std::string_view text, int level = kQuick);

/// Whether Accept-Encoding takes gzip.
[[nodiscard]] bool takes_gzip(const Request& request);

/// The field value with the ending of compressed representations taken off every tag in it.
[[nodiscard]] std::string plain_tag(std::string_view field);

/// Compresses the body where the client takes it, it is text and long enough, and marks the answer as such. The length
/// of an answer without a body (304) says nothing: its tag alone is changed.
void compress(const Request& request, Response& response);

}  // namespace driftlab::server
