#include "core/read/kitti.hpp"

#include "core/read/formats.hpp"
#include "core/read/memory_table.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"
#include "core/read/zip_entries.hpp"
#include "core/signal/missing.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kCells = 30;
constexpr std::size_t kLongestLine = 4096;
constexpr std::string_view kStamps = "oxts/timestamps.txt";
constexpr std::string_view kData = "oxts/data/";

using Moment = std::array<double, kCells>;

/// In the order of dataformat.txt: rates and forces about the unit's axes carry the names of sensors.
constexpr std::array<std::string_view, kCells> kNames{
    "lat (deg)",          "lon (deg)",      "alt (m)",    "roll (rad)", "pitch (rad)", "yaw (rad)",
    "vn (m/s)",           "ve (m/s)",       "vf (m/s)",   "vl (m/s)",   "vu (m/s)",    "acc_x (m/s^2)",
    "acc_y (m/s^2)",      "acc_z (m/s^2)",  "af (m/s^2)", "al (m/s^2)", "au (m/s^2)",  "gyro_x (rad/s)",
    "gyro_y (rad/s)",     "gyro_z (rad/s)", "wf (rad/s)", "wl (rad/s)", "wu (rad/s)",  "pos_accuracy (m)",
    "vel_accuracy (m/s)", "navstat",        "numsats",    "posmode",    "velmode",     "orimode"};

/// The number of a moment, by the name of its file.
std::optional<std::uint64_t> moment_of(std::string_view path) {
  const std::size_t at = path.rfind(kData);
  if (at == std::string_view::npos || !path.ends_with(".txt")) {
    return std::nullopt;
  }
  const std::string_view digits = path.substr(at + kData.size(), path.size() - at - kData.size() - 4);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  return error == std::errc{} && end == digits.data() + digits.size() ? std::optional(number) : std::nullopt;
}

/// The files of one drive, in whatever order they come.
class KittiDrive {
 public:
  explicit KittiDrive(std::size_t budget_bytes) : budget_(budget_bytes) {}

  /// Takes the file if it is one of the unit's. Errors name it.
  Status take(const std::string& path, ByteSource& content, const RunControl& control) {
    const bool stamps = path.ends_with(kStamps);
    const auto number = moment_of(path);
    if (!stamps && !number) {
      return {};
    }
    const std::size_t root = path.rfind("oxts/");
    if (!drive_) {
      drive_ = path.substr(0, root);
    } else if (*drive_ != path.substr(0, root)) {
      return fail(ErrorCode::UnsupportedFormat,
                  "The archive holds the units of several KITTI drives; send their drives one by one.");
    }
    auto status =
        text::for_each_line(content, kLongestLine, control, [&](std::string_view line, std::uint64_t row) -> Status {
          if (text::trim(line).empty()) {
            return {};
          }
          return stamps ? take_stamp(line, row) : take_moment(line, row, *number);
        });
    if (!status) {
      Error error = status.error();
      error.message = "In '" + path.substr(root).substr(0, 100) + "': " + error.message;
      return fail(std::move(error));
    }
    return status;
  }

