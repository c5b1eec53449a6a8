/// Statements of a write that give no rows travel together: nothing of what was true one by one changes by it.
#include "server/store/postgres/postgres_store.hpp"
#include "server/store/sql/tables.hpp"
#include "tests/unit/store/postgres/cluster.hpp"
#include "tests/unit/store/postgres/open.hpp"
#include "tests/unit/store/world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

namespace driftlab::server {
namespace {

using testing::HasSubstr;

constexpr std::string_view kAdd = "INSERT INTO kept (number, content) VALUES (?, ?)";
constexpr std::string_view kCount = "SELECT count(*) FROM kept";
/// Ends the connection that it runs on.
constexpr std::string_view kBreak = "SELECT CAST(pg_terminate_backend(pg_backend_pid()) AS TEXT)";

class PostgresPipelineTest : public testing::Test {
 protected:
  void SetUp() override {
    if (PostgresCluster::programs().empty()) {
      GTEST_SKIP() << "POSTGRESQL NOT TESTED: there is no PostgreSQL 15 in /usr/lib/postgresql.";
    }
    schema_ = schema_for(directory_.path());
    uri_ = cluster().schema(schema_);
    store_ = open();
    ASSERT_TRUE(cluster().run("CREATE TABLE " + schema_ +
                              ".kept (position BIGINT GENERATED ALWAYS AS IDENTITY, number BIGINT PRIMARY KEY CHECK "
                              "(number >= 0), content TEXT NOT NULL)"));
  }
  [[nodiscard]] static PostgresCluster& cluster() { return PostgresCluster::of_this_process(); }
  [[nodiscard]] std::unique_ptr<PostgresStore> open() const {
    PostgresOptions options;
    options.jitter_seed = 1;
    options.connections = 1;
    auto opened = open_postgres_store(uri_, std::move(options));
    EXPECT_TRUE(opened) << opened.error().message;
    return opened ? std::move(*opened) : nullptr;
  }
  using Work = std::function<Status(Connection& connection)>;
  Status write(const Work& work, WriteKind kind = WriteKind::Fenced) { return store_->database().write(kind, work); }
  [[nodiscard]] std::int64_t count() {
    return count(store_->database().read([](Connection& connection) { return connection.query_integer(kCount); }));
  }
  [[nodiscard]] static std::int64_t count(const Result<std::optional<std::int64_t>>& read) {
    EXPECT_TRUE(read) << read.error().message;
    return read ? read->value_or(-1) : -1;
  }
  static Status add(Connection& connection, std::int64_t number, std::string_view content = "") {
    return connection.prepare(kAdd).bind(number, content).run();
  }

  TemporaryDirectory directory_;
  std::string schema_;
  std::string uri_;
  std::unique_ptr<PostgresStore> store_;
};

TEST_F(PostgresPipelineTest, StatementsWithoutRowsAreNotWaitedFor) {
  int told_at_once = 0;
  const Status written = write([&](Connection& connection) -> Status {
    for (const std::int64_t number : {1, 1, 2}) {
      told_at_once += add(connection, number) ? 0 : 1;
    }
    return {};
  });
  EXPECT_EQ(told_at_once, 0);
  ASSERT_FALSE(written) << "one of them failed";
  EXPECT_EQ(written.error().code, ErrorCode::Internal);
  EXPECT_THAT(written.error().message, HasSubstr("The database refused a statement: duplicate key value"));
}

TEST_F(PostgresPipelineTest, MoreThanFitsInAnyBufferArrivesInOrder) {
  constexpr std::int64_t kRows = 10'000;
  ASSERT_TRUE(write([&](Connection& connection) {
    Status added;
    for (std::int64_t number = 0; added && number < kRows; ++number) {
      added = add(connection, kRows - number, std::to_string(number) + std::string(200, 'x'));
    }
    return added;
  }));
  const auto read = store_->database().read([](Connection& connection) -> Result<std::vector<std::int64_t>> {
    Statement statement = connection.prepare("SELECT number FROM kept ORDER BY position");
    return tables::all_rows<std::int64_t>(statement, [](const Statement& row) { return row.integer(0); });
  });
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), std::size_t{kRows});
  for (std::size_t i = 0; i < read->size(); ++i) {
    ASSERT_EQ((*read)[i], kRows - static_cast<std::int64_t>(i));
  }
}

