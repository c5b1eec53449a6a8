#include "server/store/guarded_round.hpp"

#include <exception>
#include <utility>

namespace driftlab::server {
namespace {

EscapeListener& escape_listener() {
  static EscapeListener one;
  return one;
}

}  // namespace

void tell_escapes_to(EscapeListener listener) { escape_listener() = std::move(listener); }

void tell_escape(std::string_view where, std::string_view what) noexcept {
  try {
    if (escape_listener()) {
      escape_listener()(where, what);
    }
  } catch (...) {  // NOLINT(bugprone-empty-catch): there is nobody left to tell
  }
}

bool guarded_round(std::string_view where, const std::function<void()>& round) noexcept {
  try {
    round();
    return true;
  } catch (const std::exception& exception) {
    tell_escape(where, exception.what());
  } catch (...) {
    tell_escape(where, "an exception of an unknown type");
  }
  return false;
}

}  // namespace driftlab::server
