#include "core/read/formats.hpp"

#include <array>

namespace driftlab {

std::span<const Format* const> all_formats() {
#define DRIFTLAB_ENTER_FORMAT(name) &formats::name,
  static constexpr std::array kFormats{DRIFTLAB_FORMATS(DRIFTLAB_ENTER_FORMAT)};
#undef DRIFTLAB_ENTER_FORMAT
  return kFormats;
}

}  // namespace driftlab