TEST_F(PostgresPipelineTest, ValuesOfMegabytesArriveWhole) {
  std::vector<std::string> texts;
  for (int i = 0; i < 9; ++i) {
    texts.emplace_back((1U << 20U) * (i % 3 + 1) + i, static_cast<char>('a' + i));
    texts.emplace_back();  // a short one between them
  }
  ASSERT_TRUE(write([&](Connection& connection) {
    Status added;
    for (std::size_t i = 0; added && i < texts.size(); ++i) {
      added = add(connection, static_cast<std::int64_t>(i), texts[i]);
    }
    return added;
  }));
  const auto read = store_->database().read([](Connection& connection) {
    Statement statement = connection.prepare("SELECT content FROM kept ORDER BY position");
    return tables::all_rows<std::string>(statement, [](const Statement& row) { return row.text(0); });
  });
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_TRUE(*read == texts);
}

// Answers that nobody reads meanwhile fill the server's side while libpq still writes.
TEST_F(PostgresPipelineTest, AnswersThatNobodyAskedForStopNothing) {
  ASSERT_TRUE(write([](Connection& connection) {
    Status done;
    for (int i = 0; done && i < 20; ++i) {
      done = connection.prepare("SELECT repeat('x', 1000000), ?").bind(std::string(100'000, 'y')).run();
      done = done ? add(connection, i) : done;
    }
    return done;
  }));
  EXPECT_EQ(count(), 20);
}

TEST_F(PostgresPipelineTest, AStatementWithRowsSeesWhatCameBefore) {
  ASSERT_TRUE(write([&](Connection& connection) -> Status {
    EXPECT_TRUE(add(connection, 1));
    EXPECT_TRUE(add(connection, 2));
    EXPECT_EQ(count(connection.query_integer(kCount)), 2);
    EXPECT_TRUE(add(connection, 3));
    EXPECT_TRUE(connection.prepare("UPDATE kept SET content = 'x' WHERE number < ?").bind(3).run());
    EXPECT_EQ(connection.changes(), 2);
    EXPECT_TRUE(connection.prepare("DELETE FROM kept WHERE number = ?").bind(3).run());
    EXPECT_EQ(connection.changes(), 1);
    EXPECT_EQ(count(connection.query_integer(kCount)), 2);
    return {};
  }));
  EXPECT_EQ(count(), 2);
}

TEST_F(PostgresPipelineTest, AnErrorInTheMiddleUndoesAllAndIsTheTransactionsOwn) {
  const std::vector<std::pair<const char*, Work>> endings = {
      {"at the end", [](Connection& /*connection*/) { return Status{}; }},
      {"by a statement with rows",
       [](Connection& connection) -> Status {
         const auto read = connection.query_integer(kCount);
         EXPECT_FALSE(read);
         return fail(ErrorCode::NotFound, "The work made something else of it.");
       }},
      {"by changes",
       [](Connection& connection) -> Status {
         EXPECT_EQ(connection.changes(), 0);
         return {};
       }},
      {"and the work went on", [](Connection& connection) -> Status {
         (void)connection.changes();
         return add(connection, 5);
       }}};
  for (const auto& [how, ending] : endings) {
    const Status written = write([&, &end = ending](Connection& connection) -> Status {
      EXPECT_TRUE(add(connection, 1) && add(connection, 2) && add(connection, -1) && add(connection, 3));
      return end(connection);
    });
    ASSERT_FALSE(written) << how;
    EXPECT_EQ(written.error().code, ErrorCode::Internal) << how;
    EXPECT_THAT(written.error().message, HasSubstr("violates check constraint")) << how;
    EXPECT_EQ(count(), 0) << how;
  }
  ASSERT_TRUE(write([](Connection& connection) { return add(connection, 1); })) << "it can be used again";
  EXPECT_EQ(count(), 1);
}

TEST_F(PostgresPipelineTest, WorkThatFailsByItselfStoresNothing) {
  const Status written = write([](Connection& connection) -> Status {
    EXPECT_TRUE(add(connection, 1));
    return fail(ErrorCode::Conflict, "It is not wanted.");
  });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Conflict);
  EXPECT_EQ(count(), 0);
}

TEST_F(PostgresPipelineTest, AStatementThatCannotBePreparedIsTold) {
  const Status written = write([](Connection& connection) -> Status {
    EXPECT_TRUE(add(connection, 1));
    EXPECT_TRUE(connection.prepare("INSERT INTO nowhere VALUES (?)").bind(1).run());
    return add(connection, 2);
  });
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("relation \"nowhere\" does not exist"));
  EXPECT_EQ(count(), 0);
  ASSERT_TRUE(write([](Connection& connection) -> Status {
    EXPECT_TRUE(add(connection, 1));
    return connection.prepare("INSERT INTO kept (content, number) VALUES (?, ?)").bind("", 2).run();
  }));
  EXPECT_EQ(count(), 2);
}

