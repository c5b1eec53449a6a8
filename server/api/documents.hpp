#pragma once
/// Rows of the store as the documents that go over the wire, and the small things every resource shares.
#include "schema/json/json.hpp"
#include "server/http/message.hpp"
#include "server/store/store.hpp"

#include <functional>
#include <optional>
#include <string>

namespace driftlab::server {

[[nodiscard]] Json to_json(const Device& device);
/// `blob` may be nullptr: then the members about the file are left out.
[[nodiscard]] Json to_json(const Recording& recording, const Blob* blob);
[[nodiscard]] Json to_json(const Job& job);
[[nodiscard]] Json to_json(const Fit& fit);

/// The key under which the reply is kept: keys are those of a token.
[[nodiscard]] std::string own_key(const Request& request, std::string_view key);

/// What a key gets that is no `is_request_id`.
[[nodiscard]] Error malformed_idempotency_key();

/// The stored answer to the same request, marked as replayed; a problem where the key belongs to another request.
[[nodiscard]] Response replay(const IdempotentReply& reply, const Request& request, const std::string& body_sha256);
[[nodiscard]] IdempotentReply reply_to_remember(const std::string& key, const Request& request,
                                                const std::string& body_sha256, const Response& response,
                                                UtcMicros now);

/// The answer to a request for a job that could not be checked. Where its inputs are being pooled (server/jobs/
/// stored_table.hpp) it is one that a waiting connection asks for again.
[[nodiscard]] Result<Response> refused_job(const Error& error);

[[nodiscard]] Response json_response(int status, const Json& document);

/// A stored JSON text inside a document; null where it does not parse.
[[nodiscard]] Json stored(const std::string& text);

/// The ETag of a mutable object.
[[nodiscard]] std::string etag_of(std::string_view id, std::int64_t revision);

/// The revision that If-Match names. Errors for answers: precondition-required without the header, precondition-failed
/// when it names another object. `*` is the current revision.
[[nodiscard]] tl::expected<std::int64_t, Response> expected_revision(const Request& request, std::string_view id,
                                                                     std::int64_t current);

/// `?limit=` (1 to 500, default 50), `?cursor=`, and `?sort=` created_at (default) or -created_at. Error:
/// InvalidArgument naming the parameter.
[[nodiscard]] Result<Page> page_of(const Request& request);
/// The same for a list whose cursors are no ids of rows: `is_cursor` tells them.
[[nodiscard]] Result<Page> page_of(const Request& request, bool (*is_cursor)(std::string_view));

/// The id of the device that `?device=` names by id or name; nothing where it is not asked for. Error: NotFound.
[[nodiscard]] Result<std::optional<std::string>> device_filter(Store& store, const Request& request);

/// `?state=` of a job; nothing where it is not asked for. Error: InvalidArgument naming the parameter.
[[nodiscard]] Result<std::optional<JobState>> state_filter(const Request& request);

/// {"items": [...], "next_cursor": ...} with `Link: rel="next"`, from a page that was fetched with one row more than
/// asked.
[[nodiscard]] Response list_response(const Request& request, const Page& page, std::vector<Json> items,
                                     const std::function<std::string(std::size_t)>& id_of);

/// The page of stored rows that a request asks for. `fetch` reads rows after an id, as many as asked and one more;
/// `item` makes the document of one. Rows have an `id`. Errors: those of page_of and of the store.
template <class Fetch, class Item>
[[nodiscard]] Result<Response> list_rows(const Request& request, const Fetch& fetch, const Item& item) {
  const auto page = page_of(request);
  if (!page) {
    return fail(page.error());
  }
  const auto rows = fetch(Page{page->after, page->limit + 1, page->newest_first});
  if (!rows) {
    return fail(rows.error());
  }
  std::vector<Json> items;
  for (const auto& row : *rows) {
    items.push_back(item(row));
  }
  return list_response(request, *page, std::move(items), [&](std::size_t i) { return (*rows)[i].id; });
}

}  // namespace driftlab::server
