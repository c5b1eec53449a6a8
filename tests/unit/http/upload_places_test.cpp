#include "server/http/upload_places.hpp"

#include <gtest/gtest.h>

#include <string>

namespace driftlab::server {
namespace {

using namespace std::chrono_literals;

constexpr UploadPlaces::Time kNoon{};

class UploadPlacesTest : public testing::Test {
 protected:
  UploadPlacesTest() {
    budgets_.uploads = 2;
    budgets_.uploads_waiting = 4;
    budgets_.uploads_per_address = 2;
    budgets_.decode_bytes_per_second = 1000;
  }
  UploadPlaces::Number join(const std::string& principal, std::uint64_t bytes, UploadPlaces::Time at = kNoon,
                            const std::string& address = "127.0.0.1") {
    return places_.join({principal, address, bytes}, at).value_or(0);
  }

  Budgets budgets_;
  UploadPlaces places_{budgets_, [](const std::string& address) { return address == "127.0.0.1"; }};
};

TEST_F(UploadPlacesTest, APlaceGoesToWhoeverHoldsFewestThoughOthersCameBefore) {
  const auto first = join("greedy", 10);
  const auto second = join("greedy", 10);
  const auto third = join("greedy", 10);
  const auto other = join("modest", 10'000);
  EXPECT_TRUE(places_.has_place(first) && places_.has_place(second));
  EXPECT_FALSE(places_.has_place(third) || places_.has_place(other));
  places_.leave(first);
  EXPECT_TRUE(places_.has_place(other));
  EXPECT_FALSE(places_.has_place(third));
  places_.leave(second);
  EXPECT_TRUE(places_.has_place(third));
  EXPECT_EQ(places_.taken(), 2U);
}

TEST_F(UploadPlacesTest, OfOnePrincipalASmallOneOvertakesALargeOneThatCameALittleEarlier) {
  const auto running = join("lab", 10);
  const auto beside = join("lab", 10);
  const auto large = join("lab", 60'000, kNoon);
  const auto small = join("lab", 1000, kNoon + 30s);
  const auto late = join("lab", 1000, kNoon + 90s);
  places_.leave(running);
  EXPECT_TRUE(places_.has_place(small));
  places_.leave(beside);
  EXPECT_TRUE(places_.has_place(large)) << "what came first waits no longer than its own decoding takes";
  EXPECT_FALSE(places_.has_place(late));
}

TEST_F(UploadPlacesTest, WithoutTokensTheAddressTellsApart) {
  const auto first = join("", 10, kNoon, "10.0.0.1");
  (void)join("", 10, kNoon, "10.0.0.1");
  const auto again = join("", 10, kNoon, "10.0.0.1");
  const auto other = join("", 10, kNoon, "10.0.0.2");
  places_.leave(first);
  EXPECT_TRUE(places_.has_place(other));
  EXPECT_FALSE(places_.has_place(again));
}

TEST_F(UploadPlacesTest, AnAddressHasItsBudgetUnlessItIsExempt) {
  budgets_.uploads = 8;
  const auto first = join("", 10, kNoon, "10.0.0.1");
  (void)join("", 10, kNoon, "10.0.0.1");
  const auto third = join("", 10, kNoon, "10.0.0.1");
  EXPECT_FALSE(places_.has_place(third));
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(places_.has_place(join("", 10)));
  }
  places_.leave(first);
  EXPECT_TRUE(places_.has_place(third));
}

TEST_F(UploadPlacesTest, TooManyWaitingAreTurnedAwayAndLeaveNothingBehind) {
  const auto first = join("lab", 10);
  (void)join("lab", 10);
  for (int i = 0; i < 4; ++i) {
    EXPECT_NE(join("lab", 10), 0U);
  }
  EXPECT_EQ(join("other", 10), 0U);
  places_.leave(first);
  EXPECT_NE(join("other", 10), 0U);
  EXPECT_EQ(places_.taken(), 2U);
}

TEST_F(UploadPlacesTest, WithNoQueueAFreePlaceIsStillTaken) {
  budgets_.uploads_waiting = 0;
  EXPECT_NE(join("lab", 10), 0U);
  EXPECT_NE(join("lab", 10), 0U);
  EXPECT_EQ(join("lab", 10), 0U);
}

}  // namespace
}  // namespace driftlab::server
