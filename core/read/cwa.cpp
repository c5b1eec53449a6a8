/// Axivity CWA (AX3, AX6): a header of 1024 bytes, then blocks of 512 with some tens of samples and the time of one of
/// them. Little-endian. Source: Open Movement, "AX3/AX6 technical documentation" and cwa.h.
///
/// Read are the accelerometer [g], the gyroscope of an AX6 [deg/s] and the temperature of each block [degC], repeated
/// for its samples; not read are light, battery and a magnetometer. The time is that of core/read/stamped_blocks.hpp.
/// Blocks whose checksum is wrong are left out, and counted.
#include "core/read/formats.hpp"
#include "core/read/little_endian.hpp"
#include "core/read/stamped_blocks.hpp"
#include "core/signal/with_count.hpp"

#include <array>
#include <chrono>
#include <optional>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "MD\xfc\x03"sv;
constexpr std::size_t kHeaderBytes = 1024;
constexpr std::size_t kBlockBytes = 512;
constexpr std::size_t kDataBytes = 480;

/// What the front of a block says.
struct Block {
  std::uint32_t sequence = 0;
  std::size_t axes = 0;
  bool packed = false;  ///< three numbers of 10 bits with an exponent in 4 bytes, else 2 bytes each
  std::size_t samples = 0;
  double start_s = 0.0;  ///< since 2000-01-01
  double step_s = 0.0;
  double accel_g = 0.0;
  double gyro_deg_s = 0.0;
  double temperature_degc = 0.0;

  [[nodiscard]] bool same_layout(const Block& other) const { return axes == other.axes; }
  [[nodiscard]] bool has_gyro() const { return axes > 3; }
};

/// Seconds since 2000-01-01 of a packed date: YYYYYYMM MMDDDDDh hhhhmmmm mmssssss.
std::optional<double> seconds_of(std::uint32_t packed) {
  using namespace std::chrono;
  const year_month_day date{year{2000 + static_cast<int>(packed >> 26U)}, month{(packed >> 22U) & 15U},
                            day{(packed >> 17U) & 31U}};
  if (!date.ok()) {
    return std::nullopt;
  }
  const auto days = (sys_days{date} - sys_days{year{2000} / 1 / 1}).count();
  return 86400.0 * static_cast<double>(days) +
         static_cast<double>(3600 * ((packed >> 12U) & 31U) + 60 * ((packed >> 6U) & 63U) + (packed & 63U));
}

/// Nothing where the block is damaged or of a kind that is not known.
std::optional<Block> read_block(std::string_view bytes) {
  std::uint16_t sum = 0;
  for (std::size_t at = 0; at < kBlockBytes; at += 2) {
    sum = static_cast<std::uint16_t>(sum + load_at<std::uint16_t>(bytes, at));
  }
  const auto seconds = seconds_of(load_at<std::uint32_t>(bytes, 14));
  if (!bytes.starts_with("AX\xfc\x01"sv) || sum != 0 || !seconds) {
    return std::nullopt;
  }
  Block block;
  block.sequence = load_at<std::uint32_t>(bytes, 10);
  const auto shape = load_at<std::uint8_t>(bytes, 25);
  block.axes = shape >> 4U;
  block.packed = (shape & 15U) == 0;
  block.samples = load_at<std::uint16_t>(bytes, 28);
  const std::size_t sample_bytes = block.packed ? 4 : 2 * block.axes;
  const bool known =
      block.packed ? block.axes == 3 : (shape & 15U) == 2 && (block.axes == 3 || block.axes == 6 || block.axes == 9);
  if (!known || block.samples * sample_bytes > kDataBytes) {
    return std::nullopt;
  }
  const std::uint32_t rate_code = load_at<std::uint8_t>(bytes, 24) & 15U;
  const double rate_hz = 3200.0 / static_cast<double>(1U << (15U - rate_code));
  block.step_s = 1.0 / rate_hz;
  // The stamp is that of the sample `offset`; where a fraction of a second is kept, the offset was written as if it had
  // been cut off, in whole samples.
  const auto fraction = load_at<std::uint16_t>(bytes, 4);
  const double part_s = (fraction & 0x8000U) != 0 ? static_cast<double>(fraction & 0x7FFFU) / 32768.0 : 0.0;
  const double offset = load_at<std::int16_t>(bytes, 26) + std::floor(part_s * rate_hz);
  block.start_s = *seconds + part_s - offset * block.step_s;
  const auto scales = load_at<std::uint16_t>(bytes, 18);
  const unsigned accel_code = block.packed ? 0U : scales >> 13U;
  block.accel_g = 1.0 / static_cast<double>(256U << accel_code);
  block.gyro_deg_s = 8000.0 / static_cast<double>(1U << ((scales >> 10U) & 7U)) / 32768.0;
  // 3/1024 V a count, 0.5 V at 0 degC, 10 mV/degC.
  block.temperature_degc = static_cast<double>(load_at<std::uint16_t>(bytes, 20) & 1023U) * 75.0 / 256.0 - 50.0;
  return block;
}

