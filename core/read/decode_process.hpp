#pragma once
/// Formats whose libraries are large and take files apart by pointers inside them (HDF5) are read in a process of their
/// own, `driftlab-decode` (clients/decode), which has no file, no network and no more memory and time than it was
/// given. A file that breaks it breaks nothing else. Internal to core/read.
#include "core/read/format.hpp"

#include <string>

namespace driftlab {

/// Gives the whole input to `driftlab-decode FORMAT`, which lies beside the running program, and delivers the arrays
/// that it reads (core/read/variables.hpp). `what` names the format in sentences: "HDF5 file". Errors: Io (the program
/// is not there, or cannot be started), LimitExceeded (more than 2 GiB), ShapeMismatch (it broke over the file, or
/// needed more memory or time than one decoding may), Cancelled, those that it reports, those of deliver_variables.
[[nodiscard]] Status decode_apart(const std::string& format, const std::string& what, ByteSource& source,
                                  const DecodeLimits& limits, ColumnSink& sink, const RunControl& control);

}  // namespace driftlab
