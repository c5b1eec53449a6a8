#pragma once
/// What the process may still do once it has its input: compute, and write to the pipe.
#include <cstddef>

namespace driftlab::decode {

/// Limits memory to `memory_bytes`, processor time to two minutes and files to none, and then refuses, by a seccomp
/// filter, every system call but those that compute with memory and read, write and close what is open: none that
/// opens, makes or changes a file, makes a process, a thread or a socket, changes a limit, or looks at another process.
/// Where the kernel has no seccomp the limits hold alone. False where a limit cannot be set.
[[nodiscard]] bool enter_sandbox(std::size_t memory_bytes);

}  // namespace driftlab::decode
