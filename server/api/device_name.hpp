#pragma once
/// What a device may be called, at every door where one can be named.
#include "core/signal/result.hpp"
#include "server/store/store.hpp"

#include <string>
#include <string_view>

namespace driftlab::server {

/// Whether a text is well-formed UTF-8 without control characters (U+0000 to U+001F, U+007F to U+009F).
[[nodiscard]] bool is_plain_text(std::string_view text);

/// Nothing if the name will do; else one sentence: a name is 1 to 200 bytes of well-formed UTF-8 without control
/// characters (U+0000 to U+001F, U+007F to U+009F).
[[nodiscard]] std::string fault_of_device_name(std::string_view name);

/// The device that an upload belongs to, by its name or its id. A name that begins with `dev_` must be the id of a
/// device that exists, for no new device may be called so; `device.name` becomes that device's name. Errors:
/// InvalidArgument, field "parameter" = "device"; forbidden where this thread's caller may not use that device.
[[nodiscard]] Status resolve_device_name(Store& store, Device& device);

}  // namespace driftlab::server
