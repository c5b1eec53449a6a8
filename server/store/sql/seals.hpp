#pragma once
/// Seals: checksums by which a row is known to be what was written.
///
/// A row of a sealed table has the SHA-256 of its sealed columns in its column `seal`, written by the statement that
/// writes them and compared whenever the row is read, in the background (server/scrubber.hpp) and by `driftlabd check`.
/// Sealed is what results are made of and answers say, what lets somebody in, and whom the daemon tells. Times, states
/// and counters are not: they change by statements of their own, and no result depends on them. Those of a job change
/// no more once it has ended: they and its problem then have a seal of their own, `end_seal`. An empty seal is that of
/// a row of an earlier release; a daemon fills it in when it starts.
#include "core/signal/result.hpp"
#include "server/store/damaged_row.hpp"
#include "server/store/rows.hpp"
#include "server/store/sql/connection.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server {

struct SealedTable {
  std::string_view name;
  std::string_view noun;              ///< what an error calls one of its rows
  std::vector<std::string_view> key;  ///< its columns, as texts; rows are read back in their order
  std::string_view columns;           ///< sealed, in the order of the seal
  std::string_view seal = "seal";     ///< the column that has it
  std::string_view when = "true";     ///< which rows have one
};

/// Every sealed table; one whose rows have two seals is there twice.
[[nodiscard]] const std::vector<SealedTable>& sealed_tables();
/// The first of this name, which must be one of them.
[[nodiscard]] const SealedTable& sealed_table(std::string_view name);

// ---- the seal of a row as the store holds it
[[nodiscard]] std::string seal_of(const Device& device);
[[nodiscard]] std::string seal_of(const Blob& blob);
[[nodiscard]] std::string seal_of(const Recording& recording);
[[nodiscard]] std::string seal_of(const Job& job);
/// Of what a job says that has ended.
[[nodiscard]] std::string end_seal_of(const Job& job);
[[nodiscard]] std::string seal_of(const ChannelResult& channel);
[[nodiscard]] std::string seal_of(const Fit& fit);
[[nodiscard]] std::string seal_of(const Study& study);
[[nodiscard]] std::string seal_of(const StoredDrive& drive);
[[nodiscard]] std::string seal_of(const StoredCalibration& calibration);
[[nodiscard]] std::string seal_of(const Model& model);
[[nodiscard]] std::string seal_of(const Investigation& investigation);
[[nodiscard]] std::string seal_of(const ResultVerdict& verdict);
[[nodiscard]] std::string seal_of(const Anchor& anchor);
[[nodiscard]] std::string seal_of(const IdempotentReply& reply);
/// Of the sealed columns as texts, which is how job_attempts, job_results, artefacts, tokens and webhooks are sealed.
[[nodiscard]] std::string seal_of_texts(const std::vector<std::string_view>& texts);

/// Whether a seal fits. One that was never made fits everything.
[[nodiscard]] inline bool seal_fits(const std::string& seal, const std::string& made_now) {
  return seal.empty() || seal == made_now;
}

/// The error of a damaged row of that table; `key` names it.
[[nodiscard]] Error damaged_in(std::string_view table, std::string_view key);

/// The row of that table, if its seal fits; `key` names it. Error: damaged_row.
template <class Row>
[[nodiscard]] Result<Row> sound_row(std::string_view table, const std::string& key, Row row, const std::string& seal) {
  if (!seal_fits(seal, seal_of(row))) {
    return fail(damaged_in(table, key));
  }
  return row;
}

/// The last of the texts of a row that has nothing else, likewise.
[[nodiscard]] Result<std::string> sound_text(std::string_view table, std::vector<std::string> texts,
                                             const std::string& seal);

/// Rows that were read back.
struct ReadBack {
  std::vector<std::string> damaged;  ///< as `table/key`
  std::vector<std::string> last;     ///< the key of the last one; empty: there is no row behind `after`
  std::int64_t rows = 0;
  std::int64_t bytes = 0;
};

/// Reads `limit` rows of a table behind the key `after` (empty: from the first one) and compares them with their seals.
[[nodiscard]] Result<ReadBack> read_back(Connection& connection, const SealedTable& table,
                                         const std::vector<std::string>& after, int limit);

/// Whether the row named `table/key` is damaged as it now is; one that is gone is not. Nothing where the name is not
/// that of one sealed row, as of a key with a `/` in it.
[[nodiscard]] Result<std::optional<bool>> is_damaged(Connection& connection, std::string_view row);

/// Seals `limit` rows of a table that have no seal. How many there were.
[[nodiscard]] Result<int> seal_rows(Connection& connection, const SealedTable& table, int limit);

/// Runs a change that leaves its rows, a thousand at most, without a seal, and seals them.
[[nodiscard]] Status run_and_seal(Connection& connection, std::string_view table, Statement& change);

}  // namespace driftlab::server
