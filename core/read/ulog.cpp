/// PX4 ULog: a header of 16 bytes, then messages of a length, a letter and a body; formats ('F') declare the layout of
/// topics, subscriptions ('A') number them, data ('D') carry them. Little-endian. Source: PX4 user guide, "ULog File
/// Format".
///
/// Read as inertial streams (core/read/inertial_streams.hpp), each instance of a topic its own:
///   sensor_combined  gyro_rad [rad/s], accelerometer_m_s2 [m/s^2]
///   vehicle_imu      delta_angle [rad] and delta_velocity [m/s] over their own intervals [us], read as mean rates
///   sensor_gyro      x y z [rad/s], temperature [degC]
///   sensor_accel     x y z [m/s^2], temperature [degC]
/// and the fixes of the receiver beside them (core/read/ulog_fixes.hpp).
/// Time is the topic's timestamp_sample, else its timestamp, in microseconds since boot. The raw bursts of
/// sensor_gyro_fifo and sensor_accel_fifo are not read.
#include "core/read/formats.hpp"
#include "core/read/inertial_streams.hpp"
#include "core/read/little_endian.hpp"
#include "core/read/ulog_fixes.hpp"
#include "core/read/ulog_format.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "ULog\x01\x12\x35"sv;
constexpr std::string_view kSync = "\x08\x00S\x2F\x73\x13\x20\x25\x0C\xBB\x12"sv;  // a whole synchronisation message
constexpr std::size_t kHeaderBytes = 16;
constexpr std::size_t kMostDefinitionBytes = std::size_t{4} << 20;

/// A topic with inertial samples; a field that it has not is empty.
struct InertialTopic {
  std::string_view name;
  std::string_view gyro;
  std::string_view gyro_interval_us;
  std::string_view accel;
  std::string_view accel_interval_us;
  std::string_view temperature;
};

constexpr std::array kTopics{
    InertialTopic{"sensor_combined", "gyro_rad", "", "accelerometer_m_s2", "", ""},
    InertialTopic{"vehicle_imu", "delta_angle", "delta_angle_dt", "delta_velocity", "delta_velocity_dt", ""},
    InertialTopic{"sensor_gyro", "x", "", "", "", "temperature"},
    InertialTopic{"sensor_accel", "", "", "x", "", "temperature"},
};

/// Three floats, and the interval they are summed over.
struct Triad {
  std::size_t offset = 0;
  std::optional<ulog::Place> interval_us;
};

/// How the data of a subscription become a row.
struct Subscription {
  std::size_t stream = 0;
  std::size_t stamp = 0;
  std::vector<Triad> triads;
  std::optional<std::size_t> temperature;
  std::size_t bytes = 0;  ///< that the data must have
};

class UlogDecoder {
 public:
  UlogDecoder(ByteSource& source, ColumnSink& sink, const RunControl& control)
      : source_(source), sink_(sink), control_(control), streams_(sink, 1e6) {}

  Status run();

 private:
  Status take_header();
  Result<bool> next_message();
  Status take(char letter, std::string_view body);
  Status take_flags(std::string_view body);
  Status take_definition(std::string_view body);
  Status subscribe(std::string_view body);
  void subscribe_fixes(std::size_t id, std::string_view name, const std::string& label);
  Status take_data(std::string_view body);
  Status take_sample(const Subscription& layout, std::string_view data);
  void take_fix(std::size_t stream, const ulog::FixLayout& layout, std::string_view data);
  Result<bool> resynchronise();
  [[nodiscard]] std::optional<Subscription> layout_of(const InertialTopic& topic) const;
  [[nodiscard]] std::optional<Triad> find_triad(const InertialTopic& topic, std::string_view field,
                                                std::string_view interval) const;
  void note_quality();

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  InertialStreams streams_;
  ulog::Definitions definitions_;
  std::size_t definition_bytes_ = 0;
  std::vector<std::optional<Subscription>> subscriptions_;                ///< by message id
  std::map<std::size_t, std::pair<std::size_t, ulog::FixLayout>> fixes_;  ///< stream and layout, by message id
  std::array<std::uint64_t, 3> appended_{};  ///< offsets where data were appended, 0 for none
  std::uint64_t dropouts_ = 0;
  std::uint64_t dropout_ms_ = 0;
  std::uint64_t damaged_bytes_ = 0;
  std::uint64_t short_messages_ = 0;
  std::map<std::size_t, std::string> burst_topics_;      ///< by message id
  std::map<std::string, std::uint64_t> burst_messages_;  ///< by topic
  std::optional<std::uint64_t> torn_at_;
};

