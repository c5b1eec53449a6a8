#pragma once
/// A few read-only connections that threads borrow. They cannot write and cannot checkpoint.
#include "core/signal/result.hpp"
#include "server/store/sqlite/connection.hpp"

#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace driftlab::server {

class ReaderPool {
 public:
  /// Errors: Io.
  [[nodiscard]] static Result<std::unique_ptr<ReaderPool>> open(const std::filesystem::path& path, int readers);

  /// Runs `work(connection)`, which returns a `Result`, over one snapshot of the database. Blocks until a reader is
  /// free. Thread safe; not to be called from within `work`.
  template <class Work>
  [[nodiscard]] auto read(Work work) {
    using Outcome = std::invoke_result_t<Work, SqliteConnection&>;
    const Loan loan(*this);
    if (Status begun = loan->prepare("BEGIN").run(); !begun) {
      return Outcome(fail(std::move(begun.error())));
    }
    Outcome outcome = work(*loan);
    const Status ended = loan->prepare("COMMIT").run();
    if (!ended && loan->in_transaction()) {
      (void)loan->prepare("ROLLBACK").run();
    }
    return outcome;
  }

  /// The same without a transaction, for VACUUM INTO.
  template <class Work>
  [[nodiscard]] auto borrow(Work work) {
    const Loan loan(*this);
    return work(*loan);
  }

 private:
  class Loan {
   public:
    explicit Loan(ReaderPool& pool) : pool_(pool), connection_(pool.take()) {}
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    ~Loan() { pool_.give_back(std::move(connection_)); }
    [[nodiscard]] SqliteConnection* operator->() const { return connection_.get(); }
    [[nodiscard]] SqliteConnection& operator*() const { return *connection_; }

   private:
    ReaderPool& pool_;
    std::unique_ptr<SqliteConnection> connection_;
  };

  [[nodiscard]] std::unique_ptr<SqliteConnection> take();
  void give_back(std::unique_ptr<SqliteConnection> connection);

  std::mutex mutex_;
  std::condition_variable returned_;
  std::vector<std::unique_ptr<SqliteConnection>> idle_;
};

}  // namespace driftlab::server
