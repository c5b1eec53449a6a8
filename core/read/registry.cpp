#include "core/read/format.hpp"
#include "core/read/formats.hpp"

#include <array>

namespace driftlab {

/// One line per format.
std::span<const Format* const> all_formats() {
  static constexpr std::array<const Format*, 2> kFormats{
      &formats::kCsv,
      &formats::kNpy,
  };
  return kFormats;
}

}  // namespace driftlab
