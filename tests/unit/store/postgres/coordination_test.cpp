/// What several processes on one database owe each other: who came first, duties, keys, hints.
#include "server/store/coordination.hpp"

#include "server/store/access_store.hpp"
#include "server/store/postgres/postgres_store.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace driftlab::server {
namespace {

using namespace std::chrono_literals;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// Collects what one process hears of the others.
class Ear {
 public:
  Hints hints() {
    Hints hints;
    hints.job = [this](const std::string& id, std::string_view what) { add("job " + id + " " + std::string(what)); };
    hints.words = [this](const std::string& words) { add("words " + words); };
    hints.access = [this] { add("access"); };
    hints.lost = [this] { add("lost"); };
    return hints;
  }
  bool hears(const std::string& words) {
    std::unique_lock lock(mutex_);
    return added_.wait_for(lock, 20s, [&] { return std::find(heard_.begin(), heard_.end(), words) != heard_.end(); });
  }
  std::vector<std::string> heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  void add(std::string words) {
    {
      const std::lock_guard lock(mutex_);
      heard_.push_back(std::move(words));
    }
    added_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable added_;
  std::vector<std::string> heard_;
};

class PostgresCoordinationTest : public testing::Test {
 protected:
  void SetUp() override {
    if (PostgresCluster::programs().empty()) {
      GTEST_SKIP() << "POSTGRESQL NOT TESTED: there is no PostgreSQL 15 in /usr/lib/postgresql.";
    }
    uri_ = PostgresCluster::of_this_process().schema(schema_for(directory_.path()));
  }
  [[nodiscard]] std::unique_ptr<PostgresStore> open(DaemonLock::Kind kind = DaemonLock::Kind::Together) const {
    PostgresOptions options;
    options.lock = kind;
    auto opened = open_postgres_store(uri_, std::move(options));
    EXPECT_TRUE(opened) << opened.error().message;
    return opened ? std::move(*opened) : nullptr;
  }
  /// The first of several, with the door open.
  [[nodiscard]] std::unique_ptr<PostgresStore> open_first() const {
    auto first = open();
    EXPECT_TRUE(first->coordination()->admit_others());
    return first;
  }

