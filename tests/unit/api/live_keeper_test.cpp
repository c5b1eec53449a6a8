#include "server/api/live_keeper.hpp"

#include "server/api/live_about.hpp"
#include "tests/unit/api/world.hpp"
#include "tests/unit/store/world.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>

namespace driftlab::server {
namespace {

class KeptLive : public testing::Test {
 protected:
  KeptLive() { EXPECT_TRUE(world_.gate().load()); }

  /// One that a second of a gyroscope came for.
  std::string begun_for(const Principal& principal) {
    const Json given{{"device", "phone-07"},
                     {"condition", {{"kind", "static"}}},
                     {"columns", {{"gz", {{"quantity", "angular_rate"}, {"axis", "z"}, {"unit", "rad/s"}}}}}};
    const std::string about = live_about_text(given, "phone-07", {"gz"}, clock_.now(), principal);
    const std::string id = keeper_.recordings().create(about, "secret", 1, principal.token).value().id;
    std::vector<std::byte> rows;
    for (int i = 0; i < 100; ++i) {
      const double time = 0.01 * i;
      const float rate = static_cast<float>(1e-3 * std::sin(i));
      const auto* const t = reinterpret_cast<const std::byte*>(&time);
      const auto* const r = reinterpret_cast<const std::byte*>(&rate);
      rows.insert(rows.end(), t, t + sizeof time);
      rows.insert(rows.end(), r, r + sizeof rate);
    }
    EXPECT_TRUE(keeper_.recordings().add(id, 0, rows));
    return id;
  }
  [[nodiscard]] std::vector<Recording> recorded() { return world_.store->recordings({}, {}).value(); }
  [[nodiscard]] bool is_kept(const std::string& id) { return keeper_.recordings().find(id).has_value(); }

  World world_;
  FakeClock clock_;
  ApiContext context_{*world_.store,
                      *world_.blobs,
                      clock_,
                      world_.bell,
                      world_.events,
                      [] {},
                      [] { return std::string(); },
                      world_.directory / "aged",
                      world_.store->access(),
                      world_.gate()};
  LiveKeeper keeper_{context_};
};

TEST_F(KeptLive, BecomesARecordingWhereNobodyAddsForAnHour) {
  const std::string id = begun_for({});
  clock_.advance(kHour - 1);
  keeper_.finish_untouched();
  EXPECT_TRUE(is_kept(id));
  EXPECT_TRUE(recorded().empty());
  clock_.advance(2);
  keeper_.finish_untouched();
  EXPECT_FALSE(is_kept(id));
  ASSERT_EQ(recorded().size(), 1U);
  EXPECT_EQ(recorded()[0].condition, "static");
  EXPECT_EQ(world_.store->jobs({"characterise", std::nullopt}, {}).value().size(), 1U) << "and is characterised";
}

TEST_F(KeptLive, OfARevokedTokenBecomesNoneAndGoesAfterADay) {
  ASSERT_TRUE(world_.gate().create({"a", Scope::Admin, std::nullopt, std::nullopt}));
  const Token token = world_.gate().create({"b", Scope::Run, std::nullopt, std::nullopt}).value().token;
  const std::string id = begun_for({token.id, token.name, token.scope, token.devices});
  ASSERT_TRUE(world_.gate().revoke(token.id));
  clock_.advance(2 * kHour);
  keeper_.finish_untouched();
  EXPECT_TRUE(is_kept(id));
  EXPECT_TRUE(recorded().empty());
  clock_.advance(22 * kHour + 1);
  keeper_.finish_untouched();
  EXPECT_FALSE(is_kept(id));
  EXPECT_TRUE(recorded().empty());
}

}  // namespace
}  // namespace driftlab::server
