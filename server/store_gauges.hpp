#pragma once
/// What a scrape shows of the store and its disk.
#include "server/observe/metrics.hpp"
#include "server/store/bad_states.hpp"
#include "server/store/blobs.hpp"
#include "server/store/sql/sql_store.hpp"

namespace driftlab::server {

/// Fills in what the store says; what it cannot say stays as it is.
void add_store_gauges(Gauges& gauges, SqlStore& store, const Clock& clock);
/// Fills in what the disk says.
void add_disk_gauges(Gauges& gauges, BlobStore& blobs);
/// Every state with every cause: how many things are in it, most often none.
void add_state_gauges(Gauges& gauges, const BadStates& states);

}  // namespace driftlab::server