  [[nodiscard]] Status deliver_to(ColumnSink& sink) const {
    if (moments_.empty() || stamps_.empty()) {
      return fail(ErrorCode::NoSamples,
                  std::string("The KITTI drive holds no ") +
                      (stamps_.empty() ? "dates (oxts/timestamps.txt)." : "samples (oxts/data)."));
    }
    ColumnLayout layout{{"time (s)"}, true};
    layout.names.insert(layout.names.end(), kNames.begin(), kNames.end());
    if (auto status = sink.begin(layout); !status) {
      return status;
    }
    std::size_t delivered = 0;
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      const auto moment = moments_.find(i);
      if (moment == moments_.end()) {
        continue;
      }
      std::vector<double> row{stamps_[i]};
      row.insert(row.end(), moment->second.begin(), moment->second.end());
      if (auto status = sink.rows(row); !status) {
        return status;
      }
      ++delivered;
    }
    if (delivered == 0) {
      return fail(ErrorCode::NoSamples, "No sample of the KITTI drive has a date.");
    }
    sink.note(
        "Axes are those of the unit: forward, left, up. Times are the dates of oxts/timestamps.txt, which say no "
        "zone, in seconds since 1970; positions and velocities are the unit's own solution.");
    if (delivered < stamps_.size()) {
      sink.note(std::to_string(stamps_.size() - delivered) + " dates have no sample and are left out.");
    }
    if (delivered < moments_.size()) {
      sink.note(std::to_string(moments_.size() - delivered) + " samples have no date and are left out.");
    }
    return {};
  }

 private:
  Status take_stamp(std::string_view line, std::uint64_t row) {
    const auto time_s = text::seconds_of_date(text::trim(line));
    if (!time_s) {
      return fail(ErrorCode::NotANumber, "Line " + std::to_string(row) + ": " + text::excerpt(line) + " is no date.",
                  {{"row", std::to_string(row)}});
    }
    stamps_.push_back(*time_s);
    return spend(sizeof(double));
  }

  Status take_moment(std::string_view line, std::uint64_t row, std::uint64_t number) {
    Moment moment{};
    std::size_t cells = 0;
    while (!(line = text::trim(line)).empty()) {
      const std::size_t end = std::min(line.find_first_of(" \t"), line.size());
      const auto value = text::number_of(line.substr(0, end));
      if (!value) {
        return text::not_a_number(row, line.substr(0, end));
      }
      if (cells < kCells) {
        moment[cells] = std::isfinite(*value) ? *value : missing_sample(Missing::Nan, number + 1);
      }
      ++cells;
      line.remove_prefix(end);
    }
    if (cells != kCells) {
      return text::wrong_cells(row, cells, kCells);
    }
    if (!moments_.emplace(number, moment).second) {
      return fail(ErrorCode::ShapeMismatch, "A second line or file for one moment.");
    }
    return spend(sizeof moment);
  }

  Status spend(std::size_t bytes) {
    if (bytes > budget_) {
      return fail(ErrorCode::LimitExceeded, "The KITTI drive holds more samples than can be put together.");
    }
    budget_ -= bytes;
    return {};
  }

  std::size_t budget_;
  std::optional<std::string> drive_;
  std::vector<double> stamps_;
  std::map<std::uint64_t, Moment> moments_;
};

int sniff(std::string_view head) {
  // The cameras come first in a whole drive; each folder has its dates.
  return zip_holds(head, kStamps) || zip_holds(head, "oxts/dataformat.txt") || zip_holds(head, "_00/timestamps.txt") ||
                 zip_holds(head, "oxts/data/0000000000.txt")
             ? 100
             : 0;
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  KittiDrive drive(limits.max_tables_bytes);
  auto status = for_each_zip_entry(
      source, limits, [&](const std::string& path, ByteSource& content) { return drive.take(path, content, control); });
  return status ? drive.deliver_to(sink) : status;
}

/// The drives in the folder of a date.
std::vector<std::filesystem::path> drives_of_date(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> drives;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
    if (std::filesystem::exists(entry.path() / kStamps, ignored)) {
      drives.push_back(entry.path());
    }
  }
  return drives;
}

}  // namespace

bool is_kitti_folder(const std::filesystem::path& folder) {
  std::error_code ignored;
  const bool is_it = folder.filename() == "oxts" || folder.parent_path().filename() == "oxts";
  return std::filesystem::exists(folder / kStamps, ignored) ||
         (is_it && std::filesystem::exists(folder / "timestamps.txt", ignored)) || !drives_of_date(folder).empty();
}

Status decode_kitti_folder(const std::filesystem::path& folder, const DecodeLimits& limits, ColumnSink& sink,
                           const RunControl& control) {
  const auto drives = drives_of_date(folder);
  if (drives.size() > 1) {
    return fail(ErrorCode::UnsupportedFormat, "The directory '" + folder.filename().string() + "' holds " +
                                                  std::to_string(drives.size()) +
                                                  " KITTI drives; name the directory of one of them.");
  }
  const auto& drive_folder = drives.empty() ? folder : drives.front();
  std::error_code error;
  const auto unit = std::filesystem::exists(drive_folder / kStamps, error) ? drive_folder / "oxts" : drive_folder;
  std::vector<std::pair<std::string, std::filesystem::path>> files{{std::string(kStamps), unit / "timestamps.txt"}};
  for (const auto& entry : std::filesystem::directory_iterator(unit / "data", error)) {
    if (entry.is_regular_file(error)) {
      files.emplace_back(std::string(kData) + entry.path().filename().string(), entry.path());
    }
  }
  if (error) {
    return fail(ErrorCode::Io, "The directory '" + folder.filename().string() + "' cannot be read.");
  }
  KittiDrive drive(limits.max_tables_bytes);
  for (const auto& [name, path] : files) {
    auto reader = open_file_reader(path);
    if (!reader) {
      return fail(reader.error());
    }
    ByteSource content(std::move(*reader));
    if (auto status = drive.take(name, content, control); !status) {
      return status;
    }
  }
  return drive.deliver_to(sink);
}

namespace formats {

const Format kKitti{"kitti", "GPS/IMU unit of a KITTI raw drive (oxts)", sniff, decode};

}  // namespace formats

}  // namespace driftlab
