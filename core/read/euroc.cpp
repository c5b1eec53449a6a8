/// The IMU of the EuRoC layout (`imu0/data.csv`, also TUM-VI and many visual-inertial sets): a header that begins with
/// `#timestamp [ns],w_RS_S_x [rad s^-1]`, then a stamp in nanoseconds, the angular rate and the specific force of each
/// sample. A sequence is read from its ZIP archive and, on the command line, from its folder too; what else the layout
/// holds is left out. Source: M. Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 35 (2016), section 3.
#include "core/read/euroc.hpp"

#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/inertial_streams.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"
#include "core/read/zip_entries.hpp"

#include <array>

namespace driftlab::formats {
namespace {

constexpr std::string_view kHeader = "#timestamp [ns],w_RS_S_x [rad s^-1]";
constexpr std::string_view kTable = "imu0/data.csv";
constexpr std::size_t kLongestLine = 1024;
constexpr std::size_t kCells = 7;

int sniff(std::string_view head) { return head.starts_with(kHeader) ? 100 : 0; }

Status take_line(std::string_view line, std::uint64_t number, InertialStreams& streams) {
  if (text::trim(line).empty() || line.front() == '#') {
    return {};
  }
  const std::vector<std::string> cells = text::split_cells(line, ',');
  if (cells.size() != kCells) {
    return text::wrong_cells(number, cells.size(), kCells);
  }
  const auto stamp = text::stamp_of(cells[0]);
  if (!stamp) {
    return text::not_a_number(number, cells[0]);
  }
  std::array<double, kCells - 1> row{};
  for (std::size_t i = 0; i < row.size(); ++i) {
    const auto value = text::number_of(cells[i + 1]);
    if (!value) {
      return text::not_a_number(number, cells[i + 1]);
    }
    row[i] = *value;
  }
  return streams.take(0, *stamp, row);
}

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  InertialStreams streams(sink, 1e9);
  if (auto stream = streams.add("imu", Inertial::Both, inertial_columns(Inertial::Both)); !stream) {
    return fail(stream.error());
  }
  auto status =
      text::for_each_row(source, kLongestLine, control, sink,
                         [&](std::string_view line, std::uint64_t number) { return take_line(line, number, streams); });
  return status ? streams.finish("The file has a header and no sample under it.") : status;
}

int sniff_zip(std::string_view head) { return zip_holds(head, kTable) ? 100 : 0; }

Status decode_zip(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  bool taken = false;
  auto status = for_each_zip_entry(source, limits, [&](const std::string& path, ByteSource& content) -> Status {
    if (!path.ends_with(kTable)) {
      return {};
    }
    if (taken) {
      return fail(ErrorCode::UnsupportedFormat,
                  "The archive holds several sequences of the EuRoC layout; send their imu0/data.csv one by one.");
    }
    auto head = content.view(kHeader.size());
    if (!head) {
      return fail(head.error());
    }
    if (sniff(*head) == 0) {
      return fail(ErrorCode::UnsupportedFormat,
                  "The archive's imu0/data.csv is no IMU table of the EuRoC layout; send that file alone.");
    }
    taken = true;
    return decode(content, limits, sink, control);
  });
  if (status && !taken) {
    return fail(ErrorCode::NoSamples, "The archive of the EuRoC layout holds no imu0/data.csv; pack that file too.");
  }
  return status;
}

}  // namespace

const Format kEuroc{"euroc", "IMU table of the EuRoC layout (imu0/data.csv)", sniff, decode};
const Format kEurocZip{"euroc_zip", "ZIP archive of a sequence in the EuRoC layout (mav0)", sniff_zip, decode_zip};

}  // namespace driftlab::formats

namespace driftlab {

std::optional<std::filesystem::path> find_euroc_table(const std::filesystem::path& folder) {
  for (const char* const place : {"mav0/imu0/data.csv", "imu0/data.csv", "data.csv"}) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(folder / place, ignored)) {
      continue;
    }
    auto reader = open_file_reader(folder / place);
    if (!reader) {
      continue;
    }
    ByteSource content(std::move(*reader));
    const auto head = content.view(kSniffBytes);
    if (head && formats::kEuroc.sniff(*head) > 0) {
      return folder / place;
    }
  }
  return std::nullopt;
}

Status decode_euroc_table(const std::filesystem::path& table, const DecodeLimits& limits, ColumnSink& sink,
                          const RunControl& control) {
  auto reader = open_file_reader(table);
  if (!reader) {
    return fail(reader.error());
  }
  ByteSource content(std::move(*reader));
  return formats::kEuroc.decode(content, limits, sink, control);
}

}  // namespace driftlab
