/// Sentences of a receiver (NMEA 0183): lines that begin with $, a talker of two letters and a kind of three, and end
/// with a checksum. Source: SiRF, "NMEA Reference Manual", 1050-0042.
///
/// Read are GGA (position, quality), RMC (speed, course, date) and GST (standard deviations). Sentences of one time of
/// the day are one row; what none of them says is missing. The date is that of RMC: times are UTC in seconds since
/// 1970, or, in a log that never says a date, seconds of the first day. Lines that are no sentence or whose checksum is
/// wrong are counted and skipped.
#include "core/read/formats.hpp"
#include "core/read/text_lines.hpp"
#include "core/read/text_numbers.hpp"
#include "core/signal/missing.hpp"
#include "core/signal/with_count.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::size_t kLongestSentence = 1024;  ///< 82 by the standard, which nobody keeps
constexpr std::size_t kMostCells = 32;
constexpr std::size_t kUndatedRows = 64;  ///< that wait for a date
constexpr std::size_t kBatchRows = 1024;
constexpr double kDay = 86400.0;
constexpr double kKnot = 1852.0 / 3600.0;  ///< [m/s]

enum Column : std::size_t {
  Time,
  Latitude,
  Longitude,
  Height,
  Altitude,
  Quality,
  Satellites,
  Hdop,
  Speed,
  Course,
  SdNorth,
  SdEast,
  SdUp,
  Columns
};
constexpr std::array<const char*, Columns> kNames{
    "time (s)", "latitude (deg)", "longitude (deg)", "height (m)",   "altitude (m)", "quality",  "satellites",
    "hdop",     "speed (m/s)",    "course (deg)",    "sd north (m)", "sd east (m)",  "sd up (m)"};

int hex_of(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                : -1;
}

/// What stands between $ and *, where the checksum is right or absent.
std::optional<std::string_view> sentence_of(std::string_view line) {
  if (line.size() < 7 || line.front() != '$') {
    return std::nullopt;
  }
  const std::size_t star = line.find('*');
  const std::string_view body = line.substr(1, (star == std::string_view::npos ? line.size() : star) - 1);
  if (star == std::string_view::npos) {
    return body;
  }
  unsigned sum = 0;
  for (const char c : body) {
    sum ^= static_cast<unsigned char>(c);
  }
  const bool stated = star + 2 < line.size() && hex_of(line[star + 1]) >= 0 && hex_of(line[star + 2]) >= 0;
  return stated && sum == static_cast<unsigned>(16 * hex_of(line[star + 1]) + hex_of(line[star + 2]))
             ? std::optional(body)
             : std::nullopt;
}

using Cells = std::vector<std::string_view>;

Cells cells_of_sentence(std::string_view body) {
  Cells cells;
  while (cells.size() < kMostCells) {
    const std::size_t comma = body.find(',');
    cells.push_back(body.substr(0, comma));
    if (comma == std::string_view::npos) {
      break;
    }
    body.remove_prefix(comma + 1);
  }
  return cells;
}

std::optional<double> number_at(const Cells& cells, std::size_t at) {
  const auto value = at < cells.size() ? text::number_of(cells[at]) : std::nullopt;
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Seconds of the day of `hhmmss.ss`.
std::optional<double> time_of_day(const Cells& cells, std::size_t at) {
  const auto value = at < cells.size() && cells[at].size() >= 6 ? number_at(cells, at) : std::nullopt;
  if (!value || *value < 0.0 || *value >= 240000.0) {
    return std::nullopt;
  }
  const double hours = std::floor(*value / 10000.0);
  const double minutes = std::floor((*value - 10000.0 * hours) / 100.0);
  return 3600.0 * hours + 60.0 * minutes + (*value - 10000.0 * hours - 100.0 * minutes);
}

/// Degrees of `dddmm.mmmm` and a letter.
std::optional<double> angle_at(const Cells& cells, std::size_t at) {
  const auto value = number_at(cells, at);
  if (!value || at + 1 >= cells.size() || cells[at + 1].size() != 1) {
    return std::nullopt;
  }
  const double degrees = std::floor(*value / 100.0);
  const double angle = degrees + (*value - 100.0 * degrees) / 60.0;
  const char side = cells[at + 1].front();
  return side == 'S' || side == 'W' ? -angle : angle;
}

/// Seconds since 1970 at the beginning of the day `ddmmyy`.
std::optional<double> day_of(const Cells& cells, std::size_t at) {
  if (at >= cells.size() || cells[at].size() != 6) {
    return std::nullopt;
  }
  const auto written = number_at(cells, at);
  if (!written || *written < 0.0) {
    return std::nullopt;
  }
  const auto number = static_cast<unsigned>(*written);
  const int year = static_cast<int>(number % 100);
  const std::chrono::year_month_day date{std::chrono::year{year + (year < 80 ? 2000 : 1900)},
                                         std::chrono::month{number / 100 % 100}, std::chrono::day{number / 10000}};
  return date.ok() ? std::optional(kDay * static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()))
                   : std::nullopt;
}

std::string_view kind_of(std::string_view body) { return body.size() > 5 && body[5] == ',' ? body.substr(2, 3) : ""; }

bool is_read(std::string_view kind) { return kind == "GGA" || kind == "RMC" || kind == "GST"; }

