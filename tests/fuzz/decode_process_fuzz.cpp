/// Any bytes behind the signature of HDF5, given to the real `driftlab-decode` beside this program: whatever becomes of
/// it, the answer is a sound table or a refusal of the file. The library that it may break over (libhdf5) is not in
/// this process, where each of its own faults would be a finding.
#include "core/read/format.hpp"
#include "core/read/text_shape.hpp"
#include "tests/fuzz/table_sink.hpp"

#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

namespace {

using namespace driftlab;

class CountingSink final : public TableSink {
 public:
  void note(std::string sentence) override { require(text::to_utf8(sentence) == sentence); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n";
  std::string bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::size_t kBehindMatlab = 512;
  const bool matlab =
      bytes.size() > kBehindMatlab && std::string_view(bytes).substr(kBehindMatlab).starts_with(kSignature);
  if (!bytes.starts_with(kSignature) && !matlab) {
    return -1;  // not to be kept: another reader's
  }
  DecodeLimits limits;
  limits.max_tables_bytes = std::size_t{1} << 20;
  CountingSink sink;
  const auto decoded = decode_stream(make_memory_reader(bytes), sink, limits);
  if (!decoded) {
    // Io: the program is not beside this one, or a process before has kept a descriptor.
    require(decoded.error().code != ErrorCode::Internal && decoded.error().code != ErrorCode::Io);
    require(!decoded.error().message.empty() && text::to_utf8(decoded.error().message) == decoded.error().message);
  }
  return 0;
}
