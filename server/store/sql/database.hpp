#pragma once
/// Transactions of a database engine: where the store hands its work.
#include "core/signal/result.hpp"
#include "server/store/clock.hpp"
#include "server/store/damaged_row.hpp"
#include "server/store/sql/connection.hpp"
#include "server/store/sql/write_times.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

namespace driftlab::server {

/// What a write needs of its transaction beside being whole and durable.
enum class WriteKind {
  Serial,   ///< reads what it decides by: as if no other write ran meanwhile
  Audited,  ///< the same, and adds to the audit log: such writes come one after the other
  Fenced,   ///< each statement decides by the row that it changes
};

using DamageListener = std::function<void(const Error& error)>;

class Database {
 public:
  Database() = default;
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;
  virtual ~Database() = default;

  /// Runs `work(connection)`, which returns a `Result`, in a transaction and returns its outcome once that is durable.
  /// The work may run several times; what it did before is undone then. Thread safe; not to be called from within
  /// `work`.
  template <class Work>
  [[nodiscard]] auto write(WriteKind kind, Work work) {
    const WriteTimes::Watch watch(write_times_);
    return noted(
        run<Work>([&](const std::function<Status(Connection&)>& told) { return run_write(kind, told); }, work));
  }

  /// Runs `work(connection)`, which returns a `Result`, over one snapshot of the database. Thread safe; not to be
  /// called from within `work`.
  template <class Work>
  [[nodiscard]] auto read(Work work) {
    return noted(run<Work>([&](const std::function<Status(Connection&)>& told) { return run_read(told); }, work));
  }

  /// The time of the transaction that the connection is in.
  [[nodiscard]] virtual UtcMicros now(const Connection& connection) const = 0;
  /// `listener` is told of every row that was found damaged, by the error that names it (damaged_row.hpp). To be called
  /// before the first transaction of others.
  void tell_damage_to(DamageListener listener) { damage_listener_ = std::move(listener); }

  /// Tells the listener of a damaged row that is no failure to whoever read it.
  void tell_damage(const Error& error) const {
    if (damage_listener_) {
      damage_listener_(error);
    }
  }

  /// Store::changes.
  [[nodiscard]] virtual std::uint64_t changes() const = 0;
  [[nodiscard]] WriteTimes::Counts write_times() const { return write_times_.counts(); }
  /// Pages of the write-ahead log as it lies on this machine's disk; nothing where it is elsewhere.
  [[nodiscard]] virtual std::optional<std::int64_t> log_pages() const { return std::nullopt; }

 protected:
  [[nodiscard]] virtual Status run_write(WriteKind kind, const std::function<Status(Connection&)>& work) = 0;
  [[nodiscard]] virtual Status run_read(const std::function<Status(Connection&)>& work) = 0;

 private:
  WriteTimes write_times_;
  DamageListener damage_listener_;

  template <class Outcome>
  [[nodiscard]] Outcome noted(Outcome outcome) const {
    if (!outcome && !damaged_row_of(outcome.error()).empty()) {
      tell_damage(outcome.error());
    }
    return outcome;
  }

  template <class Work, class Runner>
  [[nodiscard]] static auto run(const Runner& runner, Work& work) {
    using Outcome = std::invoke_result_t<Work&, Connection&>;
    Outcome outcome = fail(ErrorCode::Internal, "The transaction did not run.");
    Status ended = runner([&](Connection& connection) -> Status {
      outcome = work(connection);
      return outcome ? Status{} : fail(outcome.error());
    });
    return ended ? outcome : Outcome(fail(std::move(ended.error())));
  }
};

}  // namespace driftlab::server
