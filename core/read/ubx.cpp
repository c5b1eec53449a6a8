/// The log of a u-blox receiver (.ubx): frames of two sync bytes, class, number, length, payload and a checksum of two
/// bytes, between which NMEA sentences and corrections may stand. Source: u-blox, "u-blox M9 interface description",
/// UBX-19035940, sections 3.2 (frame) and 3.15.13 (NAV-PVT).
///
/// Read is NAV-PVT, a row each: position, velocity and what the receiver believes of both. The time is the GPS time of
/// the week, exact to the millisecond, in the week that the date of the message names, as seconds since 1970; rows
/// before the date is known are left out. Frames with a wrong checksum are counted and skipped.
#include "core/read/formats.hpp"
#include "core/read/little_endian.hpp"
#include "core/signal/with_count.hpp"

#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::string_view kSync = "\xB5\x62";
constexpr std::size_t kHead = 6;       ///< sync, class, number, length
constexpr std::size_t kChecksum = 2;   ///< behind the payload
constexpr std::size_t kLeastPvt = 84;  ///< of protocol 14; later ones add eight bytes
constexpr std::size_t kBatchRows = 1024;
constexpr double kGpsEpoch = 315964800.0;  ///< 1980-01-06, seconds since 1970
constexpr double kGpsWeek = 604800.0;

constexpr std::array<const char*, 17> kNames{
    "time (s)",     "fixType",       "numSV",      "lat (deg)",     "lon (deg)",  "height (m)",
    "hMSL (m)",     "hAcc (m)",      "vAcc (m)",   "velN (m/s)",    "velE (m/s)", "velD (m/s)",
    "gSpeed (m/s)", "headMot (deg)", "sAcc (m/s)", "headAcc (deg)", "pDOP"};

/// The length of the whole frame at the start of `bytes`, 0 where none begins there or it is not all there.
std::size_t frame_at(std::string_view bytes) {
  if (!bytes.starts_with(kSync) || bytes.size() < kHead) {
    return 0;
  }
  const std::size_t whole = kHead + load_at<std::uint16_t>(bytes, 4) + kChecksum;
  return whole <= bytes.size() ? whole : 0;
}

/// Fletcher's checksum over class, number, length and payload.
bool is_sound(std::string_view frame) {
  std::uint8_t a = 0;
  std::uint8_t b = 0;
  for (const char c : frame.substr(2, frame.size() - 2 - kChecksum)) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  return static_cast<std::uint8_t>(frame[frame.size() - 2]) == a && static_cast<std::uint8_t>(frame.back()) == b;
}

int sniff(std::string_view head) {
  std::size_t sound = 0;
  for (std::size_t at = head.find(kSync); at != std::string_view::npos && sound < 2; at = head.find(kSync, at)) {
    const std::size_t whole = frame_at(head.substr(at));
    if (whole > 0 && is_sound(head.substr(at, whole))) {
      ++sound;
      at += whole;
    } else {
      ++at;
    }
  }
  return sound == 2 || (sound == 1 && head.starts_with(kSync)) ? 100 : 0;
}

/// GPS time in seconds since 1970; nothing before the receiver knows the date.
std::optional<double> moment_of(std::string_view pvt) {
  constexpr unsigned kDateAndTime = 3;
  if ((load_at<std::uint8_t>(pvt, 11) & kDateAndTime) != kDateAndTime) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year{load_at<std::uint16_t>(pvt, 4)},
                                         std::chrono::month{load_at<std::uint8_t>(pvt, 6)},
                                         std::chrono::day{load_at<std::uint8_t>(pvt, 7)}};
  if (!date.ok()) {
    return std::nullopt;
  }
  const double days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  const double utc = 86400.0 * days + 3600.0 * load_at<std::uint8_t>(pvt, 8) + 60.0 * load_at<std::uint8_t>(pvt, 9) +
                     load_at<std::uint8_t>(pvt, 10);
  const double of_week = 1e-3 * load_at<std::uint32_t>(pvt, 0);
  // Leap seconds are far less than half a week.
  return kGpsEpoch + kGpsWeek * std::round((utc - kGpsEpoch - of_week) / kGpsWeek) + of_week;
}