  TemporaryDirectory directory_;
  std::string uri_;
};

TEST_F(PostgresCoordinationTest, NobodyComesBeforeTheFirstHasPutTheStoreInOrder) {
  const auto first = open();
  ASSERT_TRUE(first->coordination()->came_first());
  std::unique_ptr<PostgresStore> second;
  std::thread coming([&] { second = open(); });
  std::this_thread::sleep_for(300ms);
  EXPECT_EQ(second, nullptr);
  ASSERT_TRUE(first->coordination()->admit_others());
  coming.join();
  ASSERT_NE(second, nullptr);
  EXPECT_FALSE(second->coordination()->came_first());
  EXPECT_TRUE(first->ping());
  EXPECT_TRUE(second->ping());
  ASSERT_TRUE(PostgresCluster::of_this_process().cut_connections());
  EXPECT_TRUE(first->ping()) << "the lock is taken again, together";
  EXPECT_TRUE(second->ping());
}

TEST_F(PostgresCoordinationTest, WhoeverKeepsRecordingsForItselfIsAlone) {
  {
    const auto together = open_first();
    PostgresOptions alone;
    alone.lock = DaemonLock::Kind::Alone;
    const auto refused = open_postgres_store(uri_, alone);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::Conflict);
    EXPECT_THAT(refused.error().message, HasSubstr("--blobs"));
  }
  const auto alone = open(DaemonLock::Kind::Alone);
  EXPECT_EQ(alone->coordination(), nullptr);
}

TEST_F(PostgresCoordinationTest, ADutyIsOnesUntilItIsGone) {
  auto first = open_first();
  const auto second = open();
  EXPECT_TRUE(first->coordination()->has_duty(Duty::Maintenance));
  EXPECT_TRUE(first->coordination()->has_duty(Duty::Maintenance)) << "and stays its";
  EXPECT_FALSE(second->coordination()->has_duty(Duty::Maintenance));
  EXPECT_TRUE(second->coordination()->has_duty(Duty::Deliveries)) << "each duty is given by itself";
  EXPECT_FALSE(first->coordination()->has_duty(Duty::Deliveries));
  first.reset();
  const auto until = std::chrono::steady_clock::now() + 20s;
  while (!second->coordination()->has_duty(Duty::Maintenance) && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_TRUE(second->coordination()->has_duty(Duty::Maintenance));
}

TEST_F(PostgresCoordinationTest, AKeyIsOnesUntilItIsGivenBackAndWhereItsConnectionBreaks) {
  const auto first = open_first();
  const auto second = open();
  EXPECT_TRUE(*first->coordination()->take_key("k"));
  EXPECT_FALSE(*second->coordination()->take_key("k"));
  EXPECT_TRUE(*second->coordination()->take_key("other"));
  ASSERT_TRUE(PostgresCluster::of_this_process().cut_connections());
  EXPECT_TRUE(*first->coordination()->take_key("third")) << "on a new connection, with the keys of the old one";
  EXPECT_FALSE(*second->coordination()->take_key("k"));
  first->coordination()->give_back_key("k");
  EXPECT_TRUE(*second->coordination()->take_key("k"));
}

TEST_F(PostgresCoordinationTest, AllWorkersAreThoseOfTheProcessesThatAreThere) {
  const auto first = open_first();
  first->coordination()->offer_workers(2);
  EXPECT_EQ(*first->coordination()->workers(), 2);
  auto second = open();
  second->coordination()->offer_workers(3);
  EXPECT_EQ(*first->coordination()->workers(), 5);
  EXPECT_EQ(*second->coordination()->workers(), 5);
  EXPECT_TRUE(*first->coordination()->take_key("k")) << "which is no worker";
  ASSERT_TRUE(PostgresCluster::of_this_process().cut_connections());
  const auto all = [&] { return first->coordination()->workers().value_or(-1); };
  const auto second_is_back = second->coordination()->workers();
  ASSERT_TRUE(second_is_back) << second_is_back.error().message;
  EXPECT_EQ(all(), 5) << "held again by connections that were made anew";
  second.reset();
  const auto until = std::chrono::steady_clock::now() + 20s;
  while (all() != 2 && std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(all(), 2);
}

TEST_F(PostgresCoordinationTest, TheOthersHearOfJobsTokensAndWords) {
  Ear of_first;  // outlives who tells it
  Ear of_second;
  const auto first = open_first();
  const auto second = open();
  first->coordination()->listen(of_first.hints());
  second->coordination()->listen(of_second.hints());
  // A connection that listens hears what is committed later: words are told until they are heard.
  const auto until = std::chrono::steady_clock::now() + 20s;
  while (of_second.heard().empty() && std::chrono::steady_clock::now() < until) {
    first->coordination()->tell("begun");
    std::this_thread::sleep_for(20ms);
  }
  add_job(*first, "key");
  const Job job = claim_one(*first);
  ASSERT_TRUE(first->report_progress(lease_of(job), "fit", 0.5));
  ASSERT_TRUE(first->request_cancel(job.id));
  ASSERT_TRUE(first->acknowledge_cancel(lease_of(job)));
  first->coordination()->tell("devices device.created {\"name\":\"\xC3\xA4\"}");
  for (const char* what : {"queued", "running", "progress", "cancel", "cancelled"}) {
    EXPECT_TRUE(of_second.hears("job " + job.id + " " + what)) << what;
  }
  EXPECT_TRUE(of_second.hears("words devices device.created {\"name\":\"\xC3\xA4\"}"));
  first->coordination()->tell(std::string(9000, 'x'));
  EXPECT_TRUE(of_second.hears("lost")) << "what is too long for a notification";
  EXPECT_THAT(of_first.heard(), Not(Contains(HasSubstr("job ")))) << "nobody is told what it did itself";
}

TEST_F(PostgresCoordinationTest, AListenerThatWasCutOffSaysSo) {
  Ear ear;
  const auto store = open_first();
  store->coordination()->listen(ear.hints());
  EXPECT_TRUE(ear.hears("access")) << "also without a hint, every two seconds";
  ASSERT_TRUE(PostgresCluster::of_this_process().cut_connections());
  EXPECT_TRUE(ear.hears("lost"));
}

}  // namespace
}  // namespace driftlab::server
