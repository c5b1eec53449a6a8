#include "core/read/format.hpp"
#include "core/read/rtklib_tag.hpp"
#include "core/read/text_shape.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>

namespace driftlab {
namespace {

using namespace std::string_view_literals;

/// Bytes at a place that give a format away, and what to call it: its name, and behind a semicolon the next step.
struct Signature {
  std::size_t offset;
  std::string_view magic;
  std::string_view name;
};

constexpr std::array kSignatures{
    Signature{0, "MATLAB 7.3 MAT-file"sv, "a MATLAB 7.3 file that is cut off; send it again"},
    Signature{0, "\xb5\x62"sv, "a u-blox UBX log, which holds a receiver's messages; send the recording of the IMU"},
    Signature{0, "$GP"sv, "an NMEA log without checksums; switch them on, for they show that its numbers are whole"},
    Signature{0, "$GN"sv, "an NMEA log without checksums; switch them on, for they show that its numbers are whole"},
    Signature{0, "FMT, 128, 89"sv, "an ArduPilot log turned into text; send the .bin"},
    Signature{0, kTagSignature,
              "an RTKLIB time tag, which dates the log beside it; send that log, and name the tag as the time.tag of a "
              "drive"sv},
    Signature{0, "%PDF"sv, "a PDF document; send the samples as CSV or .npy"},
    Signature{0, "\x89PNG\r\n\x1a\n"sv, "a PNG image; send the samples as CSV or .npy"},
    Signature{0, "\xff\xd8\xff"sv, "a JPEG image; send the samples as CSV or .npy"},
    Signature{0, "GIF8"sv, "a GIF image; send the samples as CSV or .npy"},
    Signature{0, "BZh"sv, "a bzip2 file; use gzip, xz or zstd"},
    Signature{0, "7z\xbc\xaf\x27\x1c"sv, "a 7-Zip archive; unpack it and send its files one by one"},
    Signature{0, "Rar!\x1a\x07"sv, "a RAR archive; unpack it and send its files one by one"},
    Signature{0, "\x04\x22\x4d\x18"sv, "an LZ4 file; use gzip, xz or zstd"},
    Signature{257, "ustar"sv, "a tar archive; send its files one by one"},
    Signature{0, "PAR1"sv, "a Parquet file; write it as CSV (pandas.read_parquet, to_csv)"},
    Signature{0, "ARROW1"sv, "an Arrow (Feather) file; write it as CSV (pandas.read_feather, to_csv)"},
    Signature{0, "\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, "an old Microsoft Office file; save the sheet as CSV"},
    Signature{0,
              "\x7f"
              "ELF"sv,
              "a program; send the recording that it made"},
    Signature{0, "RIFF"sv, "a RIFF file (WAV or AVI); send the samples as CSV or .npy"},
    Signature{0, "\xff\xfe"sv, "UTF-16 text; save it as UTF-8"},
    Signature{0, "\xfe\xff"sv, "UTF-16 text; save it as UTF-8"},
};

std::string describe_zip(std::string_view head) {
  const std::string_view entry = head.substr(0, 512);
  if (entry.find("[Content_Types].xml") != std::string_view::npos) {
    return "a Microsoft Office file; save the sheet as CSV";
  }
  return "a ZIP archive without CSV files or .npy arrays; put the samples into it as one of these";
}

std::string binary_data() { return "binary data; send the samples as CSV or .npy"; }

std::string describe_text(std::string_view head) {
  const std::string_view start = text::trim(head.substr(std::min(head.find_first_not_of(" \t\r\n"), head.size())));
  if (start.starts_with("<!DOCTYPE html") || start.starts_with("<!doctype html") || start.starts_with("<html")) {
    return "an HTML page, as a download that needs a login gives; fetch the file itself";
  }
  if (start.starts_with("<")) {
    return "an XML document; send the samples as CSV or .npy";
  }
  if (start.starts_with("{") || start.starts_with("[")) {
    return "a JSON document; send the samples as CSV or .npy";
  }
  switch (text::shape_of(head)) {
    case text::Shape::Semicolons:
      return "semicolon-separated text that is not a table of numbers; send rows of numbers under a line of names";
    case text::Shape::Tabs:
      return "tab-separated text that is not a table of numbers; send rows of numbers under a line of names";
    case text::Shape::Spaces:
      return "text in columns that are not numbers; send rows of numbers under a line of names";
    case text::Shape::LoneReturns:
      return "text whose lines end with carriage returns alone, as old Macintosh programs wrote them; turn them into "
             "line feeds: tr '\\r' '\\n' < FILE > NEW_FILE";
    case text::Shape::NotText:
      return binary_data();
    default:
      return "text that is not a table of numbers; send rows of numbers under a line of names";
  }
}

}  // namespace

std::optional<std::string> recognise_foreign(std::string_view head) {
  for (const Signature& signature : kSignatures) {
    if (head.size() >= signature.offset && head.substr(signature.offset).starts_with(signature.magic)) {
      return std::string(signature.name);
    }
  }
  if (head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06")) {
    return describe_zip(head);
  }
  if (const Compression nested = sniff_compression(head); nested != Compression::None) {
    return "a " + std::string(name_of(nested)) + " file inside a compressed file; compress once";
  }
  return std::nullopt;
}

std::string describe_unknown(std::string_view head) {
  if (auto foreign = recognise_foreign(head)) {
    return std::move(*foreign);
  }
  const bool binary = head.substr(0, 512).find('\0') != std::string_view::npos;
  return binary ? binary_data() : describe_text(head);
}

}  // namespace driftlab
