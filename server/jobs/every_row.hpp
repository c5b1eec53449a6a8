#pragma once
/// A whole list of the store, page by page.
#include "server/store/store.hpp"

namespace driftlab::server {

/// Calls `take` with every row that `fetch(page)` lists, in that order. Errors: those of `fetch`.
template <class Fetch, class Take>
Status for_each_row(const Fetch& fetch, const Take& take, PageOrder order = PageOrder::OldestFirst) {
  constexpr int kPage = 500;
  Page page{.after = "", .limit = kPage, .order = order};
  while (true) {
    const auto rows = fetch(page);
    if (!rows) {
      return fail(rows.error());
    }
    for (const auto& row : *rows) {
      take(row);
    }
    if (static_cast<int>(rows->size()) < kPage) {
      return {};
    }
    page.after = rows->back().id;
  }
}

}  // namespace driftlab::server
