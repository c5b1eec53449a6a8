#pragma once
/// The suite of every store for tests that write to its rows as a fault of the disk would. Whoever includes it is
/// compiled with DRIFTLAB_POSTGRES where there is one (tests/CMakeLists.txt).
#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/store_suite.hpp"

#ifdef DRIFTLAB_POSTGRES
#include "server/store/postgres/postgres_store.hpp"
#endif

namespace driftlab::server {

class RowSuite : public StoreSuite {
 protected:
  Database& database() {
#ifdef DRIFTLAB_POSTGRES
    if (auto* const postgres = dynamic_cast<PostgresStore*>(&store())) {
      return postgres->database();
    }
#endif
    return dynamic_cast<SqliteStore&>(store()).database();
  }
  SqlStore& rows() { return dynamic_cast<SqlStore&>(store()); }
};

}  // namespace driftlab::server
