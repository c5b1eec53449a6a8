#include "core/read/phone_export.hpp"

#include "core/read/formats.hpp"
#include "core/read/phone_fixes.hpp"
#include "core/read/zip_entries.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/text.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace driftlab {
namespace {

std::string squashed(std::string_view text) {
  std::string letters;
  for (const char c : lower_case(text)) {
    if (c >= 'a' && c <= 'z') {
      letters += c;
    }
  }
  return letters;
}

/// The file's name without folder and extension.
std::string stem(const std::string& path) {
  const std::size_t slash = path.find_last_of("/\\");
  const std::string name = path.substr(slash == std::string::npos ? 0 : slash + 1);
  return name.substr(0, name.rfind('.'));
}

/// What a file of the export holds, best source first among those of one sensor.
struct SensorFile {
  std::string_view stem;    ///< letters only
  std::string_view sensor;  ///< the name its columns get
  std::string_view unit;    ///< of Sensor Logger, which states none; empty: by size
};

constexpr std::array kSensorFiles{
    SensorFile{"gyroscope", "Gyroscope", "rad/s"},
    SensorFile{"gyroscopeuncalibrated", "Gyroscope", "rad/s"},
    SensorFile{"rawgyroscope", "Gyroscope", "rad/s"},
    SensorFile{"accelerometeruncalibrated", "Accelerometer", ""},
    SensorFile{"rawaccelerometer", "Accelerometer", ""},
    SensorFile{"totalacceleration", "Accelerometer", "m/s^2"},
    SensorFile{"accelerometer", "Accelerometer", "m/s^2"},
    SensorFile{"magnetometer", "Magnetometer", "uT"},
    SensorFile{"magnetometeruncalibrated", "Magnetometer", "uT"},
};

const SensorFile* find_sensor(const std::string& name) {
  const std::string letters = squashed(name);
  const auto found = std::find_if(kSensorFiles.begin(), kSensorFiles.end(),
                                  [&](const SensorFile& file) { return file.stem == letters; });
  return found == kSensorFiles.end() ? nullptr : &*found;
}

/// One sensor on its own clock.
struct Sensor {
  std::string name;
  std::vector<double> time_s;
  ColumnNames names;
  std::vector<std::vector<double>> columns;
  double dt_s = 0.0;
};

double mean_step(const std::vector<double>& time) {
  return time.size() < 2 ? 0.0 : (time.back() - time.front()) / static_cast<double>(time.size() - 1);
}

/// Median length of the first vectors.
double typical_length(const std::vector<std::vector<double>>& axes) {
  std::vector<double> lengths;
  for (std::size_t i = 0; i < std::min<std::size_t>(axes.front().size(), 1000); ++i) {
    double square = 0.0;
    for (const auto& axis : axes) {
      square += axis[i] * axis[i];
    }
    if (std::isfinite(square)) {
      lengths.push_back(std::sqrt(square));
    }
  }
  if (lengths.empty()) {
    return 0.0;
  }
  std::nth_element(lengths.begin(), lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2), lengths.end());
  return lengths[lengths.size() / 2];
}

/// The sensor in a table, its columns named and with units; nothing if the table has no time or no axes.
std::optional<Sensor> read_sensor(MemoryTable& table, const SensorFile& file) {
  Sensor sensor;
  sensor.name = stem(table.name);
  std::optional<std::size_t> time;
  std::vector<std::pair<std::string, std::size_t>> axes;  // "X (rad/s)" or "x", and its column
  bool logger = false;
  for (std::size_t i = 0; i < table.names.size(); ++i) {
    const std::string& name = table.names[i];
    const ColumnRole role = infer_role(name);
    if (role.quantity == Quantity::Time && role.unit && role.unit->dimension == Dimension::Time) {
      time = i;
      logger = squashed(name) == "secondselapsed";
    } else if (!name.empty() &&
               std::string_view("xyz").find(static_cast<char>(name[0] | 0x20)) != std::string_view::npos &&
               (name.size() == 1 || name[1] == ' ')) {
      axes.emplace_back(name, i);
    }
  }
  if (!time || axes.empty()) {
    return std::nullopt;
  }
  std::sort(axes.begin(), axes.end());
  sensor.time_s = std::move(table.columns[*time]);
  for (const auto& [name, column] : axes) {
    sensor.columns.push_back(std::move(table.columns[column]));
  }
  std::string unit(file.unit);
  if (unit.empty()) {
    unit = typical_length(sensor.columns) < 4.0 ? "g" : "m/s^2";
  }
  // Sensor Logger's Accelerometer is without gravity; its columns must not pass for specific forces.
  const bool linear = logger && file.stem == "accelerometer";
  for (const auto& [name, column] : axes) {
    std::string full(linear ? std::string_view("Linear acceleration") : file.sensor);
    full.append(" ").append(name);
    if (name.size() == 1) {
      full.append(" (").append(unit).append(")");
    }
    sensor.names.push_back(std::move(full));
  }
  sensor.dt_s = mean_step(sensor.time_s);
  return sensor;
}

