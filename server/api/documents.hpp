#pragma once
/// Rows of the store as the documents that go over the wire, and the small things every resource shares.
#include "schema/json/json.hpp"
#include "server/http/message.hpp"
#include "server/store/cursor.hpp"
#include "server/store/store.hpp"

#include <functional>
#include <optional>
#include <string>
#include <type_traits>

namespace driftlab::server {

/// The metadata of a recording with its labels, session and time.
[[nodiscard]] Json described(const Recording& recording);
[[nodiscard]] Json to_json(const Device& device);
/// `blob` may be nullptr: then the members about the file are left out.
[[nodiscard]] Json to_json(const Recording& recording, const Blob* blob);
/// Samples per second of a recording: measured by its time column, or as stated; nothing where neither is known.
[[nodiscard]] std::optional<double> rate_of(const Recording& recording);
[[nodiscard]] Json to_json(const Job& job);
[[nodiscard]] Json to_json(const Fit& fit);

/// Where the result of a job of that kind is read; `investigation`: what it made, if it is one that does.
[[nodiscard]] std::string result_address(std::string_view kind, const std::string& job,
                                         const std::string& investigation);

/// The key under which the reply is kept: keys are those of a token.
[[nodiscard]] std::string own_key(const Request& request, std::string_view key);

/// What a key gets that is no `is_request_id`.
[[nodiscard]] Error malformed_idempotency_key();

/// The stored answer to the same request, marked as replayed; a problem where the key belongs to another request. The
/// answer has no body where that was left out.
[[nodiscard]] Response replay(const IdempotentReply& reply, const Request& request, const std::string& body_sha256);
/// What is kept of an answer: of one that is longer than the budget reply_bytes and can be read again where its
/// Location leads, its status and headers.
[[nodiscard]] IdempotentReply reply_to_remember(const std::string& key, const Request& request,
                                                const std::string& body_sha256, const Response& response,
                                                UtcMicros now);

/// The answer to a request for a job that could not be checked. Where its inputs are being pooled (server/jobs/
/// stored_table.hpp) it is one that a waiting connection asks for again.
[[nodiscard]] Result<Response> refused_job(const Error& error);

/// The answer where too many jobs wait already; nothing where there is room for one more.
[[nodiscard]] std::optional<Response> refuse_full_queue(Store& store, const Budgets& budgets);

/// What `read(ObjectReader&, Faults&)` makes of the JSON body of a request. A member that it does not ask for is a
/// fault; the error holds every fault at once.
template <class Read>
[[nodiscard]] auto read_body(const Request& request, const Read& read)
    -> Result<std::invoke_result_t<Read, ObjectReader&, Faults&>> {
  const auto body = parse_json(request.body);
  if (!body) {
    return fail(body.error());
  }
  Faults faults;
  ObjectReader reader(*body, "", faults);
  auto value = read(reader, faults);
  reader.reject_unknown();
  if (!faults.none()) {
    return fail(faults.error());
  }
  return value;
}

[[nodiscard]] Response json_response(int status, const Json& document);

/// A stored JSON text inside a document; null where it does not parse.
[[nodiscard]] Json stored(const std::string& text);

/// The ETag of a mutable object.
[[nodiscard]] std::string etag_of(std::string_view id, std::int64_t revision);
/// Labels count apart from the revision, which results name.
[[nodiscard]] std::string etag_of(const Recording& recording);
/// The ETag of an answer that shows more than the object's own state, such as a job that names it: `If-Match` takes it
/// for that state, `If-None-Match` sees every change.
[[nodiscard]] std::string shown_etag(const std::string& etag, const std::string& beside);

/// The refusal where If-Match is missing (428) or names another state of an object than `etag` (412); `*` is any.
[[nodiscard]] std::optional<Response> refuse_stale(const Request& request, const std::string& etag);

/// The ETag of an answer whose object has no revision: its content.
[[nodiscard]] std::string content_etag(const Response& response);

/// The refusal where If-Match names another state of an object that never changes than `response`, its GET, shows;
/// nothing where it is right or was not sent.
[[nodiscard]] std::optional<Response> refuse_other_content(const Request& request, const Response& response);

/// The revision that If-Match names. Errors for answers: precondition-required without the header, precondition-failed
/// when it names another object. `*` is the current revision.
[[nodiscard]] tl::expected<std::int64_t, Response> expected_revision(const Request& request, std::string_view id,
                                                                     std::int64_t current);

/// 204, the answer to a DELETE that was done, or its error.
[[nodiscard]] Result<Response> removed_response(const Status& removed);

/// The answer to a DELETE of what is made once: `shown` is the answer to its GET, of whose content If-Match may speak.
/// What is damaged cannot be shown and goes all the same, where If-Match is `*` or was not sent.
[[nodiscard]] Result<Response> remove_shown(const Request& request, const Result<Response>& shown,
                                            const std::function<Status()>& remove);

/// A fault at `pointer` where a text is longer than the budget of that name allows.
void limit_text(std::string_view text, std::string_view budget, std::int64_t most, const std::string& pointer,
                Faults& faults);

/// Whether a list can be in the order of names.
enum class ListNames { None, Sorted };

/// `?limit=` (1 to 500, default 50), `?cursor=`, and `?sort=` created_at (default) or -created_at, or name where rows
/// have one. Error: InvalidArgument naming the parameter.
[[nodiscard]] Result<Page> page_of(const Request& request, ListNames names);
/// The same for a list without names whose cursors are no ids of rows: `is_cursor` tells them.
[[nodiscard]] Result<Page> page_of(const Request& request, bool (*is_cursor)(std::string_view));

/// `?q=`, what is sought; nothing where it is not asked for. Error: InvalidArgument naming the parameter.
[[nodiscard]] Result<std::optional<std::string>> text_filter(const Request& request);

/// `?since=`, a time of RFC 3339; nothing where it is not asked for. Error: InvalidArgument naming the parameter.
[[nodiscard]] Result<std::optional<UtcMicros>> since_filter(const Request& request);

/// The id of the device that `?device=` names by id or name; nothing where it is not asked for. Error: NotFound.
[[nodiscard]] Result<std::optional<std::string>> device_filter(Store& store, const Request& request);

/// `?state=` of a job; nothing where it is not asked for. Error: InvalidArgument naming the parameter.
[[nodiscard]] Result<std::optional<JobState>> state_filter(const Request& request);

/// A page of a list under construction: as many items as were asked for, or as fit into the budget page_bytes. Items
/// are kept as text, so that an answer takes little more than its own length, and one larger than the budget comes
/// alone.
class ListPage {
 public:
  ListPage(const Request& request, const Page& page);
  /// How many rows to fetch next, from what the largest so far took. At least 1.
  [[nodiscard]] int rows_to_fetch() const;
  /// False: the page is full, and the item begins the next one.
  [[nodiscard]] bool add(const Json& item, const std::string& cursor);
  /// {"items": [...], "next_cursor": ...} with `Link: rel="next"` where more follow.
  [[nodiscard]] Response response(bool more) const;

