/// ArduPilot DataFlash log (.bin): messages that begin with A3 95 and a number; message 128 (FMT) declares the length,
/// letters and labels of the others. Little-endian. Source: ArduPilot developer documentation, "Log file format".
///
/// Read as inertial streams (core/read/inertial_streams.hpp): IMU, IMU2, ..., and the unfiltered ACC and GYR with what
/// follows their name; each instance (label I) is its own. GyrX GyrY GyrZ [rad/s], AccX AccY AccZ [m/s^2], T or Temp
/// [degC]; time is SampleUS, else TimeUS, else TimeMS, since boot. Beside them stand the receivers' fixes: GPS, each
/// instance, and GPS2, ... of older logs. Batches of raw samples (ISBH, ISBD) are not read.
#include "core/read/dataflash_format.hpp"
#include "core/read/formats.hpp"
#include "core/read/inertial_streams.hpp"
#include "core/read/little_endian.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;
using dataflash::kHead;

constexpr std::string_view kMark = "\xA3\x95"sv;
constexpr unsigned char kFormatNumber = 0x80;
constexpr std::size_t kFormatBytes = 89;

/// How an inertial message becomes a row.
struct Layout {
  std::size_t stamp = 0;
  bool milliseconds = false;
  Inertial holds = Inertial::Both;
  std::vector<std::size_t> floats;  ///< places of the values
  bool temperature = false;
  std::optional<std::size_t> instance;
  std::map<unsigned char, std::size_t> streams;  ///< by instance
};

bool add_triad(const dataflash::Declared& message, std::string_view stem, std::vector<std::size_t>& floats) {
  std::vector<std::size_t> places;
  for (const char axis : "XYZ"sv) {
    if (const auto place = message.find(std::string(stem) + axis, "f")) {
      places.push_back(*place);
    }
  }
  if (places.size() != 3) {
    return false;
  }
  floats.insert(floats.end(), places.begin(), places.end());
  return true;
}

/// How a receiver's message becomes a row.
struct FixLayout {
  std::size_t stamp = 0;
  ColumnNames columns;
  std::vector<dataflash::Field> fields;  ///< of the columns
  std::optional<std::size_t> instance;
  std::map<unsigned char, std::size_t> streams;  ///< by instance
};

/// Nothing where the message holds no fixes.
std::optional<FixLayout> fix_layout_of(const dataflash::Declared& message) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 10> kColumns{{{"Lat", "latitude (deg)"},
                                                                                    {"Lng", "longitude (deg)"},
                                                                                    {"Alt", "altitude (m)"},
                                                                                    {"Spd", "speed (m/s)"},
                                                                                    {"GCrs", "course (deg)"},
                                                                                    {"VZ", "velocity_down (m/s)"},
                                                                                    {"Status", "fix_type"},
                                                                                    {"NSats", "satellites"},
                                                                                    {"GWk", "week"},
                                                                                    {"GMS", "time_of_week (ms)"}}};
  const auto stamp = message.find("TimeUS", "Q");
  if (!message.name.starts_with("GPS") || !stamp || !message.find("Lat", "L") || !message.find("Lng", "L")) {
    return std::nullopt;
  }
  FixLayout layout;
  layout.stamp = *stamp;
  for (const auto& [label, column] : kColumns) {
    if (const auto field = message.fields.find(label);
        field != message.fields.end() && dataflash::is_number(field->second)) {
      layout.columns.emplace_back(column);
      layout.fields.push_back(field->second);
    }
  }
  layout.instance = message.find("I", "B");
  return layout;
}

