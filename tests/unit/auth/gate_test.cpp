#include "server/auth/gate.hpp"

#include "server/auth/secret.hpp"
#include "server/store/digest.hpp"
#include "server/store/sqlite/sqlite_store.hpp"
#include "tests/unit/store/world.hpp"

#include <gtest/gtest.h>

#include <set>

namespace driftlab::server {
namespace {

class GateTest : public testing::Test {
 protected:
  GateTest() : store_(std::move(open_sqlite_store(directory_.path(), clock_).value())) { reopen({}); }

  void reopen(GateOptions options) {
    gate_ = std::make_unique<Gate>(store_->access(), clock_, options);
    ASSERT_TRUE(gate_->load());
  }
  IssuedToken made(Scope scope, std::optional<UtcMicros> expires_at = std::nullopt) {
    return gate_->create({"a", scope, std::nullopt, expires_at}).value();
  }
  bool admits(const std::string& secret) {
    const std::string bearer = "Bearer " + secret;
    return gate_->identify({bearer, std::nullopt}).has_value();
  }

  FakeClock clock_;
  TemporaryDirectory directory_;
  std::unique_ptr<SqliteStore> store_;
  std::unique_ptr<Gate> gate_;
};

TEST(Secret, HasItsShapeAndNoticesEveryTypingError) {
  std::set<std::string> seen;
  for (int i = 0; i < 200; ++i) {
    const std::string secret = make_secret();
    ASSERT_EQ(secret.size(), 40U);
    EXPECT_TRUE(is_secret(secret));
    seen.insert(secret);
  }
  EXPECT_EQ(seen.size(), 200U);
  const std::string secret = make_secret();
  for (std::size_t i = 0; i < secret.size(); ++i) {  // a CRC notices every change of one character
    std::string mistyped = secret;
    mistyped[i] = mistyped[i] == 'x' ? 'y' : 'x';
    EXPECT_FALSE(is_secret(mistyped)) << mistyped;
  }
  for (const std::string& text : {std::string(), secret + "0", secret.substr(1), "dl_" + std::string(37, ' ')}) {
    EXPECT_FALSE(is_secret(text)) << text;
  }
  EXPECT_TRUE(is_token_id(make_token_id()));
  EXPECT_EQ(make_random_secret().size(), 64U);
}

TEST_F(GateTest, KeepsNoMoreTokensThanItsBudgets) {
  GateOptions few;
  few.budgets.tokens = 2;
  few.budgets.tokens_ever = 3;
  reopen(few);
  made(Scope::Admin);
  const IssuedToken second = made(Scope::Read);
  const auto refused = [this] { return gate_->create({"a", Scope::Read, std::nullopt, std::nullopt}).error(); };
  EXPECT_EQ(refused().code, ErrorCode::LimitExceeded);
  EXPECT_NE(refused().message.find("(budget tokens = 2)"), std::string::npos);
  ASSERT_TRUE(gate_->revoke(second.token.id));
  const IssuedToken third = made(Scope::Read);
  ASSERT_TRUE(gate_->revoke(third.token.id));
  EXPECT_NE(refused().message.find("(budget tokens_ever = 3)"), std::string::npos);
}

TEST_F(GateTest, IsOpenUntilThereIsATokenAndNeverAgain) {
  EXPECT_FALSE(gate_->is_on());
  EXPECT_EQ(gate_->identify({})->scope, Scope::Admin);
  const IssuedToken token = made(Scope::Admin);
  EXPECT_TRUE(gate_->is_on());
  EXPECT_FALSE(gate_->identify({}));
  EXPECT_TRUE(admits(token.secret));
  EXPECT_FALSE(gate_->revoke(token.token.id));  // the last admin
  ASSERT_TRUE(gate_->revoke(token.token.id, true));
  EXPECT_FALSE(admits(token.secret));
  EXPECT_FALSE(gate_->identify({}));
  reopen({});
  EXPECT_TRUE(gate_->is_on());
  EXPECT_FALSE(gate_->identify({}));
}

TEST_F(GateTest, AsksForTokensBeforeThereIsOneWhereItIsTold) {
  reopen({.require = true, .secure = false});
  EXPECT_TRUE(gate_->is_on());
  EXPECT_FALSE(gate_->identify({}));
  EXPECT_FALSE(gate_->create({"a", Scope::Run, std::nullopt, std::nullopt}));
  EXPECT_TRUE(admits(made(Scope::Admin).secret));
}

TEST_F(GateTest, EndsATokenAtItsTime) {
  (void)made(Scope::Admin);
  const IssuedToken token = made(Scope::Read, clock_.now() + kHour);
  const std::string bearer = "Bearer " + token.secret;
  const Principal who = gate_->identify({bearer, std::nullopt}).value();
  clock_.advance(kHour - 1);
  EXPECT_TRUE(admits(token.secret));
  EXPECT_TRUE(gate_->is_valid(who));
  clock_.advance(1);
  EXPECT_FALSE(admits(token.secret));
  EXPECT_FALSE(gate_->is_valid(who));
  EXPECT_FALSE(gate_->open_session(token.secret));
}

TEST_F(GateTest, ASessionLastsTwelveHoursAndNoLongerThanItsToken) {
  (void)made(Scope::Admin);
  const IssuedToken longer = made(Scope::Read);
  const IssuedToken shorter = made(Scope::Read, clock_.now() + kHour);
  const auto admitted = [&](const IssuedSession& session) {
    const std::string cookie = "a=b; driftlab-session=" + session.secret + "; c";
    return gate_->identify({std::nullopt, cookie}).has_value();
  };
  const IssuedSession day = gate_->open_session(longer.secret).value();
  const IssuedSession hour = gate_->open_session(shorter.secret).value();
  EXPECT_EQ(day.session.expires_at, clock_.now() + 12 * kHour);
  EXPECT_EQ(hour.session.expires_at, clock_.now() + kHour);
  reopen({});  // a restart forgets no session
  EXPECT_TRUE(admitted(day) && admitted(hour));
  clock_.advance(kHour);
  EXPECT_TRUE(admitted(day));
  EXPECT_FALSE(admitted(hour));
  clock_.advance(11 * kHour);
  EXPECT_FALSE(admitted(day));
}

TEST_F(GateTest, WhoCameInByASessionIsAdmittedUntilItEnds) {
  const IssuedToken token = made(Scope::Admin);
  const IssuedSession session = gate_->open_session(token.secret).value();
  const std::string cookie = "driftlab-session=" + session.secret;
  const Principal who = gate_->identify({std::nullopt, cookie}).value();
  EXPECT_TRUE(gate_->is_valid(who));
  ASSERT_TRUE(gate_->close_session({std::nullopt, cookie}));
  EXPECT_FALSE(gate_->is_valid(who));
  const IssuedSession day = gate_->open_session(token.secret).value();
  const Principal again = gate_->identify({std::nullopt, "driftlab-session=" + day.secret}).value();
  clock_.advance(12 * kHour);
  EXPECT_FALSE(gate_->is_valid(again));
  EXPECT_TRUE(gate_->is_valid(gate_->identify({"Bearer " + token.secret, std::nullopt}).value()));
}

TEST_F(GateTest, UnderTlsOnlyTheCookieCountsThatNoOtherHostCanSet) {
  const IssuedToken token = made(Scope::Admin);
  reopen({.require = true, .secure = true});
  const IssuedSession session = gate_->open_session(token.secret).value();
  EXPECT_FALSE(gate_->identify({std::nullopt, "driftlab-session=" + session.secret}));
  EXPECT_TRUE(gate_->identify({std::nullopt, "driftlab-session=planted; __Host-driftlab=" + session.secret}));
}

TEST_F(GateTest, AnAdminThatEndsWithinTheDayIsNotTheLast) {
  const IssuedToken lasting = made(Scope::Admin);
  (void)made(Scope::Admin, clock_.now() + 3 * kSecond);
  EXPECT_EQ(gate_->revoke(lasting.token.id).error().code, ErrorCode::Conflict);
  (void)made(Scope::Admin, clock_.now() + 25 * kHour);
  EXPECT_TRUE(gate_->revoke(lasting.token.id));
}

TEST_F(GateTest, AnExpiredTokenGetsNoNewSecret) {
  (void)made(Scope::Admin);
  const IssuedToken token = made(Scope::Read, clock_.now() + kHour);
  EXPECT_TRUE(gate_->rotate(token.token.id));
  clock_.advance(kHour);
  EXPECT_EQ(gate_->rotate(token.token.id).error().code, ErrorCode::Conflict);
}

TEST_F(GateTest, WritesTheLastUseOncePerMinute) {
  (void)made(Scope::Admin);
  clock_.advance(kSecond);  // tokens are listed by age
  const IssuedToken token = made(Scope::Read);
  const auto last_used = [&] { return gate_->tokens()->back().last_used_at; };
  EXPECT_TRUE(admits(token.secret));
  ASSERT_TRUE(gate_->flush_use());
  const auto first = last_used();
  EXPECT_EQ(first, clock_.now());
  clock_.advance(kSecond);
  EXPECT_TRUE(admits(token.secret));
  ASSERT_TRUE(gate_->flush_use());
  EXPECT_EQ(last_used(), first);
  ASSERT_TRUE(gate_->flush_use(true));
  EXPECT_EQ(last_used(), clock_.now());
}

TEST_F(GateTest, RowsOfTheAuditLogStandOrFallWithTheirChange) {
  const Caller caller{Principal{"", "operator", Scope::Admin, {}, ""}, "req", "::1"};
  const ActingFor acting(caller);
  ASSERT_TRUE(store_->ensure_device({"", "a", "", "", "", "{}", 1, 0, 0}));
  ASSERT_TRUE(store_->ensure_device({"", "a", "", "", "", "{}", 1, 0, 0}));  // changes nothing
  EXPECT_FALSE(store_->update_device("dev_nobody", {}, 1));                  // fails
  EXPECT_FALSE(store_->ensure_device({"", "", "", "", "", "{}", 1, 0, 0}));  // fails
  (void)made(Scope::Admin);
  const auto rows = store_->access().audit(0, 10, false).value();
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].action, "device.create");
  EXPECT_EQ(rows[0].actor, "operator");
  EXPECT_EQ(rows[0].address, "::1");
  EXPECT_EQ(rows[1].action, "token.create");
  EXPECT_EQ(rows[1].previous, rows[0].digest);
  // The rule of server/store/audit.hpp, written out.
  EXPECT_EQ(rows[0].digest, sha256_hex("64:" + std::string(64, '0') + ",1:1,16:" + std::to_string(rows[0].at) +
                                       ",8:operator,13:device.create,30:" + rows[0].object + ",3:req,3:::1,0:,"));
  EXPECT_TRUE(store_->access().verify_audit()->fault.empty());
}

}  // namespace
}  // namespace driftlab::server