/// `values` moved by `shift` rows and cut or filled up to `rows`; what is not there is missing.
std::vector<double> placed(const std::vector<double>& values, std::ptrdiff_t shift, std::size_t rows) {
  std::vector<double> moved(rows);
  for (std::size_t i = 0; i < rows; ++i) {
    const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(i) - shift;
    const bool there = from >= 0 && from < static_cast<std::ptrdiff_t>(values.size());
    moved[i] = there ? values[static_cast<std::size_t>(from)] : missing_sample(Missing::Ended, i + 1);
  }
  return moved;
}

std::string seconds(double value) {
  std::array<char, 32> buffer{};
  const int size = std::snprintf(buffer.data(), buffer.size(), "%.4f s", value);
  return {buffer.data(), static_cast<std::size_t>(std::max(size, 0))};
}

/// The fixes of the best table that holds some, whose name is cleared.
std::optional<PhoneFixes> take_fixes(std::vector<MemoryTable>& tables) {
  const auto worth = [](const MemoryTable& table) {
    return table.columns.empty() ? 0 : holds_fixes(squashed(stem(table.name)));
  };
  const auto best = std::max_element(tables.begin(), tables.end(),
                                     [&](const MemoryTable& a, const MemoryTable& b) { return worth(a) < worth(b); });
  if (best == tables.end() || worth(*best) == 0) {
    return std::nullopt;
  }
  auto fixes = read_fixes(*best);
  if (fixes) {
    best->name.clear();
  }
  return fixes;
}

/// Puts the sensors beside the first, and the fixes, which have a clock of their own rhythm, behind them.
Status deliver_sensors(std::vector<Sensor> sensors, const std::optional<PhoneFixes>& fixes, const DecodeLimits& limits,
                       ColumnSink& sink) {
  const Sensor& first = sensors.front();
  const std::size_t rows = first.time_s.size();
  Recorded recorded;
  recorded.names.emplace_back("time (s)");
  recorded.columns.emplace_back(first.time_s);
  std::vector<std::vector<double>> kept;
  kept.reserve(3 * sensors.size() + (fixes ? fixes->columns.size() : 0));
  for (Sensor& sensor : sensors) {
    if (sensor.time_s.empty() || !(std::abs(sensor.dt_s / first.dt_s - 1.0) <= 0.01) || first.dt_s <= 0.0) {
      if (&sensor != &first) {
        sink.note("'" + sensor.name + "' is left out: it has another rate than '" + first.name + "'.");
        continue;
      }
    }
    const double late = sensor.time_s.front() - first.time_s.front();
    const double steps = first.dt_s > 0.0 ? std::round(late / first.dt_s) : 0.0;
    if (!(std::abs(steps) < static_cast<double>(rows))) {
      sink.note("'" + sensor.name + "' is left out: it was not recorded at the same time as '" + first.name + "'.");
      continue;
    }
    const auto shift = static_cast<std::ptrdiff_t>(steps);
    if (&sensor != &first) {
      sink.note("'" + sensor.name + "' starts " + seconds(late) + " after '" + first.name + "' and has " +
                with_count(sensor.time_s.size(), "sample") + " beside " + std::to_string(rows) +
                "; its rows are set beside those by number, not resampled.");
    }
    for (std::size_t i = 0; i < sensor.columns.size(); ++i) {
      recorded.names.push_back(sensor.names[i]);
      kept.push_back(placed(sensor.columns[i], shift, rows));
      recorded.columns.emplace_back(kept.back());
    }
  }
  if (fixes) {
    if (fixes->columns.front().size() > rows) {
      sink.note("The export holds " + with_count(fixes->columns.front().size(), "fix", "fixes") +
                " and fewer rows of '" + first.name + "'; the last " +
                std::to_string(fixes->columns.front().size() - rows) + " are left out.");
    }
    for (std::size_t i = 0; i < fixes->columns.size(); ++i) {
      recorded.names.push_back(fixes->names[i]);
      kept.push_back(placed(fixes->columns[i], 0, rows));
      recorded.columns.emplace_back(kept.back());
    }
  }
  return deliver(recorded, limits, sink);
}

/// True for what phyphox says of the phone and of the start and end of the recording: `meta/device.csv`.
bool is_about_the_export(std::string_view path) {
  return path.starts_with("meta/") || path.find("/meta/") != std::string_view::npos;
}

