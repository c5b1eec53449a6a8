#pragma once
/// Every advisory lock that driftlab takes in a PostgreSQL database. Numbers begin with "drft" (0x64726674), and
/// further ones count up, so that other users of the database are not met by chance. Those of a schema carry its name's
/// hash.
#include <array>
#include <string_view>

namespace driftlab::server::advisory_locks {

/// Migrations wait for each other, in every schema; until the transaction ends.
inline constexpr std::string_view kBeginMigration =
    "BEGIN ISOLATION LEVEL READ COMMITTED; SET LOCAL statement_timeout = 0; SET LOCAL lock_timeout = 0; SELECT "
    "pg_advisory_xact_lock(1685218932)";

/// The right to work with a schema: alone, or together with others (DaemonLock).
inline constexpr std::string_view kTakeAlone =
    "SELECT pg_try_advisory_lock(1685218932, hashtext(current_schema()))::INT";
inline constexpr std::string_view kTakeTogether =
    "SELECT pg_try_advisory_lock_shared(1685218932, hashtext(current_schema()))::INT";
inline constexpr std::string_view kEndAlone = "SELECT pg_advisory_unlock(1685218932, hashtext(current_schema()))::INT";

/// Duties that one of several daemons has, in the order of Duty.
inline constexpr std::array<std::string_view, 3> kTakeDuty = {
    "SELECT pg_try_advisory_lock(1685218933, hashtext(current_schema()))::INT",
    "SELECT pg_try_advisory_lock(1685218934, hashtext(current_schema()))::INT",
    "SELECT pg_try_advisory_lock(1685218935, hashtext(current_schema()))::INT"};

/// The workers of a process: each holds one of the numbers from 1685218936 on, the first of them the first, together
/// with others. All rows of these locks are all workers. ?1 how many.
inline constexpr std::string_view kTakeWorkers =
    "SELECT count(pg_try_advisory_lock_shared(1685218936 + i, hashtext(current_schema())))::INT FROM "
    "generate_series(0, "
    "CAST(?1 AS INT) - 1) AS i";
inline constexpr std::string_view kCountWorkers =
    "SELECT count(*)::INT FROM pg_locks WHERE locktype = 'advisory' AND granted AND objsubid = 2 AND database = "
    "(SELECT "
    "oid FROM pg_database WHERE datname = current_database()) AND classid::BIGINT BETWEEN 1685218936 AND 1685219191 "
    "AND "
    "objid::BIGINT = hashtext(current_schema())::BIGINT & 4294967295";

/// Idempotency keys under way; one number of 64 bits each, ?1 the key.
inline constexpr std::string_view kTakeKey =
    "SELECT pg_try_advisory_lock(hashtextextended(current_schema() || ' ' || ?1, 1685218932))::INT";
inline constexpr std::string_view kGiveBackKey =
    "SELECT pg_advisory_unlock(hashtextextended(current_schema() || ' ' || ?1, 1685218932))::INT";

/// What is removed of a blob that lies in an object storage, and what an upload finds there; ?1 its hash.
inline constexpr std::string_view kTakeBlob =
    "SELECT pg_advisory_xact_lock(hashtextextended(current_schema() || ' blob ' || ?1, 1685218932))::TEXT";

}  // namespace driftlab::server::advisory_locks
