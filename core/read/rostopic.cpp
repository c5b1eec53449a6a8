/// What `rostopic echo -p` prints of a sensor_msgs/Imu: a header that begins with `%time,` and names every field, then
/// one message a line. Read are field.angular_velocity [rad/s] and field.linear_acceleration [m/s^2]; the time is that
/// of field.header.stamp [ns], and %time, that of the recording, where the stamps are zero. Source: ROS wiki,
/// "rostopic".
#include "core/read/dialect.hpp"
#include "core/read/formats.hpp"
#include "core/read/inertial_streams.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"

#include <algorithm>
#include <array>

namespace driftlab::formats {
namespace {

constexpr std::string_view kStart = "%time,";
constexpr std::size_t kLongestLine = std::size_t{64} * 1024;
constexpr std::string_view kStamp = "field.header.stamp";
constexpr std::array<std::string_view, 6> kFields{
    "field.angular_velocity.x",    "field.angular_velocity.y",    "field.angular_velocity.z",
    "field.linear_acceleration.x", "field.linear_acceleration.y", "field.linear_acceleration.z",
};

int sniff(std::string_view head) { return head.starts_with(kStart) ? 100 : 0; }

class EchoDecoder {
 public:
  explicit EchoDecoder(ColumnSink& sink) : sink_(sink), streams_(sink, 1e9) {}

  Status take(std::string_view line, std::uint64_t number) {
    if (text::trim(line).empty()) {
      return {};
    }
    const std::vector<std::string> cells = text::split_cells(line, ',');
    return number == 1 ? take_header(cells) : take_row(cells, number);
  }
  Status finish() {
    if (log_time_) {
      sink_.note("The messages have no stamp; their time is that of the recording.");
    }
    return streams_.finish("The file has a header and no message under it.");
  }

 private:
  Status take_header(const std::vector<std::string>& cells) {
    width_ = cells.size();
    const auto place = [&cells](std::string_view name) {
      return static_cast<std::size_t>(std::find(cells.begin(), cells.end(), name) - cells.begin());
    };
    stamp_ = place(kStamp);
    std::transform(kFields.begin(), kFields.end(), fields_.begin(), place);
    if (std::find(fields_.begin(), fields_.end(), width_) != fields_.end()) {
      return fail(ErrorCode::UnsupportedType,
                  "This is the text of `rostopic echo -p`, but of no topic with angular_velocity and "
                  "linear_acceleration (sensor_msgs/Imu).");
    }
    auto stream = streams_.add("imu", Inertial::Both, inertial_columns(Inertial::Both));
    return stream ? Status{} : fail(stream.error());
  }
  Status take_row(const std::vector<std::string>& cells, std::uint64_t number) {
    if (cells.size() != width_) {
      return text::wrong_cells(number, cells.size(), width_);
    }
    const auto stamp_at = [&](std::size_t column) { return text::stamp_of(cells[column]); };
    if (streams_.empty()) {
      log_time_ = stamp_ == width_ || stamp_at(stamp_) == std::uint64_t{0};
    }
    const std::size_t column = log_time_ ? 0 : stamp_;
    const auto stamp = stamp_at(column);
    if (!stamp) {
      return text::not_a_number(number, cells[column]);
    }
    std::array<double, kFields.size()> row{};
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto value = text::number_of(cells[fields_[i]]);
      if (!value) {
        return text::not_a_number(number, cells[fields_[i]]);
      }
      row[i] = *value;
    }
    return streams_.take(0, *stamp, row);
  }

  ColumnSink& sink_;
  InertialStreams streams_;
  std::size_t width_ = 0;
  std::size_t stamp_ = 0;
  std::array<std::size_t, kFields.size()> fields_{};
  bool log_time_ = false;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  EchoDecoder decoder(sink);
  auto status =
      text::for_each_row(source, kLongestLine, control, sink,
                         [&](std::string_view line, std::uint64_t number) { return decoder.take(line, number); });
  return status ? decoder.finish() : status;
}

}  // namespace

const Format kRostopic{"rostopic", "Imu messages as `rostopic echo -p` prints them", sniff, decode};

}  // namespace driftlab::formats
