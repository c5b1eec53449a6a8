#include "core/read/rtklib_tag.hpp"

#include "core/read/little_endian.hpp"

#include <cmath>
#include <cstdint>
#include <string>

namespace driftlab {
namespace {

constexpr std::uint32_t kGpsEpoch = 315964800;  ///< 1980-01-06, seconds since 1970
constexpr std::size_t kTagHeader = 76;
constexpr std::size_t kTagEntry = 8;
constexpr std::size_t kMostTagBytes = std::size_t{64} << 20;

}  // namespace

Result<RtklibTag> parse_rtklib_tag(std::string_view bytes) {
  if (!bytes.starts_with(kTagSignature) && !kTagSignature.starts_with(bytes)) {
    return fail(ErrorCode::UnsupportedFormat, "The time tag is none of RTKLIB's: it begins with other bytes.");
  }
  if (bytes.size() < kTagHeader) {
    return fail(ErrorCode::Truncated, "The time tag ends within its header of 76 bytes.");
  }
  const std::size_t entries = (bytes.size() - kTagHeader) / kTagEntry;
  if (entries == 0) {
    return fail(ErrorCode::Truncated, "The time tag ends before its first entry.");
  }
  const double fraction = load_at<double>(bytes, 68);
  if (!std::isfinite(fraction) || fraction < 0.0 || fraction >= 1.0) {
    return fail(ErrorCode::UnsupportedFormat, "The time tag is none of RTKLIB's: its start is no time.");
  }
  const auto seconds = load_at<std::uint32_t>(bytes, 64);
  if (seconds < kGpsEpoch) {
    return fail(ErrorCode::UnsupportedFormat,
                "The time tag starts before 1980, when GPS time begins: the computer that wrote it had no date.");
  }
  const auto last_ms = load_at<std::uint32_t>(bytes, kTagHeader + (entries - 1) * kTagEntry);
  if (last_ms == 0) {
    return fail(ErrorCode::TooFewSamples, "The time tag ends at the moment of its start; it dates no log.");
  }
  RtklibTag tag;
  tag.first_s = static_cast<double>(seconds) + fraction;
  tag.last_s = tag.first_s + 1e-3 * static_cast<double>(last_ms);
  return tag;
}

Result<RtklibTag> read_rtklib_tag(const std::filesystem::path& path) {
  auto reader = open_file_reader(path);
  if (!reader) {
    return fail(reader.error());
  }
  ByteSource source(std::move(*reader));
  auto head = source.view(8);
  if (!head) {
    return fail(head.error());
  }
  if (const Compression compression = sniff_compression(*head); compression != Compression::None) {
    auto plain = make_decompressor(compression, std::move(source), {});
    if (!plain) {
      return fail(plain.error());
    }
    source = ByteSource(std::move(*plain));
  }
  std::string bytes;
  while (true) {
    auto view = source.view();
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return parse_rtklib_tag(bytes);
    }
    if (bytes.size() + view->size() > kMostTagBytes) {
      return fail(ErrorCode::LimitExceeded, "A time tag has at most 64 MiB.");
    }
    bytes.append(*view);
    source.consume(view->size());
  }
}

}  // namespace driftlab
