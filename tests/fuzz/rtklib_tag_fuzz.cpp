/// Any bytes as a time tag of RTKLIB: refused in a sentence, or two times of which the second is the later, which the
/// bytes of a torn last entry do not change.
#include "core/read/rtklib_tag.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

namespace {

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace driftlab;
  constexpr std::size_t kHeader = 76;
  constexpr std::size_t kEntry = 8;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto tag = parse_rtklib_tag(bytes);
  if (!tag) {
    require(tag.error().message.ends_with('.') && tag.error().code != ErrorCode::Internal);
    return 0;
  }
  require(bytes.starts_with(kTagSignature) && std::isfinite(tag->first_s) && tag->last_s > tag->first_s);
  const auto whole = parse_rtklib_tag(bytes.substr(0, size - (size - kHeader) % kEntry));
  require(whole && whole->first_s == tag->first_s && whole->last_s == tag->last_s);
  return 0;
}
