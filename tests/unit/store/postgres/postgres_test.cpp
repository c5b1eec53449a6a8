/// What is true of the PostgreSQL store alone: several daemons on one database, connections that break, a server that
/// is gone, read-only or of another version, any bytes as text.
#include "server/store/postgres/connection.hpp"
#include "server/store/postgres/migrations.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "server/store/postgres/text_codec.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <set>
#include <thread>

namespace driftlab::server {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class PostgresStoreTest : public testing::Test {
 protected:
  void SetUp() override {
    if (PostgresCluster::programs().empty()) {
      GTEST_SKIP() << "POSTGRESQL NOT TESTED: there is no PostgreSQL 15 in /usr/lib/postgresql.";
    }
    schema_ = schema_for(directory_.path());
    uri_ = cluster().schema(schema_);
  }
  [[nodiscard]] static PostgresCluster& cluster() { return PostgresCluster::of_this_process(); }
  [[nodiscard]] std::unique_ptr<PostgresStore> open(PostgresOptions options = {}) const {
    options.jitter_seed = 1;
    auto opened = open_postgres_store(uri_, std::move(options));
    EXPECT_TRUE(opened) << opened.error().message;
    return opened ? std::move(*opened) : nullptr;
  }
  /// Why the store cannot be opened; the sentence must be one.
  [[nodiscard]] static Error refusal(const std::string& uri) {
    const auto opened = open_postgres_store(uri);
    EXPECT_FALSE(opened);
    const Error error = opened ? Error{} : opened.error();
    EXPECT_THAT(error.message, AllOf(EndsWith("."), Not(HasSubstr("\n")), Not(HasSubstr("secret"))));
    return error;
  }

