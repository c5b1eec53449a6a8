// Pages of lists: what a query asks for, and the answer.
#include "schema/json/regression.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace driftlab::server {
namespace {

tl::unexpected<Error> unknown_cursor() {
  return fail(ErrorCode::InvalidArgument, "The cursor is not one that a list in this order gave.",
              {{"parameter", "cursor"}});
}

/// Limit and order.
Result<Page> first_page(const Request& request, ListNames names) {
  Page page;
  if (const auto limit = request.parameter("limit")) {
    const auto [stop, error] = std::from_chars(limit->data(), limit->data() + limit->size(), page.limit);
    if (error != std::errc{} || stop != limit->data() + limit->size() || page.limit < 1 || page.limit > 500) {
      return fail(ErrorCode::InvalidArgument, "The limit must be a whole number from 1 to 500.",
                  {{"parameter", "limit"}});
    }
  }
  const std::string_view sort = request.parameter("sort").value_or("created_at");
  if (sort == "-created_at") {
    page.order = PageOrder::NewestFirst;
  } else if (sort == "name" && names == ListNames::Sorted) {
    page.order = PageOrder::ByName;
  } else if (sort != "created_at") {
    return fail(ErrorCode::InvalidArgument,
                names == ListNames::Sorted
                    ? "The list is sorted by created_at, oldest first, by -created_at, or by name."
                    : "The list is sorted by created_at, oldest first, or by -created_at.",
                {{"parameter", "sort"}});
  }
  return page;
}

}  // namespace

Result<Page> page_of(const Request& request, ListNames names) {
  auto page = first_page(request, names);
  const auto cursor = request.parameter("cursor");
  if (!page || !cursor) {
    return page;
  }
  const auto row = read_cursor(*cursor, page->order);
  if (!row || !is_plain_text(row->name)) {
    return unknown_cursor();
  }
  page->after = row->id;
  page->after_name = row->name;
  return page;
}

Result<Page> page_of(const Request& request, bool (*is_cursor)(std::string_view)) {
  auto page = first_page(request, ListNames::None);
  const auto cursor = request.parameter("cursor");
  if (page && cursor) {
    if (!is_cursor(*cursor)) {
      return unknown_cursor();
    }
    page->after = *cursor;
  }
  return page;
}

Result<std::optional<std::string>> text_filter(const Request& request) {
  constexpr std::size_t kLongest = 200;
  const auto text = request.parameter("q");
  if (text && (text->empty() || text->size() > kLongest || !is_plain_text(*text))) {
    return fail(ErrorCode::InvalidArgument, "What is sought is a text of 1 to 200 bytes: ?q=…", {{"parameter", "q"}});
  }
  return text ? std::optional<std::string>(*text) : std::nullopt;
}

Result<std::optional<UtcMicros>> since_filter(const Request& request) {
  constexpr double kMicros = 1e6;
  const auto text = request.parameter("since");
  if (!text) {
    return std::optional<UtcMicros>{};
  }
  const auto seconds = seconds_of(std::string(*text));
  if (!seconds) {
    return fail(ErrorCode::InvalidArgument, seconds.error().message, {{"parameter", "since"}});
  }
  return std::optional<UtcMicros>{std::llround(*seconds * kMicros)};
}

ListPage::ListPage(const Request& request, const Page& page)
    : request_(request),
      most_items_(static_cast<std::size_t>(page.limit)),
      most_bytes_(static_cast<std::size_t>(request.budgets->page_bytes)),
      last_cursor_(cursor_at(page.order, page.after, page.after_name)) {}

int ListPage::rows_to_fetch() const {
  constexpr std::size_t kFirst = 16;
  constexpr std::size_t kMost = 128;
  const std::size_t left = most_items_ + 1 - items_;
  const std::size_t room = most_bytes_ > text_.size() ? most_bytes_ - text_.size() : 0;
  const std::size_t fitting = items_ == 0 ? kFirst : std::min(room / std::max<std::size_t>(largest_, 1) + 1, kMost);
  return static_cast<int>(std::clamp<std::size_t>(fitting, 1, left));
}

bool ListPage::add(const Json& item, const std::string& cursor) {
  const std::string text = to_text(item);
  if (items_ == most_items_ || (items_ > 0 && text_.size() + text.size() > most_bytes_)) {
    return false;
  }
  text_ += (items_ > 0 ? "," : "") + text;
  ++items_;
  largest_ = std::max(largest_, text.size());
  last_cursor_ = cursor;
  return true;
}

Response ListPage::response(bool more) const {
  Response response;
  response.body = text_ + "],\"next_cursor\":" + (more ? to_text(Json(last_cursor_)) : "null") + "}";
  if (more) {
    std::string link = request_.target.substr(0, request_.target.find('?')) + "?";
    for (const auto& [name, value] : request_.query) {
      if (name != "cursor") {
        link += name + "=" + percent_encode(value) + "&";
      }
    }
    response.headers.emplace_back("Link", "<" + link + "cursor=" + last_cursor_ + ">; rel=\"next\"");
  }
  return response;
}

}  // namespace driftlab::server
