/// The log of a u-blox receiver (.ubx): frames of two sync bytes, class, number, length, payload and a checksum of two
/// bytes, between which NMEA sentences and corrections may stand. Source: u-blox, "u-blox M9 interface description",
/// UBX-19035940, sections 3.2 (frame) and 3.15.13 (NAV-PVT).
///
/// Read is NAV-PVT, a row each: position, velocity and what the receiver believes of both. The time is the GPS time of
/// the week, exact to the millisecond, in the week that the date of the message names, as seconds since 1970; rows
/// before the date is known are left out. Frames with a wrong checksum are counted and skipped. A log without a dated
/// NAV-PVT is read by its NMEA sentences, where it holds some; one of raw measurements is led to RTKLIB.
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

/// Fletcher's checksums of any frame among `bytes`, in constant time each: bytes that look like the beginnings of long
/// frames, one behind the other, would otherwise be added up tens of thousands of times.
///
/// With A_k the sum of the first k bytes and B_k that of A_1 to A_k, all modulo 256, the two checksums of n bytes from
/// i on are A_(i+n) - A_i and B_(i+n) - B_i - n A_i.
class FletcherSums {
 public:
  explicit FletcherSums(std::string_view bytes) : bytes_(bytes), sums_(bytes.size() + 1) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      const auto a = static_cast<std::uint8_t>(sums_[i].a + static_cast<std::uint8_t>(bytes[i]));
      sums_[i + 1] = {a, static_cast<std::uint8_t>(sums_[i].b + a)};
    }
  }
  /// Of the frame of `whole` bytes at `at`: over class, number, length and payload.
  [[nodiscard]] bool is_sound(std::size_t at, std::size_t whole) const {
    const Sums before = sums_[at + kSync.size()];
    const std::size_t end = at + whole - kChecksum;
    const std::size_t count = end - at - kSync.size();
    return static_cast<std::uint8_t>(sums_[end].a - before.a) == static_cast<std::uint8_t>(bytes_[end]) &&
           static_cast<std::uint8_t>(sums_[end].b - before.b - count * before.a) ==
               static_cast<std::uint8_t>(bytes_[end + 1]);
  }

 private:
  struct Sums {
    std::uint8_t a = 0;
    std::uint8_t b = 0;
  };
  std::string_view bytes_;
  std::vector<Sums> sums_;
};

