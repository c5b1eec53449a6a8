#pragma once
/// A scale and an offset that stand with a unit, as data sheets and drivers write them. Internal to core/signal:
/// whoever reads a unit asks `parse_unit`, which is the one door for headers, `columns`, documents and the command
/// line.
///
/// The value of a count c is scale * c + offset, both in the unit. These forms are read, with blanks where one likes:
///
///     deg/s/131             a 131st of a deg/s           deg/s*0.0076    the same as a product
///     degC/340+36.53        c / 340 + 36.53 degC         0.061 mg        a number of them
///     raw/340+36.53 degC    the formula of the sheet     131 LSB/(deg/s), 0.061mg/LSB     the sensitivity
///
/// In the address of a request a `+` that is not written `%2B` arrives as a blank: `degC/340 36.53` means the same.
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace driftlab {

struct WrittenScale {
  std::string unit;       ///< as written, without scale and offset
  std::string canonical;  ///< the whole as written, with `+` where a blank stood for it
  double scale = 1.0;     ///< units in one count; may be what no scale can be: 0, below 0, not finite
  double offset = 0.0;    ///< [unit]
};

/// Nothing where the text has neither of these forms, or where `is_unit` does not know what would be its unit.
/// O(length).
[[nodiscard]] std::optional<WrittenScale> read_scale(std::string_view text,
                                                     const std::function<bool(std::string_view)>& is_unit);

}  // namespace driftlab