  TemporaryDirectory directory_;
  std::string schema_;
  std::string uri_;
};

TEST_F(PostgresStoreTest, TellsWhatItFound) {
  {
    const auto store = open();
    EXPECT_THAT(store->facts().version, testing::StartsWith("1"));
    EXPECT_THAT(store->facts().database, HasSubstr("\"postgres\" on "));
    EXPECT_EQ(store->facts().schema_before, 0);
    EXPECT_EQ(store->facts().schema, static_cast<int>(embedded_postgres_migrations().size()));
    EXPECT_EQ(store->facts().identity.size(), 36U);
  }
  const auto again = open();
  EXPECT_EQ(again->facts().schema_before, again->facts().schema);
}

TEST_F(PostgresStoreTest, DaemonsThatStartTogetherMakeTheTablesOnce) {
  std::vector<std::thread> threads;
  std::atomic<int> made{0};
  threads.reserve(4);
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      const auto store = open();
      ASSERT_NE(store, nullptr);
      made += store->facts().schema_before == 0 ? 1 : 0;
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(made, 1);
}

TEST_F(PostgresStoreTest, TheClockIsThatOfTheDatabase) {
  const auto store = open();
  const UtcMicros before = SystemClock().now();
  const Device device = add_device(*store);
  EXPECT_GE(device.created_at, before - kSecond);
  EXPECT_LE(device.created_at, SystemClock().now() + kSecond);
  EXPECT_THAT(device.id, HasSubstr(make_id("dev", device.created_at).substr(0, 12)));
}

TEST_F(PostgresStoreTest, TwoDaemonsClaimEachJobOnceAndFenceEachOtherOff) {
  const FakeClock clock;
  PostgresOptions options;
  options.clock = &clock;
  const auto one = open(options);
  const auto two = open(options);
  constexpr int kJobs = 60;
  for (int i = 0; i < kJobs; ++i) {
    add_job(*one, "key " + std::to_string(i));
  }
  std::mutex mutex;
  std::multiset<std::string> claimed;
  std::vector<std::thread> threads;
  threads.reserve(8);
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&, i] {
      Store& store = i % 2 == 0 ? *one : *two;
      while (true) {
        const auto job = store.claim(kLease);
        ASSERT_TRUE(job) << job.error().message;
        if (!*job) {
          return;
        }
        ASSERT_TRUE(store.succeed(lease_of(**job), {"{}", {}, {}})->held);
        const std::lock_guard<std::mutex> guard(mutex);
        claimed.insert((*job)->id);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(claimed.size(), std::size_t{kJobs});
  EXPECT_EQ(std::set<std::string>(claimed.begin(), claimed.end()).size(), std::size_t{kJobs});

  add_job(*one, "contested");
  const Job lost = claim_one(*one);
  ASSERT_EQ(*two->end_all_leases(), 1);
  const Job held = claim_one(*two);
  EXPECT_FALSE(one->succeed(lease_of(lost), {"{}", {}, {}})->held);
  EXPECT_TRUE(two->succeed(lease_of(held), {"{}", {}, {}})->held);
}

TEST_F(PostgresStoreTest, ResultsOfOneAxisThatEndAtOnceArePooledTogether) {
  // Neither of two transactions that each add the second result of an axis sees the other's: unless one of them is run
  // again, nobody queues the pooling.
  const auto one = open();
  const auto two = open();
  for (int round = 0; round < 10; ++round) {
    const Device device = add_device(*one, "phone " + std::to_string(round));
    const Recording first = add_recording(*one, device, "first " + std::to_string(round));
    const Recording second = add_recording(*one, device, "second " + std::to_string(round));
    add_job(*one, "a " + std::to_string(round), 0);
    add_job(*one, "b " + std::to_string(round), 0);
    const Job a = claim_one(*one);
    const Job b = claim_one(*two);
    std::thread other([&] { EXPECT_TRUE(two->succeed(lease_of(b), results_for(b, second))->held); });
    EXPECT_TRUE(one->succeed(lease_of(a), results_for(a, first))->held);
    other.join();
    const auto pooled = one->axis_results({device.id, "angular_rate", "z"});
    ASSERT_TRUE(pooled && pooled->pool) << "round " << round;
    ASSERT_TRUE(one->request_cancel(pooled->pool->id));
  }
}

TEST_F(PostgresStoreTest, AuditedWritesOfSeveralDaemonsAreOneChain) {
  const auto one = open();
  const auto two = open();
  std::vector<std::thread> threads;
  threads.reserve(6);
  for (int i = 0; i < 6; ++i) {
    threads.emplace_back([&, i] {
      const Caller caller{Principal{"", "tester", Scope::Admin, {}, ""}, "req", "127.0.0.1"};
      const ActingFor acting(caller);
      for (int n = 0; n < 10; ++n) {
        add_device(i % 2 == 0 ? *one : *two, std::to_string(i) + "/" + std::to_string(n));
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const auto verdict = one->access().verify_audit();
  ASSERT_TRUE(verdict);
  EXPECT_EQ(verdict->fault, "");
  EXPECT_EQ(verdict->rows, 60);
  EXPECT_FALSE(cluster().run("DELETE FROM " + schema_ + ".audit"));
}

TEST_F(PostgresStoreTest, ADaemonThatWantsTheDatabaseAloneKeepsOthersOut) {
  PostgresOptions alone;
  alone.lock = DaemonLock::Kind::Alone;
  {
    const auto first = open(alone);
    const auto second = open_postgres_store(uri_, alone);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, ErrorCode::Conflict);
    EXPECT_THAT(second.error().message, HasSubstr("Another daemon works with the database"));
    ASSERT_TRUE(cluster().cut_connections());
    EXPECT_TRUE(first->ping()) << "the lock is taken again";
    EXPECT_FALSE(open_postgres_store(uri_, alone));
  }
  EXPECT_TRUE(open_postgres_store(uri_, alone)) << "the lock goes with its holder";
}

TEST_F(PostgresStoreTest, BrokenConnectionsAreReplacedUnnoticed) {
  const auto store = open();
  const Device device = add_device(*store);
  ASSERT_TRUE(cluster().cut_connections());
  EXPECT_TRUE(store->device(device.id)) << "a read";
  ASSERT_TRUE(cluster().cut_connections());
  add_device(*store, "another");
  ASSERT_TRUE(cluster().cut_connections());
  EXPECT_TRUE(store->ping());
}

// The first request after a restart met a connection that libpq still called good, and was answered with an error.
TEST_F(PostgresStoreTest, ARestartOfTheServerIsUnnoticed) {
  const auto store = open();
  const Device device = add_device(*store);
  for (int i = 0; i < 4; ++i) {
    cluster().stop(i % 2 == 0 ? SIGQUIT : SIGINT);
    cluster().start();
    const auto read = store->device(device.id);
    ASSERT_TRUE(read) << read.error().message;
    cluster().stop(i % 2 == 0 ? SIGINT : SIGQUIT);
    cluster().start();
    add_device(*store, "device " + std::to_string(i));
  }
}

TEST_F(PostgresStoreTest, AServerThatIsGoneIsSaidInOneSentenceAndComesBack) {
  const auto store = open();
  const Device device = add_device(*store);
  cluster().stop(SIGQUIT);
  for (int i = 0; i < 3; ++i) {
    const auto read = store->device(device.id);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::Io);
    EXPECT_THAT(read.error().message, AllOf(HasSubstr("The database \"postgres\" on "), EndsWith(".")));
    const auto written = store->write_probe();
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::Io);
  }
  EXPECT_EQ(refusal(uri_).code, ErrorCode::Io);
  cluster().start();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);  // far beyond the longest pause
  while (!store->ping() && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  const auto read = store->device(device.id);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(store->write_probe());
}

TEST_F(PostgresStoreTest, AReadOnlyDatabaseIsSaidAndStillRead) {
  const auto store = open();
  const Device device = add_device(*store);
  ASSERT_TRUE(cluster().run("ALTER DATABASE postgres SET default_transaction_read_only = on"));
  ASSERT_TRUE(cluster().cut_connections());
  EXPECT_TRUE(store->device(device.id));
  const auto written = store->write_probe();
  EXPECT_THAT(refusal(uri_).message, HasSubstr("is read-only"));
  ASSERT_TRUE(cluster().run("ALTER DATABASE postgres RESET default_transaction_read_only"));
  ASSERT_TRUE(cluster().cut_connections());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Io);
  EXPECT_THAT(written.error().message, HasSubstr("is read-only"));
  EXPECT_TRUE(store->write_probe());
}

TEST_F(PostgresStoreTest, ConnectionsHaveTheSettingsOfTheHouse) {
  ASSERT_TRUE(cluster().run("ALTER DATABASE postgres SET synchronous_commit = off"));
  const auto opened = PostgresConnection::open(uri_, "driftlabd");
  ASSERT_TRUE(cluster().run("ALTER DATABASE postgres RESET synchronous_commit"));
  ASSERT_TRUE(opened) << opened.error().message;
  for (const auto& [setting, value] :
       {std::pair{"synchronous_commit", "on"}, std::pair{"statement_timeout", "30s"}, std::pair{"lock_timeout", "10s"},
        std::pair{"idle_in_transaction_session_timeout", "1min"}, std::pair{"client_encoding", "UTF8"},
        std::pair{"application_name", "driftlabd"}}) {
    const auto found = (*opened)->query_text(std::string("SELECT current_setting('") + setting + "')");
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->value_or(""), value) << setting;
  }
}

TEST_F(PostgresStoreTest, AStatementAndALockEndWithTheirTime) {
  const auto connection = PostgresConnection::open(uri_, "first");
  const auto other = PostgresConnection::open(uri_, "other");
  ASSERT_TRUE(connection && other);
  ASSERT_TRUE((*other)->execute("CREATE TABLE held (x INT)"));
  ASSERT_TRUE((*other)->execute("BEGIN; LOCK TABLE held"));
  for (const auto& [limit, statement] : {std::pair{"statement_timeout", "SELECT pg_sleep(60)::TEXT"},
                                         std::pair{"lock_timeout", "SELECT count(*)::TEXT FROM held"}}) {
    ASSERT_TRUE((*connection)->begin(std::string("BEGIN; SET LOCAL ") + limit + " = 50"));
    const auto ended = (*connection)->query_text(statement);
    ASSERT_FALSE(ended) << limit;
    EXPECT_EQ(ended.error().code, ErrorCode::Io);
    EXPECT_THAT(ended.error().message, AllOf(HasSubstr("took too long: canceling statement due to"), EndsWith(".")));
    (*connection)->roll_back();
    EXPECT_FALSE((*connection)->is_broken()) << "it can be used again";
  }
}

// A COMMIT whose wait for the standby is cut short is called done, though the write lies on one server alone.
TEST_F(PostgresStoreTest, AWriteIsAcknowledgedWhenTheSynchronousStandbyHasIt) {
  const auto connection = PostgresConnection::open(uri_, "driftlabd");
  const auto reader = PostgresConnection::open(uri_, "reader");
  ASSERT_TRUE(connection && reader);
  ASSERT_TRUE((*connection)->execute("CREATE TABLE written (x INT)"));
  const auto number = [&](const std::string& sql) { return (*reader)->query_integer(sql).value_or(std::nullopt); };
  const auto backend = (*connection)->query_integer("SELECT pg_backend_pid()");
  ASSERT_TRUE(backend && *backend);
  const std::string waiting =
      "SELECT count(*) FROM pg_stat_activity WHERE wait_event = 'SyncRep' AND pid = " + std::to_string(**backend);
  ASSERT_TRUE(cluster().run("ALTER SYSTEM SET synchronous_standby_names = 'nobody'"));
  ASSERT_TRUE(cluster().run("SELECT pg_reload_conf()"));

  // Commits wait once the server's checkpointer has read the setting, which a session may show earlier.
  Status committed;
  std::atomic<bool> ended{true};
  std::thread writer;
  int commits = 0;
  for (; ended; ++commits) {
    if (writer.joinable()) {
      writer.join();
    }
    ASSERT_LT(commits, 100'000) << "no commit waits";
    ASSERT_TRUE((*connection)->begin("BEGIN; SET LOCAL statement_timeout = 100"));
    ASSERT_TRUE((*connection)->execute("INSERT INTO written VALUES (1)"));
    ended = false;
    writer = std::thread([&] {
      committed = (*connection)->commit();
      ended = true;
    });
    while (!ended && number(waiting) != 1) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(600));  // six times the limit of the statement
  EXPECT_FALSE(ended);
  EXPECT_EQ(number("SELECT count(*) FROM written"), commits - 1) << "nobody reads the last one yet";
  EXPECT_TRUE(cluster().run("ALTER SYSTEM RESET synchronous_standby_names"));
  EXPECT_TRUE(cluster().run("SELECT pg_reload_conf()"));
  writer.join();
  EXPECT_TRUE(committed);
  EXPECT_EQ(number("SELECT count(*) FROM written"), commits);
  EXPECT_EQ((*connection)->query_text("SHOW statement_timeout").value_or(""), "30s");
}

/// When a pool of this seed asks a database that does not answer, in milliseconds after its first attempt.
std::vector<double> attempts_within(std::chrono::milliseconds time, std::uint64_t seed) {
  using Clock = std::chrono::steady_clock;
  std::vector<Clock::time_point> at;
  ConnectionPool pool(
      [&]() -> Result<std::unique_ptr<PostgresConnection>> {
        at.push_back(Clock::now());
        return fail(ErrorCode::Io, "It does not answer.");
      },
      1, seed);
  for (const auto until = Clock::now() + time; Clock::now() < until; std::this_thread::yield()) {
    EXPECT_FALSE(pool.take());
  }
  std::vector<double> after;
  for (const auto& moment : at) {
    after.push_back(std::chrono::duration<double, std::milli>(moment - at.front()).count());
  }
  return after;
}

TEST(PostgresPool, AsksASilentDatabaseAgainAfterPausesThatGrowAndThatDifferBetweenDaemons) {
  const std::chrono::milliseconds time(1600);
  const std::vector<double> one = attempts_within(time, 1);
  const std::vector<double> other = attempts_within(time, 2);
  for (const std::vector<double>& at : {one, other}) {
    // Pauses of at most 100, 200, 400 and 800 ms, each at least its half: four or five attempts begin in 1.6 s.
    ASSERT_THAT(at.size(), testing::AllOf(testing::Ge(4U), testing::Le(6U)));
    for (std::size_t i = 1; i < at.size(); ++i) {
      EXPECT_GE(at[i] - at[i - 1], 50.0 * static_cast<double>(1U << (i - 1)) - 1.0) << i;
    }
  }
  EXPECT_GT(std::abs(one[1] - other[1]), 1.0) << "they do not come back together";
}

TEST_F(PostgresStoreTest, AnotherSchemaIsRefusedAtStartAndWhileItRuns) {
  const auto store = open();
  ASSERT_TRUE(store->ping());
  ASSERT_TRUE(cluster().run("INSERT INTO " + schema_ + ".schema_migrations VALUES (999, 'later', 'x', 0)"));
  const auto told = store->ping();
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().message, HasSubstr("has schema 999 by now"));
  const Error newer = refusal(uri_);
  EXPECT_EQ(newer.code, ErrorCode::Conflict);
  EXPECT_THAT(newer.message, HasSubstr("999"));
  ASSERT_TRUE(cluster().run("DELETE FROM " + schema_ + ".schema_migrations WHERE number = 999; UPDATE " + schema_ +
                            ".schema_migrations SET sha256 = 'x' WHERE number = 3"));
  EXPECT_THAT(refusal(uri_).message, HasSubstr("Migration 3"));
}

std::vector<Migration> next_release(const std::string& sql) {
  std::vector<Migration> migrations = embedded_postgres_migrations();
  migrations.push_back({static_cast<int>(migrations.size()) + 1, "next", sql});
  return migrations;
}

std::string beside_this_one() {
  return "-- Programs of schema " + std::to_string(embedded_postgres_migrations().size()) +
         " and later may work beside it.\n";
}

TEST_F(PostgresStoreTest, AmountsOfAnEarlierReleaseAreCountedAndASweepLeavesOneRowOfEach) {
  Device device;
  {
    PostgresOptions then;
    const std::vector<Migration>& all = embedded_postgres_migrations();
    then.migrations = std::vector<Migration>(all.begin(), all.begin() + 27);
    const auto older = open(then);
    ASSERT_NE(older, nullptr);
    const Caller caller = add_caller(*older, "tokenone");
    const ActingFor acting(caller);
    device = add_device(*older);
    add_recording(*older, device, "first");
    add_recording(*older, device, "second");
  }
  const auto store = open();
  ASSERT_NE(store, nullptr);
  const auto kept = [&](std::int64_t recordings) {
    EXPECT_EQ(store->counts(std::nullopt)->devices, 1);
    EXPECT_EQ(store->counts(std::nullopt)->recordings, recordings);
    EXPECT_EQ(store->usage_of(device.id, "")->recordings, recordings);
    EXPECT_EQ(store->usage_of_token("tokenone", "")->recordings, 2);
    EXPECT_EQ(store->blob_bytes().value(), 1000 * recordings);
  };
  kept(2);
  const auto connection = PostgresConnection::open(uri_, "reader");
  ASSERT_TRUE(connection);
  const auto number = [&](const std::string& sql) { return (*connection)->query_integer(sql).value_or(std::nullopt); };
  EXPECT_EQ(number("SELECT count(*) FROM stored_amounts WHERE NOT settled"), 0);
  add_recording(*store, device, "third");
  EXPECT_EQ(number("SELECT count(*) FROM stored_amounts WHERE NOT settled"), 3) << "of the device, of all, of blobs";
  kept(3);
  ASSERT_TRUE(store->settle_recordings());
  EXPECT_EQ(number("SELECT count(*) FROM stored_amounts WHERE NOT settled"), 0);
  EXPECT_EQ(number("SELECT count(*) FROM stored_amounts"), 5) << "of the token and of devices besides";
  kept(3);
}

TEST_F(PostgresStoreTest, AnOlderProgramWorksBesideAMigrationThatSaysSo) {
  const auto older = open();
  const Device device = add_device(*older);
  EXPECT_EQ(older->newer_schema(), "");
  PostgresOptions next;
  next.migrations = next_release(beside_this_one() + "ALTER TABLE devices ADD COLUMN shelf TEXT NOT NULL DEFAULT ''");
  const auto newer = open(next);
  ASSERT_NE(newer, nullptr);
  EXPECT_EQ(newer->newer_schema(), "");
  EXPECT_TRUE(older->ping());
  EXPECT_THAT(older->newer_schema(), HasSubstr("of a newer driftlab; this one works beside it"));
  EXPECT_TRUE(newer->device(add_device(*older, "of the older").id));
  EXPECT_TRUE(older->device(add_device(*newer, "of the newer").id));
  const auto another = open();
  ASSERT_NE(another, nullptr) << "one of the older is started";
  EXPECT_EQ(another->facts().schema, newer->facts().schema);
  EXPECT_NE(another->newer_schema(), "");
  EXPECT_TRUE(another->device(device.id));
}

TEST_F(PostgresStoreTest, AMigrationThatEndsWhoIsThereWaitsUntilNobodyIs) {
  PostgresOptions together;
  together.lock = DaemonLock::Kind::Together;
  PostgresOptions next = together;
  next.migrations = next_release("-- No older program may work beside it.\nALTER TABLE devices ADD COLUMN shelf TEXT");
  {
    const auto older = open(together);
    ASSERT_TRUE(older->coordination()->admit_others());
    const auto refused = open_postgres_store(uri_, next);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
    EXPECT_THAT(refused.error().message,
                AllOf(HasSubstr("stop all of them before this driftlab starts"), EndsWith(".")));
    EXPECT_TRUE(older->ping());
  }
  {
    const auto newer = open(next);
    ASSERT_NE(newer, nullptr);
  }
  EXPECT_THAT(refusal(uri_).message, HasSubstr("use the newer driftlab that wrote it"));
}

TEST_F(PostgresStoreTest, WhoMayNotWorkWithTheDatabaseAnyMoreWritesNothing) {
  const auto older = open();
  const Device device = add_device(*older);
  PostgresOptions next;
  next.migrations = next_release("ALTER TABLE devices ADD COLUMN shelf TEXT");
  const auto newer = open(next);
  ASSERT_NE(newer, nullptr);
  EXPECT_FALSE(older->ping());
  const auto written = older->write_probe();
  ASSERT_FALSE(written) << "connections from before are used no more";
  EXPECT_THAT(written.error().message, HasSubstr("by now, and this driftlab works with"));
  EXPECT_FALSE(older->device(device.id));
  EXPECT_TRUE(newer->device(device.id));
}

TEST_F(PostgresStoreTest, AMigrationThatFailsLeavesTheDatabaseAsItWas) {
  PostgresOptions options;
  options.migrations = embedded_postgres_migrations();
  const int last = options.migrations->back().number;
  options.migrations->push_back({last + 1, "broken", "CREATE TABLE half (a BIGINT); SELECT * FROM nowhere"});
  const auto broken = open_postgres_store(uri_, options);
  ASSERT_FALSE(broken);
  EXPECT_THAT(broken.error().message, HasSubstr("Migration " + std::to_string(last + 1) + " (broken) failed."));
  EXPECT_EQ(open()->facts().schema_before, 0);
  options.migrations->back().sql = "CREATE TABLE whole (a BIGINT)";
  const auto mended = open_postgres_store(uri_, options);
  ASSERT_TRUE(mended) << mended.error().message;
  EXPECT_EQ((*mended)->facts().schema_before, last);
  EXPECT_EQ((*mended)->facts().schema, last + 1);
}

TEST_F(PostgresStoreTest, WhatCannotBeOpenedIsRefused) {
  EXPECT_EQ(refusal("postgresql://x/?password=secret&nosuch=1").code, ErrorCode::InvalidArgument);
  EXPECT_EQ(refusal("postgresql://127.0.0.1:1/driftlab").code, ErrorCode::Io);
  EXPECT_THAT(refusal(cluster().uri(schema_, "nobody")).message, HasSubstr("nobody"));
  EXPECT_THAT(refusal(cluster().uri("nowhere")).message, HasSubstr("no schema to make tables in"));
  ASSERT_TRUE(cluster().run("CREATE TABLE " + schema_ + ".theirs (a INT)"));
  EXPECT_THAT(refusal(uri_).message, HasSubstr("holds tables that driftlab did not make"));
}

TEST_F(PostgresStoreTest, AUserWithoutRightsIsToldSo) {
  ASSERT_TRUE(cluster().run("CREATE ROLE guest LOGIN; GRANT USAGE ON SCHEMA " + schema_ + " TO guest"));
  const Error refused = refusal(cluster().uri(schema_, "guest"));
  EXPECT_EQ(refused.code, ErrorCode::Io);
  EXPECT_THAT(refused.message, HasSubstr("does not let its user do that"));
  ASSERT_TRUE(cluster().run("REVOKE ALL ON SCHEMA " + schema_ + " FROM guest; DROP ROLE guest"));
}

TEST_F(PostgresStoreTest, LabelsOfDocumentsThatAreNoneAreNone) {
  const auto store = open();
  const Device device = add_device(*store);
  Recording recording = add_recording(*store, device);
  recording.tags_json = R"({"labels":{"board":"b\u0000"}})";
  ASSERT_TRUE(store->revise_recording(recording, 1));
  RecordingFilter filter;
  filter.labels = {"board=b"};
  const auto found = store->recordings(filter, {});
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->empty());
  ASSERT_TRUE(store->enqueue({"x", "key", R"({"inputs":{"device":"d\u0000"}})"}));
  JobFilter jobs;
  jobs.input_device = device.id;
  EXPECT_TRUE(store->jobs(jobs, {})->empty());
}

