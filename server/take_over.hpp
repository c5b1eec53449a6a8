#pragma once
/// The start of a process: puts the store in order before any work begins.
#include "core/signal/result.hpp"
#include "server/auth/gate.hpp"
#include "server/settings.hpp"
#include "server/store/coordination.hpp"
#include "server/store/sql/sql_store.hpp"

namespace driftlab::server {

/// Charges the faults of an earlier daemon to the jobs it ran, ends the leases of processes that died, lets other
/// processes in, seals the rows and queues the poolings that an earlier release left out. `others` is nullptr where
/// this process has the store alone. Errors: those of the store and of the file of faults.
[[nodiscard]] Status take_over(SqlStore& store, Coordination* others, const Settings& settings);

/// Reads the tokens; makes the first one, in a file that its owner alone can read, where tokens are required and there
/// is none.
[[nodiscard]] Status open_gate(Gate& gate, const Settings& settings);

}  // namespace driftlab::server