/// Nothing where the message is not inertial.
std::optional<Layout> layout_of(const dataflash::Declared& message) {
  if (!message.name.starts_with("IMU") && !message.name.starts_with("ACC") && !message.name.starts_with("GYR")) {
    return std::nullopt;
  }
  Layout layout;
  auto stamp = message.find("SampleUS", "Q");
  stamp = stamp ? stamp : message.find("TimeUS", "Q");
  if (!stamp) {
    stamp = message.find("TimeMS", "I");
    layout.milliseconds = true;
  }
  const bool gyro = add_triad(message, "Gyr", layout.floats);
  const bool accel = add_triad(message, "Acc", layout.floats);
  if (!stamp || (!gyro && !accel)) {
    return std::nullopt;
  }
  layout.stamp = *stamp;
  layout.holds = !accel ? Inertial::Gyroscope : gyro ? Inertial::Both : Inertial::Accelerometer;
  auto temperature = message.find("T", "f");
  temperature = temperature ? temperature : message.find("Temp", "f");
  if (temperature) {
    layout.temperature = true;
    layout.floats.push_back(*temperature);
  }
  layout.instance = message.find("I", "B");
  return layout;
}

class DataflashDecoder {
 public:
  DataflashDecoder(ByteSource& source, ColumnSink& sink, const RunControl& control)
      : source_(source), sink_(sink), control_(control), streams_(sink, 1e6) {}

  Status run();

 private:
  Result<bool> next_message();
  Result<bool> resynchronise();
  [[nodiscard]] bool is_message(std::string_view bytes) const {
    return bytes.size() >= kHead && bytes.starts_with(kMark) && bytes_[static_cast<unsigned char>(bytes[2])] > 0;
  }
  void declare(std::string_view body);
  Status take(unsigned char number, std::string_view message);
  void take_fix(FixLayout& layout, const std::string& topic, std::string_view message);

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  InertialStreams streams_;
  std::array<std::size_t, 256> bytes_{};  ///< of a message, by number; 0: not declared
  std::array<std::string, 256> names_;
  std::array<std::optional<Layout>, 256> layouts_;
  std::array<std::optional<FixLayout>, 256> fix_layouts_;
  std::uint64_t damaged_bytes_ = 0;
  std::uint64_t batch_messages_ = 0;
  std::optional<std::uint64_t> torn_at_;
};

/// True while there may be another.
Result<bool> DataflashDecoder::next_message() {
  auto view = source_.view(kHead);
  if (!view) {
    return fail(view.error());
  }
  if (view->empty()) {
    return false;
  }
  if (!is_message(*view)) {
    return resynchronise();
  }
  const auto number = static_cast<unsigned char>((*view)[2]);
  const std::size_t size = bytes_[number];
  view = source_.view(size);
  if (!view) {
    return fail(view.error());
  }
  if (view->size() < size) {
    torn_at_ = source_.offset();
    source_.consume(view->size());
    return true;
  }
  if (number == kFormatNumber) {
    declare(view->substr(kHead, size - kHead));
  } else if (layouts_[number]) {
    if (auto status = take(number, view->substr(0, size)); !status) {
      return fail(status.error());
    }
  } else if (std::optional<FixLayout>& layout = fix_layouts_[number]) {
    take_fix(*layout, names_[number], view->substr(0, size));
  } else if (names_[number] == "ISBH" || names_[number] == "ISBD") {
    ++batch_messages_;
  }
  source_.consume(size);
  return true;
}

/// Goes on at the next mark of a declared message.
Result<bool> DataflashDecoder::resynchronise() {
  source_.consume(1);
  ++damaged_bytes_;
  while (true) {
    auto view = source_.view(kHead);
    if (!view) {
      return fail(view.error());
    }
    if (view->size() < kHead) {
      damaged_bytes_ += view->size();
      source_.consume(view->size());
      return true;
    }
    const std::size_t found = std::min(view->find(kMark), view->size() - 1);
    const std::size_t step = found > 0 ? found : is_message(*view) ? 0 : 1;
    if (step == 0) {
      return true;
    }
    damaged_bytes_ += step;
    source_.consume(step);
  }
}