TEST_F(PostgresPipelineTest, AConnectionThatBreaksInTheMiddleIsReplacedUnnoticed) {
  for (const bool by_itself : {true, false}) {
    int runs = 0;
    const std::int64_t before = count();
    const Status written = write([&](Connection& connection) -> Status {
      const bool first = ++runs == 1;
      for (int i = 0; i < 1000; ++i) {
        EXPECT_TRUE(add(connection, before + i) || first);
        if (i == 700 && first && by_itself) {
          EXPECT_TRUE(connection.prepare(kBreak).run());
        } else if (i == 700 && first) {
          EXPECT_TRUE(cluster().cut_connections());
        }
      }
      return {};
    });
    EXPECT_TRUE(written) << written.error().message;
    EXPECT_EQ(runs, 2);
    EXPECT_EQ(count(), before + 1000) << "each once, prepared anew";
  }
}

TEST_F(PostgresPipelineTest, AConnectionThatAlwaysBreaksIsSaid) {
  const Status written = write([&](Connection& connection) -> Status {
    EXPECT_TRUE(add(connection, 1) && connection.prepare(kBreak).run() && add(connection, 2));
    return {};
  });
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::Io);
  EXPECT_THAT(written.error().message, HasSubstr("does not answer: terminating connection"));
  EXPECT_EQ(count(), 0);
}

TEST_F(PostgresPipelineTest, WritesThatMeetAreRunAgain) {
  ASSERT_TRUE(write([](Connection& connection) { return add(connection, 1, "0"); }));
  const auto other = open();
  const auto raise = [](Connection& connection) -> Status {
    const auto read = connection.query_text("SELECT content FROM kept WHERE number = 1");
    EXPECT_TRUE(read);
    const std::string next = std::to_string(std::stoi(read->value_or("0")) + 1);
    return connection.prepare("UPDATE kept SET content = ? WHERE number = 1").bind(next).run();
  };
  int runs = 0;
  const Status written = write(
      [&](Connection& connection) -> Status {
        Status raised = raise(connection);
        if (++runs == 1) {
          EXPECT_TRUE(other->database().write(WriteKind::Serial, raise));
        }
        return raised ? add(connection, 2) : raised;
      },
      WriteKind::Serial);
  EXPECT_TRUE(written) << written.error().message;
  EXPECT_EQ(runs, 2);
  const auto read = store_->database().read(
      [](Connection& connection) { return connection.query_text("SELECT content FROM kept WHERE number = 1"); });
  EXPECT_EQ(read.value_or(std::nullopt), "2");
}

// The end of a read is not waited for: it must come all the same, or the server keeps what nobody needs any more.
TEST_F(PostgresPipelineTest, AReadLeavesNoTransactionOpen) {
  const auto observer = PostgresConnection::open(uri_, "observer");
  ASSERT_TRUE(observer);
  const auto open_transactions = [&] {
    return count((*observer)->query_integer(
        "SELECT count(*) FROM pg_stat_activity WHERE application_name = 'driftlabd' AND xact_start IS NOT NULL"));
  };
  ASSERT_TRUE(store_->database().read([&](Connection& connection) -> Status {
    EXPECT_EQ(count(connection.query_integer(kCount)), 0);
    EXPECT_EQ(open_transactions(), 1);
    return {};
  }));
  EXPECT_FALSE(store_->database().read([](Connection& connection) -> Status {
    EXPECT_EQ(count(connection.query_integer(kCount)), 0);
    return fail(ErrorCode::NotFound, "It is not there.");
  }));
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  while (open_transactions() > 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::yield();
  }
  EXPECT_EQ(open_transactions(), 0);
  ASSERT_TRUE(write([](Connection& connection) { return add(connection, 1); }));
  EXPECT_EQ(count(), 1);
}

TEST_F(PostgresPipelineTest, EachStatementHasItsOwnTimeAndNoMore) {
  const auto slow = [&](const char* seconds) {
    return write([&](Connection& connection) -> Status {
      EXPECT_TRUE(connection.prepare("SET LOCAL statement_timeout = 400").run());
      for (int i = 0; i < 4; ++i) {
        EXPECT_TRUE(add(connection, i));
        EXPECT_TRUE(connection.prepare(std::string("SELECT CAST(pg_sleep(") + seconds + ") AS TEXT)").run());
      }
      return {};
    });
  };
  const Status late = slow("60");
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().code, ErrorCode::Io);
  EXPECT_THAT(late.error().message, HasSubstr("took too long: canceling statement due to statement timeout"));
  EXPECT_EQ(count(), 0);
  const Status together = slow("0.15");  // 0.6 s in all
  EXPECT_TRUE(together) << together.error().message;
  EXPECT_EQ(count(), 4);
}

}  // namespace
}  // namespace driftlab::server
