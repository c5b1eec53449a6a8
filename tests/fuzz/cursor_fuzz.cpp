/// Any text as a cursor of a list: one that is taken is the text that its row gives, and names a row. The first byte
/// says the order of the list.
#include "server/store/cursor.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

using namespace driftlab::server;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto order = static_cast<PageOrder>(data[0] % 3);
  if (const auto cursor = read_cursor(text, order)) {
    require(is_id(cursor->id, cursor->id.substr(0, cursor->id.find('_'))));
    require(order == PageOrder::ByName || cursor->name.empty());
    require(cursor_at(order, cursor->id, cursor->name) == text);
  }
  // And the other way: whatever a row is called, its cursor leads back to it.
  const std::string id = "dev_01ARZ3NDEKTSV4RRFFQ69G5FAV";
  const auto back = read_cursor(cursor_at(PageOrder::ByName, id, std::string(text)), PageOrder::ByName);
  require(back && back->id == id && back->name == text);
  return 0;
}
