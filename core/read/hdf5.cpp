/// HDF5, and MATLAB level 7.3 (save -v7.3), which is HDF5 behind a header of 512 bytes: real arrays of one or two
/// dimensions wherever they lie, and the numeric members of tables. Read by libhdf5 in a process of its own
/// (core/read/decode_process.hpp). Source of the signatures: The HDF Group, "HDF5 File Format Specification 3.0",
/// section II.A.
#include "core/read/decode_process.hpp"
#include "core/read/formats.hpp"

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kSignature = "\x89HDF\r\n\x1a\n"sv;
constexpr std::string_view kMatlab = "MATLAB 7.3 MAT-file";
constexpr std::size_t kBehindMatlab = 512;

int sniff(std::string_view head) {
  const bool matlab =
      head.starts_with(kMatlab) && head.size() >= kBehindMatlab && head.substr(kBehindMatlab).starts_with(kSignature);
  return head.starts_with(kSignature) || matlab ? 100 : 0;
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  return decode_apart("hdf5", "HDF5 file", source, limits, sink, control);
}

}  // namespace

const Format kHdf5{"hdf5", "HDF5 and MATLAB 7.3 files with real arrays of one length", sniff, decode};

}  // namespace driftlab::formats