Status UlogDecoder::take_header() {
  auto header = source_.view(kHeaderBytes);
  if (!header) {
    return fail(header.error());
  }
  if (header->size() < kHeaderBytes) {
    return fail(ErrorCode::Truncated, "The ULog file ends within its header of 16 bytes.");
  }
  source_.consume(kHeaderBytes);
  return {};
}

/// True while there may be another.
Result<bool> UlogDecoder::next_message() {
  constexpr std::size_t kHead = 3;
  auto view = source_.view(kHead);
  if (!view) {
    return fail(view.error());
  }
  if (view->empty()) {
    return false;
  }
  const std::uint64_t at = source_.offset();
  if (view->size() < kHead) {
    torn_at_ = at;
    source_.consume(view->size());
    return true;
  }
  const std::size_t size = load_at<std::uint16_t>(*view, 0);
  const char letter = (*view)[2];
  for (const std::uint64_t border : appended_) {
    if (border > at && border < at + kHead + size) {  // cut off by what a crash handler appended behind it
      auto skipped = skip_bytes(source_, border - at, control_);
      return skipped ? Result<bool>(true) : fail(skipped.error());
    }
  }
  if (letter < 'A' || letter > 'Z' || size == 0) {
    return resynchronise();
  }
  view = source_.view(kHead + size);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < kHead + size) {
    torn_at_ = at;
    source_.consume(view->size());
    return true;
  }
  if (auto status = take(letter, view->substr(kHead, size)); !status) {
    return fail(status.error());
  }
  source_.consume(kHead + size);
  return true;
}

/// Goes on at the next synchronisation message; what lies before it is damaged.
Result<bool> UlogDecoder::resynchronise() {
  const std::uint64_t from = source_.offset();
  while (true) {
    auto view = source_.view(kSync.size());
    if (!view) {
      return fail(view.error());
    }
    const std::size_t found = view->find(kSync);
    const bool ends = view->size() < kSync.size();
    source_.consume(found != std::string_view::npos ? found : ends ? view->size() : view->size() - kSync.size() + 1);
    if (found != std::string_view::npos || ends) {
      damaged_bytes_ += source_.offset() - from;
      return true;
    }
  }
}

Status UlogDecoder::take(char letter, std::string_view body) {
  switch (letter) {
    case 'B':
      return take_flags(body);
    case 'F':
      return take_definition(body);
    case 'A':
      return subscribe(body);
    case 'D':
      return take_data(body);
    case 'O':
      ++dropouts_;
      dropout_ms_ += body.size() >= 2 ? load_at<std::uint16_t>(body, 0) : 0;
      return {};
    default:
      return {};
  }
}

Status UlogDecoder::take_flags(std::string_view body) {
  constexpr std::size_t kBytes = 40;
  if (body.size() < kBytes) {
    return fail(ErrorCode::ShapeMismatch, "The flags of the ULog file have " + std::to_string(body.size()) +
                                              " bytes instead of " + std::to_string(kBytes) + ".");
  }
  constexpr char kDataAppended = 1;
  const std::string_view must_know = body.substr(8, 8);
  if ((must_know[0] & ~kDataAppended) != 0 || must_know.find_first_not_of('\0', 1) != std::string_view::npos) {
    return fail(ErrorCode::UnsupportedType, "The ULog file uses a feature that is newer than driftlab knows.");
  }
  for (std::size_t i = 0; i < appended_.size() && must_know[0] == kDataAppended; ++i) {
    appended_[i] = load_at<std::uint64_t>(body, 16 + 8 * i);
  }
  return {};
}

Status UlogDecoder::take_definition(std::string_view body) {
  const std::size_t colon = body.find(':');
  definition_bytes_ += body.size();
  if (definition_bytes_ > kMostDefinitionBytes) {
    return fail(ErrorCode::LimitExceeded, "The ULog file declares more than " + std::to_string(kMostDefinitionBytes) +
                                              " bytes of message formats.");
  }
  if (colon != std::string_view::npos) {
    definitions_.insert_or_assign(std::string(body.substr(0, colon)), std::string(body.substr(colon + 1)));
  }
  return {};
}

