#include "server/store/bad_states.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace driftlab::server {
namespace {

class FixedClock final : public Clock {
 public:
  [[nodiscard]] UtcMicros now() const override { return now_; }
  UtcMicros now_ = 1'700'000'000'000'000;
};

struct World {
  FixedClock clock;
  bool writable = true;
  std::vector<std::string> rows;
  std::vector<std::string> told;
  BadStates states{clock,
                   [this](const StandingState& state, bool begins) {
                     told.push_back(std::string(begins ? "begin " : "end ") + std::string(name_of(state.state)));
                   },
                   [this](const std::string& action, const std::string& object, const std::string& detail) -> Status {
                     if (!writable) {
                       return fail(ErrorCode::Io, "no");
                     }
                     rows.push_back(action + " " + object + " " + detail);
                     return {};
                   }};
};

TEST(BadStates, AreSaidOnceWithTheirCauseAndOnceAtTheirEnd) {
  World world;
  for (int i = 0; i < 5; ++i) {
    world.states.begin(BadState::StoreUnwritable, "io", "Could not write /srv/data/x: broken.");
    world.states.look_after();
  }
  ASSERT_EQ(world.rows.size(), 1U);
  EXPECT_EQ(world.rows[0].substr(0, 50), "state.begin store_unwritable store_unwritable, io,");
  EXPECT_EQ(world.rows[0].find("/srv"), std::string::npos) << "the audit log is an answer too";
  ASSERT_EQ(world.states.standing().size(), 1U);
  world.states.begin(BadState::StoreUnwritable, "disk_full", "The disk is full.");
  world.states.end(BadState::StoreUnwritable);
  world.states.end(BadState::StoreUnwritable);
  world.states.look_after();
  EXPECT_EQ(world.rows.size(), 3U);
  EXPECT_TRUE(world.states.standing().empty());
  EXPECT_EQ(world.told,
            (std::vector<std::string>{"begin store_unwritable", "begin store_unwritable", "end store_unwritable"}));
}

TEST(BadStates, WaitForAStoreThatCannotBeWritten) {
  World world;
  world.writable = false;
  world.states.begin(BadState::StoreUnwritable, "io", "Broken.");
  world.states.look_after();
  world.states.end(BadState::StoreUnwritable);
  world.states.look_after();
  EXPECT_TRUE(world.rows.empty());
  world.writable = true;
  world.states.look_after();
  ASSERT_EQ(world.rows.size(), 2U);
  EXPECT_TRUE(world.rows[0].starts_with("state.begin"));
  EXPECT_TRUE(world.rows[1].starts_with("state.end"));
}

TEST(BadStates, AFailureOfADiskPassesAfterFiveMinutesWithoutAnother) {
  World world;
  world.states.note_failure({ErrorCode::Io, "Could not read.", {}});
  world.clock.now_ += 200'000'000;
  world.states.note_failure({ErrorCode::Io, "Could not read.", {}});
  world.clock.now_ += 200'000'000;
  world.states.look_after();
  EXPECT_EQ(world.states.standing().size(), 1U);
  world.clock.now_ += 200'000'000;
  world.states.look_after();
  EXPECT_TRUE(world.states.standing().empty());
  EXPECT_EQ(world.rows.size(), 2U);
}

TEST(BadStates, EachDamagedFileIsOne) {
  World world;
  world.states.begin(BadState::FileDamaged, "damage", "Damaged.", "aa");
  world.states.begin(BadState::FileDamaged, "damage", "Damaged.", "bb");
  EXPECT_EQ(world.states.standing().size(), 2U);
  world.states.end(BadState::FileDamaged, "aa");
  ASSERT_EQ(world.states.standing().size(), 1U);
  EXPECT_EQ(world.states.standing()[0].object, "bb");
}

}  // namespace
}  // namespace driftlab::server
