#pragma once
/// The registry: one line per format. The rest of the line's life is generated: its declaration here, its place in
/// all_formats() in registry.cpp. Each format is defined in the file of its name.
#include "core/read/format.hpp"

// clang-format off
#define DRIFTLAB_FORMATS(FORMAT) \
  FORMAT(kCsv) /* csv.cpp */     \
  FORMAT(kNpy) /* npy.cpp */
// clang-format on

namespace driftlab::formats {

#define DRIFTLAB_DECLARE_FORMAT(name) extern const Format name;
DRIFTLAB_FORMATS(DRIFTLAB_DECLARE_FORMAT)
#undef DRIFTLAB_DECLARE_FORMAT

}  // namespace driftlab::formats