std::optional<Triad> UlogDecoder::find_triad(const InertialTopic& topic, std::string_view field,
                                             std::string_view interval) const {
  const auto first = ulog::find_field(definitions_, topic.name, field);
  if (!first || first->type != "float") {
    return std::nullopt;
  }
  if (field == "x") {
    for (const std::size_t axis : {std::size_t{1}, std::size_t{2}}) {
      const auto next = ulog::find_field(definitions_, topic.name, axis == 1 ? "y" : "z");
      if (!next || next->type != "float" || next->offset != first->offset + axis * sizeof(float)) {
        return std::nullopt;
      }
    }
  } else if (first->count != 3) {
    return std::nullopt;
  }
  Triad triad{first->offset, std::nullopt};
  if (!interval.empty()) {
    triad.interval_us = ulog::find_field(definitions_, topic.name, interval);
    if (!triad.interval_us || (triad.interval_us->type != "uint16_t" && triad.interval_us->type != "uint32_t")) {
      return std::nullopt;
    }
  }
  return triad;
}

/// Nothing where the topic is not declared as expected.
std::optional<Subscription> UlogDecoder::layout_of(const InertialTopic& topic) const {
  Subscription layout;
  auto stamp = ulog::find_field(definitions_, topic.name, "timestamp_sample");
  stamp = stamp ? stamp : ulog::find_field(definitions_, topic.name, "timestamp");
  if (!stamp || stamp->type != "uint64_t") {
    return std::nullopt;
  }
  layout.stamp = stamp->offset;
  layout.bytes = stamp->offset + sizeof(std::uint64_t);
  const std::array wanted{std::pair(topic.gyro, topic.gyro_interval_us),
                          std::pair(topic.accel, topic.accel_interval_us)};
  for (const auto& [field, interval] : wanted) {
    if (field.empty()) {
      continue;
    }
    const auto triad = find_triad(topic, field, interval);
    if (!triad) {
      return std::nullopt;
    }
    layout.triads.push_back(*triad);
    const std::size_t behind =
        triad->interval_us ? triad->interval_us->offset + (triad->interval_us->type == "uint16_t" ? 2 : 4) : 0;
    layout.bytes = std::max({layout.bytes, triad->offset + 3 * sizeof(float), behind});
  }
  if (const auto place = ulog::find_field(definitions_, topic.name, "temperature");
      place && place->type == "float" && !topic.temperature.empty()) {
    layout.temperature = place->offset;
    layout.bytes = std::max(layout.bytes, place->offset + sizeof(float));
  }
  return layout;
}

Status UlogDecoder::subscribe(std::string_view body) {
  if (body.size() < 4) {
    return {};
  }
  const std::size_t id = load_at<std::uint16_t>(body, 1);
  const std::string_view name = body.substr(3);
  const auto topic =
      std::find_if(kTopics.begin(), kTopics.end(), [name](const InertialTopic& known) { return known.name == name; });
  const std::string label = std::string(name) + " " + std::to_string(static_cast<unsigned char>(body[0]));
  if (name == "sensor_gyro_fifo" || name == "sensor_accel_fifo") {
    burst_topics_.insert_or_assign(id, std::string(name));
    return {};
  }
  if (topic == kTopics.end()) {
    subscribe_fixes(id, name, label);
    return {};
  }
  auto layout = layout_of(*topic);
  if (!layout) {
    return fail(ErrorCode::UnsupportedType,
                "The ULog file declares " + std::string(name) + " otherwise than driftlab knows it.");
  }
  const Inertial holds = topic->accel.empty()  ? Inertial::Gyroscope
                         : topic->gyro.empty() ? Inertial::Accelerometer
                                               : Inertial::Both;
  ColumnNames columns = inertial_columns(holds);
  if (layout->temperature) {
    columns.emplace_back("temperature (degC)");
  }
  auto stream = streams_.add(label, holds, std::move(columns));
  if (!stream) {
    return fail(stream.error());
  }
  layout->stream = *stream;
  if (subscriptions_.size() <= id) {
    subscriptions_.resize(id + 1);
  }
  subscriptions_[id] = std::move(*layout);
  return {};
}

void UlogDecoder::take_fix(std::size_t stream, const ulog::FixLayout& layout, std::string_view data) {
  if (data.size() < layout.bytes) {
    ++short_messages_;
    return;
  }
  std::vector<double> row;
  for (const ulog::FixLayout::Value& value : layout.values) {
    row.push_back(value.unit * ulog::number_at(data, value.place));
  }
  streams_.take_beside(stream, load_at<std::uint64_t>(data, layout.stamp), row);
}