/// One axis of a packed sample: its 10 bits, signed, shifted by the exponent in the highest two.
double unpacked(std::uint32_t sample, unsigned axis) {
  const auto bits = static_cast<std::int32_t>((sample >> (10U * axis)) & 1023U);
  return static_cast<double>((bits < 512 ? bits : bits - 1024) * (1 << (sample >> 30U)));
}

/// The values of a block, row by row.
void append_values(const Block& block, std::string_view data, std::vector<double>& values) {
  for (std::size_t i = 0; i < block.samples; ++i) {
    const std::size_t axes = block.has_gyro() ? 6 : 3;
    for (unsigned axis = 0; axis < axes; ++axis) {
      const double raw = block.packed ? unpacked(load_at<std::uint32_t>(data, 4 * i), axis)
                                      : load_at<std::int16_t>(data, 2 * (block.axes * i + axis));
      values.push_back(raw * (block.has_gyro() && axis < 3 ? block.gyro_deg_s : block.accel_g));
    }
    values.push_back(block.temperature_degc);
  }
}

class CwaDecoder {
 public:
  CwaDecoder(ByteSource& source, ColumnSink& sink, const RunControl& control)
      : source_(source), sink_(sink), control_(control) {}

  Status run();

 private:
  Status take(std::string_view bytes);
  Status begin(const Block& block);
  void note_quality();

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  std::optional<StampedBlocks> blocks_;
  Block last_;
  std::vector<double> values_;
  std::uint64_t seen_ = 0;
  std::uint64_t damaged_ = 0;
  std::uint64_t lost_ = 0;
  std::size_t torn_bytes_ = 0;
};

Status CwaDecoder::begin(const Block& block) {
  ColumnLayout layout{{"time (s)"}, true};
  if (block.has_gyro()) {
    layout.names.insert(layout.names.end(), {"gyro_x (deg/s)", "gyro_y (deg/s)", "gyro_z (deg/s)"});
  }
  layout.names.insert(layout.names.end(), {"acc_x (g)", "acc_y (g)", "acc_z (g)", "temperature (degC)"});
  blocks_.emplace(sink_, layout.names.size() - 1);
  return sink_.begin(layout);
}

Status CwaDecoder::take(std::string_view bytes) {
  ++seen_;
  const auto block = read_block(bytes);
  if (!block || (blocks_ && !block->same_layout(last_))) {
    ++damaged_;
    return {};
  }
  if (block->samples == 0) {
    return {};
  }
  if (!blocks_) {
    if (auto status = begin(*block); !status || !blocks_) {
      return status;
    }
  } else if (block->sequence > last_.sequence) {
    lost_ += block->sequence - last_.sequence - 1;
  }
  last_ = *block;
  values_.clear();
  append_values(*block, bytes.substr(30, kDataBytes), values_);
  return blocks_->take(block->start_s, block->step_s, values_);
}

void CwaDecoder::note_quality() {
  if (damaged_ > 0) {
    sink_.note(std::to_string(damaged_) + " of " + with_count(seen_, "block") +
               (damaged_ == 1 ? " is left out: its checksum is wrong or its kind is not that of the first."
                              : " are left out: their checksum is wrong or their kind is not that of the first."));
  }
  if (lost_ > 0) {
    sink_.note("The numbers of the blocks show that " + with_count(lost_, "is missing.", "are missing."));
  }
  if (torn_bytes_ > 0) {
    sink_.note("The file ends " + with_count(torn_bytes_, "byte") + " into a block; that block is left out.");
  }
}

Status CwaDecoder::run() {
  auto there = skip_bytes(source_, kHeaderBytes, control_);
  if (!there) {
    return fail(there.error());
  }
  if (*there < kHeaderBytes) {
    return fail(ErrorCode::Truncated, "The CWA file ends within its header of 1024 bytes.");
  }
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source_.view(kBlockBytes);
    if (!view) {
      return fail(view.error());
    }
    if (view->size() < kBlockBytes) {
      torn_bytes_ = view->size();
      source_.consume(view->size());
      break;
    }
    if (auto status = take(view->substr(0, kBlockBytes)); !status) {
      return status;
    }
    source_.consume(kBlockBytes);
  }
  if (!blocks_) {
    return fail(ErrorCode::NoSamples, "The CWA file holds no whole block of samples behind its header (" +
                                          std::to_string(damaged_) + " are damaged).");
  }
  note_quality();
  return blocks_->finish();
}

int sniff(std::string_view head) { return head.starts_with(kMagic) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits&, ColumnSink& sink, const RunControl& control) {
  return CwaDecoder(source, sink, control).run();
}

}  // namespace

const Format kCwa{"cwa", "Axivity CWA of an AX3 or AX6", sniff, decode};

}  // namespace driftlab::formats