/// One table of the export, if it is wanted.
Status take_file(const std::string& path, ByteSource& content, const DecodeLimits& limits, std::size_t& budget,
                 const RunControl& control, std::vector<MemoryTable>& tables) {
  if ((!path.ends_with(".csv") && !path.ends_with(".CSV")) || is_about_the_export(path)) {
    return {};
  }
  MemoryTable table;
  table.name = path;
  MemorySink into(table, budget);
  auto status = formats::kCsv.decode(content, limits, into, control);
  if (!status) {
    const ErrorCode code = status.error().code;
    const bool unread = code == ErrorCode::LimitExceeded || code == ErrorCode::Cancelled ||
                        code == ErrorCode::Truncated || code == ErrorCode::CorruptCompression ||
                        code == ErrorCode::DecompressionLimit || code == ErrorCode::Io;
    if (unread || is_sensor_file(path)) {
      Error error = status.error();
      error.message = "In '" + stem(path).substr(0, 100) + ".csv': " + error.message;
      return fail(std::move(error));
    }
    return {};  // notes of the user, an empty file
  }
  tables.push_back(std::move(table));
  return {};
}

int sniff_zip(std::string_view head) {
  const bool another =
      zip_holds(head, ".npy") || zip_holds(head, "[Content_Types].xml") || formats::kEurocZip.sniff(head) > 0;
  return zip_holds(head, ".csv") && !another ? 100 : 0;
}

Status decode_zip(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  std::vector<MemoryTable> tables;
  std::size_t budget = limits.max_tables_bytes;
  auto status = for_each_zip_entry(source, limits, [&](const std::string& path, ByteSource& content) {
    return take_file(path, content, limits, budget, control, tables);
  });
  return status ? deliver_phone_export(std::move(tables), limits, sink) : status;
}

}  // namespace

bool is_sensor_file(const std::string& path) { return find_sensor(stem(path)) != nullptr; }

Status deliver_phone_export(std::vector<MemoryTable> tables, const DecodeLimits& limits, ColumnSink& sink,
                            const std::string& container) {
  std::vector<Sensor> sensors;
  std::string left_out;
  std::vector<std::string_view> taken;
  for (const SensorFile& file : kSensorFiles) {
    for (MemoryTable& table : tables) {
      if (squashed(stem(table.name)) != file.stem || table.columns.empty()) {
        continue;
      }
      const bool again = std::find(taken.begin(), taken.end(), file.sensor) != taken.end();
      auto sensor = again ? std::nullopt : read_sensor(table, file);
      if (sensor) {
        taken.push_back(file.sensor);
        sensors.push_back(std::move(*sensor));
        table.name.clear();
      }
    }
  }
  if (sensors.empty()) {
    if (tables.size() != 1) {
      return fail(tables.empty() ? ErrorCode::NoSamples : ErrorCode::UnsupportedFormat,
                  tables.empty()
                      ? "The " + container + " holds no table of samples."
                      : "The " + container + " holds " + std::to_string(tables.size()) +
                            " tables and none is that of a phone's gyroscope or accelerometer; send them one by one.");
    }
    MemoryTable& only = tables.front();
    for (std::string& note : only.notes) {
      sink.note(std::move(note));
    }
    return deliver({only.names, {only.columns.begin(), only.columns.end()}, std::nullopt}, limits, sink);
  }
  const std::optional<PhoneFixes> fixes = take_fixes(tables);
  for (const MemoryTable& table : tables) {
    if (!table.name.empty()) {
      left_out += (left_out.empty() ? "'" : ", '") + stem(table.name) + "'";
    }
  }
  if (!left_out.empty()) {
    sink.note("Left out, as computed by the phone, given twice or no sensor: " + left_out + ".");
  }
  return deliver_sensors(std::move(sensors), fixes, limits, sink);
}

Status decode_folder(const std::filesystem::path& folder, const DecodeLimits& limits, ColumnSink& sink,
                     const RunControl& control) {
  std::vector<std::filesystem::path> paths;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error)) {
      paths.push_back(entry.path());
    }
  }
  if (error) {
    return fail(ErrorCode::Io, "The directory '" + folder.filename().string() + "' cannot be read.");
  }
  std::sort(paths.begin(), paths.end());
  std::vector<MemoryTable> tables;
  std::size_t budget = limits.max_tables_bytes;
  for (const std::filesystem::path& path : paths) {
    auto reader = open_file_reader(path);
    if (!reader) {
      return fail(reader.error());
    }
    ByteSource content(std::move(*reader));
    if (auto status = take_file(path.filename().string(), content, limits, budget, control, tables); !status) {
      return status;
    }
  }
  return deliver_phone_export(std::move(tables), limits, sink, "directory");
}

namespace formats {

const Format kPhoneZip{"phone_zip", "ZIP archive of CSV files, as phyphox and Sensor Logger export them", sniff_zip,
                       decode_zip};

}  // namespace formats

}  // namespace driftlab
