#pragma once
/// The time tag that RTKLIB writes beside a stream that it logs (`file.tag`): it dates bytes without stamps of their
/// own.
///
/// Little-endian: 60 bytes of text that begin with TIMETAG RTKLIB, u32 tick of the computer [ms], u32 GPS time of that
/// tick in seconds since 1970, f64 its fraction, then pairs of u32: milliseconds since the start, bytes written by
/// then. Source: RTKLIB 2.4.2, stream.c. A torn last pair is left out.
#include "core/signal/result.hpp"

#include <filesystem>
#include <string_view>

namespace driftlab {

/// GPS time [s since 1970] at the start of the log and at its last entry.
struct RtklibTag {
  double first_s = 0.0;
  double last_s = 0.0;
};

/// What a time tag begins with.
inline constexpr std::string_view kTagSignature = "TIMETAG RTKLIB";

/// Later than its start is the last entry of a tag that is taken. Errors: UnsupportedFormat (no time tag, a start
/// before GPS time), Truncated (no entry), TooFewSamples (no time between start and last entry).
[[nodiscard]] Result<RtklibTag> parse_rtklib_tag(std::string_view bytes);

/// The same of a file, compressed or not. Errors: NotFound, Io, LimitExceeded (more than 64 MiB), those of
/// decompression.
[[nodiscard]] Result<RtklibTag> read_rtklib_tag(const std::filesystem::path& path);

}  // namespace driftlab