void UlogDecoder::subscribe_fixes(std::size_t id, std::string_view name, const std::string& label) {
  constexpr std::size_t kMostReceivers = 16;
  auto layout = ulog::fix_layout(definitions_, name);
  if (layout && !fixes_.contains(id) && fixes_.size() < kMostReceivers) {
    const std::size_t stream = streams_.add_beside(label, "gnss", layout->columns);
    fixes_.emplace(id, std::pair(stream, std::move(*layout)));
  }
}

Status UlogDecoder::take_data(std::string_view body) {
  if (body.size() < 2) {
    return {};
  }
  const std::size_t id = load_at<std::uint16_t>(body, 0);
  if (id < subscriptions_.size()) {
    if (const std::optional<Subscription>& subscribed = subscriptions_[id]) {
      return take_sample(*subscribed, body.substr(2));
    }
  }
  if (const auto found = fixes_.find(id); found != fixes_.end()) {
    take_fix(found->second.first, found->second.second, body.substr(2));
  }
  if (const auto burst = burst_topics_.find(id); burst != burst_topics_.end()) {
    ++burst_messages_[burst->second];
  }
  return {};
}

Status UlogDecoder::take_sample(const Subscription& layout, std::string_view data) {
  if (data.size() < layout.bytes) {
    ++short_messages_;
    return {};
  }
  std::array<double, 7> row{};
  std::size_t width = 0;
  for (const Triad& triad : layout.triads) {
    double scale = 1.0;
    if (triad.interval_us) {
      const std::size_t at = triad.interval_us->offset;
      const std::uint32_t interval =
          triad.interval_us->type == "uint16_t" ? load_at<std::uint16_t>(data, at) : load_at<std::uint32_t>(data, at);
      scale = interval > 0 ? 1e6 / interval : std::numeric_limits<double>::quiet_NaN();
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row[width++] = scale * static_cast<double>(load_at<float>(data, triad.offset + axis * sizeof(float)));
    }
  }
  if (layout.temperature) {
    row[width++] = load_at<float>(data, *layout.temperature);
  }
  return streams_.take(layout.stream, load_at<std::uint64_t>(data, layout.stamp), std::span(row).first(width));
}

void UlogDecoder::note_quality() {
  if (dropouts_ > 0) {
    sink_.note("The logger dropped messages " + how_often(dropouts_) + ", for " + std::to_string(dropout_ms_) +
               " ms together.");
  }
  if (damaged_bytes_ > 0) {
    sink_.note("The log is damaged: " + with_count(damaged_bytes_, "byte up to the next synchronisation is skipped.",
                                                   "bytes up to the next synchronisation are skipped."));
  }
  if (short_messages_ > 0) {
    sink_.note(with_count(short_messages_, "data message is shorter than its format and left out.",
                          "data messages are shorter than their format and left out."));
  }
  for (const auto& [topic, count] : burst_messages_) {
    sink_.note(with_count(count, "burst", "bursts") + " of " + topic +
               ", in which the sensor is sampled fastest, are left out.");
  }
  if (torn_at_) {
    sink_.note("The log ends within the message at byte " + std::to_string(*torn_at_) +
               ", as after a loss of power; what is before it is read.");
  }
}

Status UlogDecoder::run() {
  if (auto status = take_header(); !status) {
    return status;
  }
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto more = next_message();
    if (!more) {
      return fail(more.error());
    }
    if (!*more) {
      break;
    }
  }
  if (torn_at_ && streams_.empty()) {
    return fail(ErrorCode::Truncated, "The ULog file ends within the message at byte " + std::to_string(*torn_at_) +
                                          ", before any inertial sample.");
  }
  note_quality();
  return streams_.finish(
      burst_messages_.empty()
          ? "The ULog file holds no sample of sensor_combined, vehicle_imu, sensor_gyro or sensor_accel."
          : "The ULog file holds inertial samples in bursts (" + burst_messages_.begin()->first +
                ") alone, which are not read; have the logger write sensor_combined or vehicle_imu.");
}

int sniff(std::string_view head) { return head.starts_with(kMagic) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  return UlogDecoder(source, sink, control).run();
}

}  // namespace

const Format kUlog{"ulog", "PX4 ULog flight log", sniff, decode};

}  // namespace driftlab::formats
