#pragma once
/// Remembers which job was at work when the process died of a fault of its own (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
/// SIGABRT).
///
/// Such a job would bring the daemon down again after every restart. The handler writes one line, "<job id> <attempt>",
/// to a file opened beforehand; which job is that of the thread that raised the signal, be it a worker or a thread that
/// helps it (a job's threads carry its FaultScope). The next daemon reads it and fails those attempts with
/// `fault_signal`, and the store gives a job up (`dead`) at the second. SIGKILL and power loss leave no line and do not
/// count.
#include "core/signal/result.hpp"
#include "server/store/store.hpp"

#include <array>
#include <cstddef>
#include <filesystem>
#include <vector>

namespace driftlab::server {

/// What the handler writes; ready-made, because a handler may neither format nor allocate.
struct FaultLine {
  std::array<char, 96> text;
  std::size_t size;  ///< 0: nobody is at work
};

/// Installs the handlers, which append to `file`. Call once, before workers start. Error: Io.
[[nodiscard]] Status install_fault_recorder(const std::filesystem::path& file);

/// The attempts that died since the last call, oldest first, and empties the file. Absent: none.
/// Lines that a dying process left incomplete are skipped. Error: Io.
[[nodiscard]] Result<std::vector<Lease>> take_recorded_faults(const std::filesystem::path& file);

/// While it lives, a fault of this thread is charged to the attempt; after it, to the one that was charged before.
/// Destroy them in the reverse order.
class FaultScope {
 public:
  explicit FaultScope(const Lease& lease);
  FaultScope(const FaultScope&) = delete;
  FaultScope& operator=(const FaultScope&) = delete;
  ~FaultScope();

 private:
  FaultLine before_;
};

}  // namespace driftlab::server
