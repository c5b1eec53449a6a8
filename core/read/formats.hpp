#pragma once
/// The declarations behind registry.cpp: each format is defined in the file of its name.
#include "core/read/format.hpp"

namespace driftlab::formats {

extern const Format kCsv;  ///< csv.cpp
extern const Format kNpy;  ///< npy.cpp

}  // namespace driftlab::formats
