#pragma once
/// The store as the caller of the present thread may see it: what belongs to devices that it may not know of is not
/// there, in lists, counts and by name alike, and the answer is that of an object that does not exist.
///
/// Handlers use this store and no other. It implements every method of `Store`, so that a method added there does not
/// compile until it says here what a caller limited to devices sees of it. Callers without a limit, and threads without
/// a caller, see every row.
#include "server/store/store.hpp"

#include <memory>

namespace driftlab::server {

/// `whole` must outlive it.
[[nodiscard]] std::unique_ptr<Store> make_visible_store(Store& whole);

}  // namespace driftlab::server
