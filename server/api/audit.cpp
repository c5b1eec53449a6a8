#include "server/api/api.hpp"
#include "server/api/audit_row.hpp"
#include "server/api/documents.hpp"

#include <charconv>

namespace driftlab::server {
namespace {

/// 0 for a text that is none.
std::int64_t sequence_of(std::string_view text) {
  std::int64_t sequence = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), sequence);
  return error == std::errc{} && stop == text.data() + text.size() ? sequence : 0;
}

Result<Response> list_audit(ApiContext& context, const Request& request) {
  const auto page = page_of(request, [](std::string_view cursor) { return sequence_of(cursor) > 0; });
  if (!page) {
    return fail(page.error());
  }
  const auto rows =
      context.access.audit(sequence_of(page->after), page->limit + 1, page->order == PageOrder::NewestFirst);
  if (!rows) {
    return fail(rows.error());
  }
  ListPage list(request, *page);
  auto row = rows->begin();
  while (row != rows->end() && list.add(to_json(*row), std::to_string(row->sequence))) {
    ++row;
  }
  return list.response(row != rows->end());
}

Result<Response> verify_audit_log(ApiContext& context) {
  const auto verdict = context.access.verify_audit();
  if (!verdict) {
    return fail(verdict.error());
  }
  return json_response(200, Json{{"rows", verdict->rows},
                                 {"head", verdict->head},
                                 {"sound", verdict->fault.empty()},
                                 {"fault", verdict->fault.empty() ? Json(nullptr) : Json(verdict->fault)}});
}

}  // namespace

void add_audit_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/audit", "listAudit", {"limit", "cursor", "sort"}, Handler([&](const Request& request) {
                return list_audit(context, request);
              })});
  router.add({"GET", "/v1/audit-verification", "verifyAudit", {}, Handler([&](const Request&) {
                return verify_audit_log(context);
              })});
}

}  // namespace driftlab::server