int sniff(std::string_view head) {
  std::size_t sentences = 0;
  std::size_t others = 0;
  for (std::size_t lines = 0; lines < 200 && !head.empty(); ++lines) {
    const std::size_t end = std::min(head.find('\n'), head.size());
    const bool whole = end < head.size() || lines == 0;
    const std::string_view line = text::trim(head.substr(0, end));
    const auto body = sentence_of(line);
    sentences += body && line.find('*') != std::string_view::npos && !kind_of(*body).empty() ? 1 : 0;
    others += !body && !line.empty() && whole ? 1 : 0;
    head.remove_prefix(std::min(end + 1, head.size()));
  }
  return sentences > 0 && sentences >= 4 * others ? 100 : 0;
}

class NmeaDecoder {
 public:
  explicit NmeaDecoder(ColumnSink& sink) : sink_(sink) {}

  Status begin() {
    ColumnLayout layout{{}, true};
    layout.names.assign(kNames.begin(), kNames.end());
    return sink_.begin(layout);
  }

  Status take(std::string_view line, std::uint64_t number) {
    const std::string_view trimmed = text::trim(line);
    const auto body = sentence_of(trimmed);
    if (!body || body->size() < 6) {
      skipped_ += trimmed.empty() ? 0 : 1;
      return {};
    }
    const std::string_view kind = kind_of(*body);
    if (!is_read(kind)) {
      return {};
    }
    const Cells cells = cells_of_sentence(*body);
    const auto time = time_of_day(cells, 1);
    if (!time) {
      return {};  // the receiver does not know it yet
    }
    if (!open_ || row_[Time] != *time) {
      if (auto status = close(); !status) {
        return status;
      }
      row_.fill(missing_sample(Missing::Nan, number));
      row_[Time] = *time;
      open_ = true;
    }
    fill(kind, cells);
    return {};
  }

  Status finish() {
    auto status = close();
    status = status ? deliver(waiting_) : status;
    if (!status) {
      return status;
    }
    if (!delivered_) {
      return fail(ErrorCode::NoSamples, "The NMEA log holds no GGA, RMC or GST sentence with a time.");
    }
    sink_.note(day_ ? "Times are UTC, in seconds since 1970."
                    : "No sentence says a date: times are seconds of the day.");
    if (skipped_ > 0) {
      sink_.note(with_count(skipped_, "line is no sentence or has a wrong checksum and is left out.",
                            "lines are no sentences or have a wrong checksum and are left out."));
    }
    return {};
  }

 private:
  void fill(std::string_view kind, const Cells& cells) {
    const auto put = [&](Column column, std::optional<double> value, double unit = 1.0) {
      if (value) {
        row_[column] = unit * *value;
      }
    };
    if (kind == "GGA") {
      put(Latitude, angle_at(cells, 2));
      put(Longitude, angle_at(cells, 4));
      put(Quality, number_at(cells, 6));
      put(Satellites, number_at(cells, 7));
      put(Hdop, number_at(cells, 8));
      put(Altitude, number_at(cells, 9));
      const auto altitude = number_at(cells, 9);
      const auto separation = number_at(cells, 11);
      put(Height, altitude && separation ? std::optional(*altitude + *separation) : std::nullopt);
    } else if (kind == "RMC") {
      if (cells.size() > 2 && cells[2] == "A") {
        put(Latitude, angle_at(cells, 3));
        put(Longitude, angle_at(cells, 5));
        put(Speed, number_at(cells, 7), kKnot);
        put(Course, number_at(cells, 8));
      }
      if (const auto day = day_of(cells, 9)) {
        said_day_ = day;
      }
    } else {
      put(SdNorth, number_at(cells, 6));
      put(SdEast, number_at(cells, 7));
      put(SdUp, number_at(cells, 8));
    }
  }

  /// The open row with its date: that of its own RMC, else that of the row before, one on where the day has ended.
  Status close() {
    if (!open_) {
      return {};
    }
    open_ = false;
    const double time = row_[Time];
    if (said_day_) {
      if (!day_ && !delivered_) {  // rows of the same day that had to wait
        for (std::size_t at = 0; at < waiting_.size(); at += Columns) {
          waiting_[at] += *said_day_ - days_ * kDay;
        }
      }
      if (day_ || !delivered_) {
        day_ = said_day_;
        days_ = 0.0;
      }
    } else if (time < last_time_ - 0.5 * kDay) {
      days_ += 1.0;
    }
    said_day_.reset();
    last_time_ = time;
    row_[Time] = day_.value_or(0.0) + days_ * kDay + time;
    waiting_.insert(waiting_.end(), row_.begin(), row_.end());
    const std::size_t most = Columns * (day_ || delivered_ ? kBatchRows : kUndatedRows);
    return waiting_.size() < most ? Status{} : deliver(waiting_);
  }

  Status deliver(std::vector<double>& rows) {
    auto status = rows.empty() ? Status{} : sink_.rows(rows);
    delivered_ = delivered_ || !rows.empty();
    rows.clear();
    return status;
  }

  ColumnSink& sink_;
  std::array<double, Columns> row_{};
  bool open_ = false;
  std::optional<double> said_day_;  ///< in the open row
  std::optional<double> day_;       ///< of the last row
  double days_ = 0.0;               ///< that have ended since
  double last_time_ = 0.0;
  std::vector<double> waiting_;
  std::size_t skipped_ = 0;
  bool delivered_ = false;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  NmeaDecoder decoder(sink);
  if (auto status = decoder.begin(); !status) {
    return status;
  }
  auto status =
      text::for_each_line(source, kLongestSentence, control,
                          [&](std::string_view line, std::uint64_t number) { return decoder.take(line, number); });
  return status ? decoder.finish() : status;
}

}  // namespace

const Format kNmea{"nmea", "sentences of a receiver (NMEA 0183)", sniff, decode};

}  // namespace driftlab::formats