TEST(PostgresText, EveryTextComesBackAndPlainOnesStayAsTheyAre) {
  for (const char* const plain : {"", "static", "Z\xC3\xBCrich \xF0\x9F\x93\xB1", "tab\tand\nline", "\x7F"}) {
    EXPECT_EQ(encode_text(plain), plain);
  }
  std::string text;
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; ++second) {
      text = {static_cast<char>(first), static_cast<char>(second), 'x'};
      const std::string code = encode_text(text);
      ASSERT_EQ(decode_text(code), text);
      ASSERT_EQ(code.find('\0'), std::string::npos);
      ASSERT_EQ(encode_text(code) == code, code.find('\x01') == std::string::npos);
    }
  }
  for (const char* const faulty : {"\xED\xA0\x80", "\xF4\x90\x80\x80", "\xC0\xAF", "\xE2\x82", "\xF0\x80\x80\x80"}) {
    EXPECT_NE(encode_text(faulty), faulty);
    EXPECT_EQ(decode_text(encode_text(faulty)), faulty);
  }
}

TEST(PostgresText, ParametersAreNumbered) {
  EXPECT_EQ(numbered_parameters("a = ? AND b = ?"), "a = $1 AND b = $2");
  EXPECT_EQ(numbered_parameters("a = ?2 AND b = ?1 + ?2"), "a = $2 AND b = $1 + $2");
  EXPECT_EQ(numbered_parameters("a = '?' || ?"), "a = '?' || $1");
}

TEST(PostgresMigrations, HaveTheNumbersAndNamesOfThoseOfSqlite) {
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the environment is read before anything starts
  const char* const root = std::getenv("DRIFTLAB_SOURCE");
  ASSERT_NE(root, nullptr);
  const std::filesystem::path folder = std::filesystem::path(root) / "migrations";
  const auto names = [&](const char* engine) {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / engine)) {
      found.insert(entry.path().filename().string());
    }
    return found;
  };
  EXPECT_EQ(names("postgres"), names("sqlite"));
}

}  // namespace
}  // namespace driftlab::server