class UbxDecoder {
 public:
  explicit UbxDecoder(ColumnSink& sink) : sink_(sink) {}

  Status begin() {
    ColumnLayout layout{{}, true};
    layout.names.assign(kNames.begin(), kNames.end());
    return sink_.begin(layout);
  }

  Status take(std::string_view frame) {
    if (!is_sound(frame)) {
      ++damaged_;
      return {};
    }
    const std::string_view payload = frame.substr(kHead, frame.size() - kHead - kChecksum);
    if (frame[2] != '\x01' || frame[3] != '\x07' || payload.size() < kLeastPvt) {
      return {};
    }
    const auto moment = moment_of(payload);
    if (!moment) {
      ++undated_;
      return {};
    }
    const auto i4 = [&](std::size_t at, double unit) { return unit * load_at<std::int32_t>(payload, at); };
    const auto u4 = [&](std::size_t at, double unit) { return unit * load_at<std::uint32_t>(payload, at); };
    rows_.insert(rows_.end(),
                 {*moment, static_cast<double>(load_at<std::uint8_t>(payload, 20)),
                  static_cast<double>(load_at<std::uint8_t>(payload, 23)), i4(28, 1e-7), i4(24, 1e-7), i4(32, 1e-3),
                  i4(36, 1e-3), u4(40, 1e-3), u4(44, 1e-3), i4(48, 1e-3), i4(52, 1e-3), i4(56, 1e-3), i4(60, 1e-3),
                  i4(64, 1e-5), u4(68, 1e-3), u4(72, 1e-5), 0.01 * load_at<std::uint16_t>(payload, 76)});
    return rows_.size() < kBatchRows * kNames.size() ? Status{} : flush();
  }

  Status finish() {
    if (auto status = flush(); !status) {
      return status;
    }
    if (!delivered_) {
      return fail(ErrorCode::NoSamples,
                  "The u-blox log holds no dated NAV-PVT message; have the receiver write them (UBX-NAV-PVT).");
    }
    sink_.note("Times are GPST, in seconds since 1970.");
    if (damaged_ > 0) {
      sink_.note(with_count(damaged_, "message has a wrong checksum and is left out.",
                            "messages have a wrong checksum and are left out."));
    }
    if (undated_ > 0) {
      sink_.note(with_count(undated_, "message from before the receiver knew the date is left out.",
                            "messages from before the receiver knew the date are left out."));
    }
    return {};
  }

 private:
  Status flush() {
    auto status = rows_.empty() ? Status{} : sink_.rows(rows_);
    delivered_ = delivered_ || !rows_.empty();
    rows_.clear();
    return status;
  }

  ColumnSink& sink_;
  std::vector<double> rows_;
  std::size_t damaged_ = 0, undated_ = 0;
  bool delivered_ = false;
};

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  constexpr std::size_t kLongestFrame = kHead + 65535 + kChecksum;
  UbxDecoder decoder(sink);
  if (auto status = decoder.begin(); !status) {
    return status;
  }
  while (true) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view(kLongestFrame);
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return decoder.finish();
    }
    // All frames that are whole in what is there; a frame that runs over its end comes again with more behind it.
    std::size_t at = 0;
    while (at < view->size()) {
      std::size_t next = view->find(kSync, at);
      if (next == std::string_view::npos) {  // half a sync may stand at the end
        next = view->size() > 1 && view->back() == kSync.front() ? view->size() - 1 : view->size();
        at = next;
        break;
      }
      const std::size_t whole = frame_at(view->substr(next));
      if (whole == 0 && next > 0) {
        at = next;
        break;
      }
      if (whole == 0) {  // it does not fit although all that there is was seen
        at = 1;
        continue;
      }
      const std::string_view frame = view->substr(next, whole);
      if (auto status = decoder.take(frame); !status) {
        return status;
      }
      at = next + (is_sound(frame) ? whole : 1);
    }
    source.consume(at);
  }
}

}  // namespace

const Format kUbx{"ubx", "log of a u-blox receiver (.ubx)", sniff, decode};

}  // namespace driftlab::formats
