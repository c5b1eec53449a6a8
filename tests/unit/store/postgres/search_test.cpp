/// Parts of names are found by an index where PostgreSQL has its trigrams.
#include "server/store/postgres/connection.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"
#include "tests/unit/store/world.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace driftlab::server {
namespace {

TEST(PostgresSearch, FindsPartsOfNamesByAnIndex) {
  if (PostgresCluster::programs().empty()) {
    GTEST_SKIP() << "POSTGRESQL NOT TESTED: there is no PostgreSQL 15 in /usr/lib/postgresql.";
  }
  const TemporaryDirectory directory;
  const PostgresCluster& cluster = PostgresCluster::of_this_process();
  const std::string schema = schema_for(directory.path());
  const std::string uri = cluster.schema(schema);
  // On a table of a few rows nobody would ask an index: its readers may not ask anything else.
  ASSERT_TRUE(
      cluster.run("ALTER ROLE driftlab SET enable_seqscan = off; ALTER ROLE driftlab SET enable_indexscan = off"));
  {
    auto store = open_postgres_store(uri);
    ASSERT_TRUE(store) << store.error().message;
    add_device(**store, "Turntable 7");
    EXPECT_EQ((*store)->devices(DeviceFilter{"table 7"}, {})->size(), 1U);
    EXPECT_TRUE((*store)->devices(DeviceFilter{"table_7"}, {})->empty());
    RecordingFilter filter;
    filter.text = "nowhere";
    EXPECT_TRUE((*store)->recordings(filter, {})->empty());
  }
  EXPECT_TRUE(cluster.run("ALTER ROLE driftlab RESET ALL"));
  const auto asked = PostgresConnection::open(uri, "test");
  ASSERT_TRUE(asked);
  for (const std::string index : {"devices_sought_within", "recordings_sought_within"}) {
    // Counted a moment after the connections of the store have ended.
    std::string count = "SELECT idx_scan::TEXT, pg_sleep(0.05) FROM pg_stat_user_indexes WHERE schemaname = '";
    count.append(schema).append("' AND indexrelname = '").append(index).append("'");
    std::optional<std::string> scans;
    for (int look = 0; look < 200 && scans.value_or("0") == "0"; ++look) {
      ASSERT_TRUE((*asked)->begin("BEGIN"));
      scans = (*asked)->query_text(count).value_or(std::nullopt);
      (*asked)->roll_back();
    }
    EXPECT_GE(std::stoi(scans.value_or("0")), 1) << index;
  }
}

}  // namespace
}  // namespace driftlab::server
