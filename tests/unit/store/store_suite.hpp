#pragma once
/// The suite that every store passes: tests named `*_cases.cpp` here run over each store of `all_stores`.
#include "server/store/store.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace driftlab::server {

struct StoreUnderTest {
  std::string name;
  std::function<std::unique_ptr<Store>(const std::filesystem::path& directory, const Clock& clock)> open;
  friend std::ostream& operator<<(std::ostream& out, const StoreUnderTest& store) { return out << store.name; }
};

/// One line for each implementation (stores.cpp).
const std::vector<StoreUnderTest>& all_stores();

/// An opened, empty store with a clock that stands still.
class StoreSuite : public testing::TestWithParam<StoreUnderTest> {
 protected:
  StoreSuite() : store_(GetParam().open(directory_.path(), clock_)) {}
  void SetUp() override { ASSERT_NE(store_, nullptr); }
  Store& store() { return *store_; }
  void reopen() {
    store_.reset();
    store_ = GetParam().open(directory_.path(), clock_);
    ASSERT_NE(store_, nullptr);
  }

  FakeClock clock_;

 private:
  TemporaryDirectory directory_;
  std::unique_ptr<Store> store_;
};

#define DRIFTLAB_OVER_ALL_STORES(suite)                                    \
  INSTANTIATE_TEST_SUITE_P(Stores, suite, testing::ValuesIn(all_stores()), \
                           [](const auto& parameter) { return parameter.param.name; })

}  // namespace driftlab::server
