/// The list of manufacturers: one line each. Each is a file in core/datasheet/sheets/.
#include "core/datasheet/data_sheet.hpp"

// clang-format off
#define DRIFTLAB_MANUFACTURERS(MANUFACTURER) \
  MANUFACTURER(invensense)                   \
  MANUFACTURER(bosch)                        \
  MANUFACTURER(st)                           \
  MANUFACTURER(analog_devices)               \
  MANUFACTURER(xsens)
// clang-format on

namespace driftlab {

#define DRIFTLAB_DECLARE_SHEETS(name) std::span<const DataSheet> name##_sheets();
DRIFTLAB_MANUFACTURERS(DRIFTLAB_DECLARE_SHEETS)
#undef DRIFTLAB_DECLARE_SHEETS

const std::vector<const DataSheet*>& data_sheets() {
  static const std::vector<const DataSheet*> sheets = [] {
    std::vector<const DataSheet*> all;
#define DRIFTLAB_ADD_SHEETS(name)                  \
  for (const DataSheet& sheet : name##_sheets()) { \
    all.push_back(&sheet);                         \
  }
    DRIFTLAB_MANUFACTURERS(DRIFTLAB_ADD_SHEETS)
#undef DRIFTLAB_ADD_SHEETS
    return all;
  }();
  return sheets;
}

}  // namespace driftlab
