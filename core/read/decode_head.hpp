#pragma once
/// The beginning of a file, decoded as far as it goes: what a recording would be, before all of it is there.
#include "core/read/format.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// Whether bytes are a file from its first byte to its last.
enum class HeadExtent { Beginning, WholeFile };

struct DecodedHead {
  std::string format;
  Compression compression = Compression::None;
  ColumnNames names;        ///< empty where the format tells its columns only at the end of the file
  bool has_header = false;  ///< the names came from the file
  /// The first samples of each column in the file's own unit. A format that is written column by column may have less
  /// of the later ones.
  std::vector<std::vector<double>> columns;
  std::vector<std::string> notes;
  [[nodiscard]] std::size_t rows() const;  ///< that every column has
};

/// Decodes at most 20 000 rows and 2 000 000 samples of `bytes`. In a beginning, text ends with the last whole line,
/// and that bytes are missing is no error. Errors: those of decode_stream, less those.
[[nodiscard]] Result<DecodedHead> decode_head(std::string_view bytes, HeadExtent extent,
                                              const DecodeLimits& limits = {});

}  // namespace driftlab
