#include "server/api/device_name.hpp"

#include "server/store/principal.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::size_t kLongestName = 200;

/// C0 and DEL are single bytes; C1 is C2 80 to C2 9F in UTF-8.
bool has_control_character(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 = byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (byte < 0x20 || byte == 0x7F || c1) {
      return true;
    }
  }
  return false;
}

/// The JSON parser takes a string if and only if its bytes are well-formed UTF-8.
bool is_utf8(std::string_view text) {
  std::string quoted = "\"";
  std::copy_if(text.begin(), text.end(), std::back_inserter(quoted), [](char c) { return c != '"' && c != '\\'; });
  return nlohmann::json::accept(quoted + '"');
}

}  // namespace

bool is_plain_text(std::string_view text) { return !has_control_character(text) && is_utf8(text); }

std::string fault_of_device_name(std::string_view name) {
  if (name.empty()) {
    return "A device needs a name.";
  }
  if (name.size() > kLongestName) {
    return "A device name has at most 200 bytes.";
  }
  if (has_control_character(name)) {
    return "A device name has no control characters.";
  }
  if (!is_utf8(name)) {
    return "A device name is text in UTF-8.";
  }
  return "";
}

Status resolve_device_name(Store& store, Device& device) {
  if (!device.name.starts_with("dev_")) {
    return require_device(device.name);
  }
  auto found = store.device(device.name);
  if (found) {
    device.name = found->name;
    return require_device(device.name);
  }
  if (found.error().code != ErrorCode::NotFound) {
    return fail(found.error());
  }
  return fail(ErrorCode::InvalidArgument,
              "There is no device " + device.name + ", and the name of a new one does not begin with dev_.",
              {{"parameter", "device"}});
}

}  // namespace driftlab::server