int sniff(std::string_view head) {
  const FletcherSums sums(head);
  std::size_t sound = 0;
  for (std::size_t at = head.find(kSync); at != std::string_view::npos && sound < 2; at = head.find(kSync, at)) {
    const std::size_t whole = frame_at(head.substr(at));
    const bool frame = whole > 0 && sums.is_sound(at, whole);
    sound += frame ? 1 : 0;
    at += frame ? whole : 1;
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

/// The sentences among the bytes between frames: from a dollar sign to the end of its line, printable, at most as long
/// as a sentence with room to spare.
class SentenceCollector {
 public:
  explicit SentenceCollector(std::size_t budget_bytes) : budget_(budget_bytes) {}

  void take(std::string_view bytes) {
    for (const char c : bytes) {
      if (c == '$') {
        line_ = "$";
      } else if (c == '\n' && !line_.empty()) {
        end_line();
      } else if (!line_.empty()) {
        if (line_.size() < kLongest && (c == '\r' || (c >= ' ' && c <= '~'))) {
          line_ += c;
        } else {
          line_.clear();
        }
      }
    }
  }
  /// No more are wanted.
  void close() {
    budget_ = 0;
    sentences_.clear();
    sentences_.shrink_to_fit();
  }
  [[nodiscard]] const std::string& sentences() const { return sentences_; }

 private:
  static constexpr std::size_t kLongest = 256;

  void end_line() {
    line_ += '\n';
    if (line_.size() <= budget_) {
      budget_ -= line_.size();
      sentences_ += line_;
    }
    line_.clear();
  }

  std::size_t budget_;
  std::string line_;
  std::string sentences_;
};

class UbxDecoder {
 public:
  UbxDecoder(ColumnSink& sink, const DecodeLimits& limits, const RunControl& control)
      : sink_(sink), limits_(limits), control_(control), between_(limits.max_tables_bytes) {}

  void take_between(std::string_view bytes) { between_.take(bytes); }

  void take_damaged() { ++damaged_; }

  /// A frame whose checksum is right.
  Status take(std::string_view frame) {
    const std::string_view payload = frame.substr(kHead, frame.size() - kHead - kChecksum);
    raw_ = raw_ || (frame[2] == '\x02' && (frame[3] == '\x15' || frame[3] == '\x10'));
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
      return finish_without_pvt();
    }
    sink_.note("Times are GPST, in seconds since 1970.");
    note_damaged();
    if (undated_ > 0) {
      sink_.note(with_count(undated_, "message from before the receiver knew the date is left out.",
                            "messages from before the receiver knew the date are left out."));
    }
    return {};
  }

 private:
  void note_damaged() {
    if (damaged_ > 0) {
      sink_.note(with_count(damaged_, "message has a wrong checksum and is left out.",
                            "messages have a wrong checksum and are left out."));
    }
  }
  Status finish_without_pvt() {
    ByteSource sentences(make_memory_reader(between_.sentences()));
    if (kNmea.sniff(between_.sentences()) > 0) {
      auto status = kNmea.decode(sentences, limits_, sink_, control_);
      if (status) {
        sink_.note("The u-blox log holds no dated NAV-PVT message; its NMEA sentences are read.");
        note_damaged();
      }
      return status;
    }
    return fail(ErrorCode::NoSamples,
                raw_ ? "The u-blox log holds raw measurements and no position (UBX-NAV-PVT): compute positions with "
                       "RTKLIB (convbin, then rnx2rtkp) and send its .pos file."
                     : "The u-blox log holds no dated NAV-PVT message; have the receiver write them (UBX-NAV-PVT).");
  }
  Status flush() {
    if (!rows_.empty() && !delivered_) {
      ColumnLayout layout{{}, true};
      layout.names.assign(kNames.begin(), kNames.end());
      if (auto status = sink_.begin(layout); !status) {
        return status;
      }
      between_.close();
    }
    auto status = rows_.empty() ? Status{} : sink_.rows(rows_);
    delivered_ = delivered_ || !rows_.empty();
    rows_.clear();
    return status;
  }

  ColumnSink& sink_;
  const DecodeLimits& limits_;
  const RunControl& control_;
  SentenceCollector between_;  ///< the frames
  std::vector<double> rows_;
  std::size_t damaged_ = 0, undated_ = 0;
  bool delivered_ = false;
  bool raw_ = false;  ///< it holds RXM-RAWX or RXM-RAW
};

/// Takes the frames that are whole among `bytes` and what stands between them; how many bytes that were. A frame that
/// runs over the end is left, unless nothing follows.
Result<std::size_t> take_frames(std::string_view bytes, bool nothing_follows, UbxDecoder& decoder) {
  const FletcherSums sums(bytes);
  std::size_t at = 0;
  while (at < bytes.size()) {
    std::size_t next = bytes.find(kSync, at);
    if (next == std::string_view::npos) {  // half a sync may stand at the end
      next = bytes.size() - (!nothing_follows && bytes.back() == kSync.front() ? 1 : 0);
      decoder.take_between(bytes.substr(at, next - at));
      return next;
    }
    decoder.take_between(bytes.substr(at, next - at));
    const std::size_t whole = frame_at(bytes.substr(next));
    if (whole == 0 && !nothing_follows) {
      return next;
    }
    at = next + 1;
    if (whole == 0) {
      continue;
    }
    if (!sums.is_sound(next, whole)) {
      decoder.take_damaged();
      continue;
    }
    if (auto status = decoder.take(bytes.substr(next, whole)); !status) {
      return fail(status.error());
    }
    at = next + whole;
  }
  return at;
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  constexpr std::size_t kLongestFrame = kHead + 65535 + kChecksum;
  constexpr std::size_t kLook = 4 * kLongestFrame;  // what a frame over its end leaves is looked at twice
  UbxDecoder decoder(sink, limits, control);
  while (true) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view(kLook);
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return decoder.finish();
    }
    auto taken = take_frames(*view, view->size() < kLook, decoder);
    if (!taken) {
      return fail(taken.error());
    }
    source.consume(*taken);
  }
}

}  // namespace

const Format kUbx{"ubx", "log of a u-blox receiver (.ubx)", sniff, decode};

}  // namespace driftlab::formats
