/// The IMU of the EuRoC layout (`imu0/data.csv`, also TUM-VI and many visual-inertial sets): a header that begins with
/// `#timestamp [ns],w_RS_S_x [rad s^-1]`, then a stamp in nanoseconds, the angular rate and the specific force of each
/// sample. Source: M. Burri et al., "The EuRoC micro aerial vehicle datasets", IJRR 35 (2016), section 3.
#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/inertial_streams.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"

#include <array>

namespace driftlab::formats {
namespace {

constexpr std::string_view kHeader = "#timestamp [ns],w_RS_S_x [rad s^-1]";
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
  auto status = text::for_each_line(source, kLongestLine, control, [&](std::string_view line, std::uint64_t number) {
    return take_line(line, number, streams);
  });
  return status ? streams.finish("The file has a header and no sample under it.") : status;
}

}  // namespace

const Format kEuroc{"euroc", "IMU table of the EuRoC layout (imu0/data.csv)", sniff, decode};

}  // namespace driftlab::formats