void DataflashDecoder::declare(std::string_view body) {
  const auto number = static_cast<unsigned char>(body[0]);
  const std::size_t size = static_cast<unsigned char>(body[1]);
  if (number == kFormatNumber || size < kHead || bytes_[number] > 0) {
    return;
  }
  bytes_[number] = size;
  if (const auto message = dataflash::declared_by(body)) {
    names_[number] = message->name;
    layouts_[number] = layout_of(*message);
    fix_layouts_[number] = fix_layout_of(*message);
  }
}

Status DataflashDecoder::take(unsigned char number, std::string_view message) {
  std::optional<Layout>& declared = layouts_[number];
  if (!declared) {
    return {};
  }
  Layout& layout = *declared;
  const unsigned char instance = layout.instance ? static_cast<unsigned char>(message[*layout.instance]) : 0;
  auto stream = layout.streams.find(instance);
  if (stream == layout.streams.end()) {
    ColumnNames columns = inertial_columns(layout.holds);
    if (layout.temperature) {
      columns.emplace_back("temperature (degC)");
    }
    auto added = streams_.add(names_[number] + (layout.instance ? " " + std::to_string(instance) : ""), layout.holds,
                              std::move(columns));
    if (!added) {
      return fail(added.error());
    }
    stream = layout.streams.emplace(instance, *added).first;
  }
  std::array<double, 7> row{};
  for (std::size_t i = 0; i < layout.floats.size(); ++i) {
    row[i] = load_at<float>(message, layout.floats[i]);
  }
  const std::uint64_t stamp = layout.milliseconds ? std::uint64_t{load_at<std::uint32_t>(message, layout.stamp)} * 1000
                                                  : load_at<std::uint64_t>(message, layout.stamp);
  return streams_.take(stream->second, stamp, std::span(row).first(layout.floats.size()));
}

void DataflashDecoder::take_fix(FixLayout& layout, const std::string& topic, std::string_view message) {
  const unsigned char instance = layout.instance ? static_cast<unsigned char>(message[*layout.instance]) : 0;
  auto stream = layout.streams.find(instance);
  if (stream == layout.streams.end()) {
    const std::string name = topic + (layout.instance ? " " + std::to_string(instance) : "");
    stream = layout.streams.emplace(instance, streams_.add_beside(name, "gnss", layout.columns)).first;
  }
  std::vector<double> row;
  for (const dataflash::Field& field : layout.fields) {
    row.push_back(dataflash::number_at(message, field));
  }
  streams_.take_beside(stream->second, load_at<std::uint64_t>(message, layout.stamp), row);
}

Status DataflashDecoder::run() {
  bytes_[kFormatNumber] = kFormatBytes;
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
    return fail(ErrorCode::Truncated, "The DataFlash log ends within the message at byte " + std::to_string(*torn_at_) +
                                          ", before any inertial sample.");
  }
  if (damaged_bytes_ > 0) {
    sink_.note(with_count(damaged_bytes_, "byte of the log is no message and is skipped.",
                          "bytes of the log are no messages and are skipped."));
  }
  if (torn_at_) {
    sink_.note("The log ends within the message at byte " + std::to_string(*torn_at_) +
               ", as after a loss of power; what is before it is read.");
  }
  if (batch_messages_ > 0) {
    sink_.note(with_count(batch_messages_, "message of raw batches (ISBH, ISBD) is left out.",
                          "messages of raw batches (ISBH, ISBD), in which the unit is sampled fastest, are left out."));
  }
  return streams_.finish(batch_messages_ > 0
                             ? "The DataFlash log holds inertial samples in raw batches (ISBH, ISBD) alone, which are "
                               "not read; have the autopilot log IMU messages (LOG_BITMASK)."
                             : "The DataFlash log holds no IMU, ACC or GYR message that can be read.");
}

int sniff(std::string_view head) { return head.starts_with("\xA3\x95\x80"sv) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  return DataflashDecoder(source, sink, control).run();
}

}  // namespace

const Format kDataflash{"dataflash", "ArduPilot DataFlash log (.bin)", sniff, decode};

}  // namespace driftlab::formats
