/// Any bytes as what a decoding process says, which a file may have taken over: refused in a sentence, or arrays within
/// the limit that make a rectangular table.
#include "core/read/variable_stream.hpp"
#include "tests/fuzz/table_sink.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

namespace {

using namespace driftlab;

class CountingSink final : public TableSink {
 public:
  void note(std::string sentence) override { require(!sentence.empty()); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kBudget = std::size_t{1} << 20;
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  auto stream = read_variables(
      [&](std::span<char> into) -> Result<std::size_t> {
        const std::size_t taken = std::min({into.size(), bytes.size(), std::size_t{13}});
        std::memcpy(into.data(), bytes.data(), taken);
        bytes.remove_prefix(taken);
        return taken;
      },
      kBudget, 256);
  if (!stream) {
    require(stream.error().code != ErrorCode::Internal);
    return 0;
  }
  std::size_t kept = 0;
  for (const Variable& variable : stream->variables) {
    kept += sizeof variable + variable.name.size();
    for (const auto& column : variable.columns) {
      require(column.size() == variable.columns.front().size());
      kept += sizeof(std::vector<double>) + column.size() * sizeof(double);
    }
  }
  require(kept <= kBudget && stream->notes.size() <= 64);
  CountingSink sink;
  if (const auto done = deliver_variables(std::move(stream->variables), {}, sink); !done) {
    require(!done.error().message.empty() && done.error().code != ErrorCode::Internal);
  }
  return 0;
}
