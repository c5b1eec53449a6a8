#include "tests/unit/store/postgres/open.hpp"

#include "server/store/digest.hpp"
#include "tests/unit/store/postgres/cluster.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {

std::string schema_for(const std::filesystem::path& directory) {
  return "t" + sha256_hex(directory.string()).substr(0, 20);
}

std::unique_ptr<Store> open_postgres_under_test(const std::filesystem::path& directory, const Clock& clock) {
  PostgresOptions options;
  options.jitter_seed = 1;
  options.clock = &clock;
  auto opened = open_postgres_store(PostgresCluster::of_this_process().schema(schema_for(directory)), options);
  EXPECT_TRUE(opened) << opened.error().message;
  return opened ? std::move(*opened) : nullptr;
}

}  // namespace driftlab::server