 private:
  const Request& request_;
  std::size_t most_items_;
  std::size_t most_bytes_;
  std::size_t items_ = 0;
  std::size_t largest_ = 0;
  std::string last_cursor_;
  std::string text_ = "{\"items\":[";
};

/// The page of stored rows that a request asks for. `fetch` reads rows after an id, as many as asked; `item` makes the
/// document of one. Rows have an `id`. They are read a few at a time, for large ones would fill the memory. Errors:
/// those of page_of and of the store.
template <class Fetch, class Item>
[[nodiscard]] Result<Response> list_rows(const Request& request, const Fetch& fetch, const Item& item) {
  using Row = typename std::invoke_result_t<const Fetch&, const Page&>::value_type::value_type;
  constexpr bool kNamed = requires(const Row& row) { row.name; };
  auto page = page_of(request, kNamed ? ListNames::Sorted : ListNames::None);
  if (!page) {
    return fail(page.error());
  }
  ListPage list(request, *page);
  while (true) {
    page->limit = list.rows_to_fetch();
    const auto rows = fetch(*page);
    if (!rows) {
      return fail(rows.error());
    }
    for (const auto& row : *rows) {
      std::string name;
      if constexpr (kNamed) {
        name = row.name;
      }
      if (!list.add(item(row), cursor_at(page->order, row.id, name))) {
        return list.response(true);
      }
      page->after = row.id;
      page->after_name = std::move(name);
    }
    if (rows->size() < static_cast<std::size_t>(page->limit)) {
      return list.response(false);
    }
  }
}

}  // namespace driftlab::server
