#pragma once
/// An exception that escapes from one round of a thread's endless loop is told and ends that round alone. Without this
/// it would end the process.
#include <functional>
#include <string_view>

namespace driftlab::server {

/// Is told in which loop an exception was caught, and what the exception says; on the thread that caught it.
using EscapeListener = std::function<void(std::string_view where, std::string_view what)>;

/// Whom `guarded_round` and `tell_escape` tell, in the whole process; empty: nobody. Call it while no guarded loop
/// runs.
void tell_escapes_to(EscapeListener listener);

/// Tells the listener. What the listener itself throws is dropped.
void tell_escape(std::string_view where, std::string_view what) noexcept;

/// Runs `round` and tells of an exception that escapes from it, once. False: one did; a loop that has nothing else to
/// wait for should then pause, for its next round may fail in the same way.
bool guarded_round(std::string_view where, const std::function<void()>& round) noexcept;

}  // namespace driftlab::server
