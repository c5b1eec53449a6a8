#include "core/read/byte_source.hpp"

#include <lzma.h>
#include <zlib.h>
#include <zstd.h>
#include <zstd_errors.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <string>
#include <utility>

namespace driftlab {
namespace {

std::string_view magic_of(Compression compression) {
  using namespace std::string_view_literals;
  switch (compression) {
    case Compression::Gzip:
      return "\x1f\x8b"sv;
    case Compression::Xz:
      return "\xfd\x37zXZ\0"sv;
    case Compression::Zstd:
      return "\x28\xb5\x2f\xfd"sv;
    case Compression::None:
      break;
  }
  return {};
}

/// What one turn of a decompressor did.
struct Turn {
  std::size_t consumed = 0;
  std::size_t produced = 0;
  bool member_ended = false;
};

/// What every compression shares: budget, end of input, concatenated members.
class Decompressor : public ByteReader {
 public:
  Decompressor(Compression kind, ByteSource compressed, const DecodeLimits& limits)
      : kind_(kind), source_(std::move(compressed)), budget_(limits.expanded_budget(source_.input_size())) {}

  Result<std::size_t> read(std::span<char> into) final;
  [[nodiscard]] double fraction() const final { return source_.fraction(); }
  [[nodiscard]] std::uint64_t size() const final { return source_.input_size(); }

 protected:
  /// One call of the library. `input` is empty only at the end of the input.
  virtual Result<Turn> turn(std::string_view input, std::span<char> into) = 0;
  /// Prepares for another member.
  virtual Status restart() = 0;

  [[nodiscard]] tl::unexpected<Error> corrupt(const std::string& why) const {
    return fail(ErrorCode::CorruptCompression,
                "The " + std::string(name_of(kind_)) + " stream is damaged: " + why + ".");
  }
  [[nodiscard]] tl::unexpected<Error> too_much_memory() const {
    return fail(ErrorCode::DecompressionLimit,
                "The " + std::string(name_of(kind_)) + " stream asks for more memory than decompression may use.");
  }

 private:
  Result<bool> next_member();
  [[nodiscard]] tl::unexpected<Error> over_budget() const;
  [[nodiscard]] tl::unexpected<Error> ends_early() const {
    return fail(ErrorCode::Truncated,
                "The " + std::string(name_of(kind_)) + " stream ends before it is complete; copy the file again.");
  }

  Compression kind_;
  ByteSource source_;
  std::uint64_t budget_;
  std::uint64_t produced_ = 0;
  bool between_members_ = false;
  bool done_ = false;
};

Result<std::size_t> Decompressor::read(std::span<char> into) {
  while (!done_) {
    if (between_members_) {
      auto more = next_member();
      if (!more) {
        return fail(more.error());
      }
      if (!*more) {
        break;
      }
    }
    auto input = source_.view();
    if (!input) {
      return fail(input.error());
    }
    auto turned = turn(*input, into);
    if (!turned) {
      return fail(turned.error());
    }
    source_.consume(turned->consumed);
    between_members_ = turned->member_ended;
    produced_ += turned->produced;
    if (produced_ > budget_) {
      return over_budget();
    }
    if (turned->produced > 0) {
      return turned->produced;
    }
    if (between_members_) {
      continue;
    }
    if (input->empty()) {
      return ends_early();
    }
    if (turned->consumed == 0) {
      return corrupt("it makes no progress");
    }
  }
  return std::size_t{0};
}

/// After the end of one member: true if another follows; padding of zero bytes and the end of the input are the end.
Result<bool> Decompressor::next_member() {
  while (true) {
    auto input = source_.view(8);
    if (!input) {
      return fail(input.error());
    }
    const std::size_t zeros = std::min(input->find_first_not_of('\0'), input->size());
    if (zeros > 0) {
      source_.consume(zeros);
      continue;
    }
    if (input->empty()) {
      done_ = true;
      return false;
    }
    if (sniff_compression(*input) != kind_) {
      return magic_of(kind_).starts_with(*input) ? ends_early()
                                                 : corrupt("something else follows the end of the stream");
    }
    between_members_ = false;
    if (auto status = restart(); !status) {
      return fail(status.error());
    }
    return true;
  }
}

tl::unexpected<Error> Decompressor::over_budget() const {
  return fail(ErrorCode::DecompressionLimit,
              "The file expands to more than " + std::to_string(budget_) + " bytes from " +
                  std::to_string(source_.input_size()) + " compressed bytes; no recording compresses that well.",
              {{"limit", std::to_string(budget_)}});
}

class GzipReader final : public Decompressor {
 public:
  using Decompressor::Decompressor;
  ~GzipReader() override { ::inflateEnd(&stream_); }
  GzipReader(const GzipReader&) = delete;
  GzipReader& operator=(const GzipReader&) = delete;

  // 15 + 16: largest window, gzip wrapper only (zlib manual, inflateInit2).
  bool start() { return ::inflateInit2(&stream_, 15 + 16) == Z_OK; }

 private:
  Result<Turn> turn(std::string_view input, std::span<char> into) override {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(input.data()));
    stream_.avail_in = static_cast<uInt>(std::min(input.size(), kMost));
    stream_.next_out = reinterpret_cast<Bytef*>(into.data());
    stream_.avail_out = static_cast<uInt>(std::min(into.size(), kMost));
    const uInt had = stream_.avail_in;
    const uInt room = stream_.avail_out;
    const int code = ::inflate(&stream_, Z_NO_FLUSH);
    if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
      return corrupt(stream_.msg != nullptr ? stream_.msg : "deflate data expected");
    }
    return Turn{had - stream_.avail_in, room - stream_.avail_out, code == Z_STREAM_END};
  }
  Status restart() override {
    if (::inflateReset(&stream_) != Z_OK) {
      return corrupt("cannot restart");
    }
    return {};
  }

  z_stream stream_{};
};

class XzReader final : public Decompressor {
 public:
  XzReader(ByteSource compressed, const DecodeLimits& limits)
      : Decompressor(Compression::Xz, std::move(compressed), limits), memory_(limits.max_decoder_memory) {}
  ~XzReader() override { ::lzma_end(&stream_); }
  XzReader(const XzReader&) = delete;
  XzReader& operator=(const XzReader&) = delete;

  bool start() { return ::lzma_stream_decoder(&stream_, memory_, LZMA_TELL_UNSUPPORTED_CHECK) == LZMA_OK; }

 private:
  Result<Turn> turn(std::string_view input, std::span<char> into) override {
    stream_.next_in = reinterpret_cast<const std::uint8_t*>(input.data());
    stream_.avail_in = input.size();
    stream_.next_out = reinterpret_cast<std::uint8_t*>(into.data());
    stream_.avail_out = into.size();
    const lzma_ret code = ::lzma_code(&stream_, LZMA_RUN);
    if (code == LZMA_MEMLIMIT_ERROR || code == LZMA_MEM_ERROR) {
      return too_much_memory();
    }
    if (code != LZMA_OK && code != LZMA_STREAM_END && code != LZMA_BUF_ERROR) {
      return corrupt(code == LZMA_UNSUPPORTED_CHECK || code == LZMA_OPTIONS_ERROR ? "it uses options of a newer xz"
                                                                                  : "its data or checksum is wrong");
    }
    return Turn{input.size() - stream_.avail_in, into.size() - stream_.avail_out, code == LZMA_STREAM_END};
  }
  Status restart() override {
    if (!start()) {
      return too_much_memory();
    }
    return {};
  }

  lzma_stream stream_ = LZMA_STREAM_INIT;
  std::uint64_t memory_;
};

class ZstdReader final : public Decompressor {
 public:
  ZstdReader(ByteSource compressed, const DecodeLimits& limits)
      : Decompressor(Compression::Zstd, std::move(compressed), limits), stream_(::ZSTD_createDCtx()) {
    // The window is the memory a frame demands; log2 rounded down keeps it within the limit.
    const int window_log = std::clamp(static_cast<int>(std::bit_width(limits.max_decoder_memory)) - 1, 10, 31);
    if (stream_ != nullptr) {
      ::ZSTD_DCtx_setParameter(stream_, ZSTD_d_windowLogMax, window_log);
    }
  }
  ~ZstdReader() override { ::ZSTD_freeDCtx(stream_); }
  ZstdReader(const ZstdReader&) = delete;
  ZstdReader& operator=(const ZstdReader&) = delete;

  [[nodiscard]] bool start() const { return stream_ != nullptr; }

 private:
  Result<Turn> turn(std::string_view input, std::span<char> into) override {
    // The library decodes a frame that lies before it whole in another way, which finds other faults in a damaged one.
    // A frame whose first byte comes by itself never does.
    input = input.substr(0, std::exchange(begins_, false) ? 1 : input.size());
    ZSTD_inBuffer in{input.data(), input.size(), 0};
    ZSTD_outBuffer out{into.data(), into.size(), 0};
    const std::size_t code = ::ZSTD_decompressStream(stream_, &out, &in);
    if (::ZSTD_isError(code) != 0) {
      const ZSTD_ErrorCode reason = ::ZSTD_getErrorCode(code);
      if (reason == ZSTD_error_frameParameter_windowTooLarge || reason == ZSTD_error_memory_allocation) {
        return too_much_memory();
      }
      return corrupt("its data or checksum is wrong");  // the library's own words depend on buffer sizes
    }
    return Turn{in.pos, out.pos, code == 0};
  }
  Status restart() override {
    ::ZSTD_DCtx_reset(stream_, ZSTD_reset_session_only);
    begins_ = true;
    return {};
  }

  ZSTD_DCtx* stream_;
  bool begins_ = true;  ///< a frame
};

template <class Reader>
Result<std::unique_ptr<ByteReader>> started(std::unique_ptr<Reader> reader) {
  if (!reader->start()) {
    return fail(ErrorCode::Internal, "The decompressor could not be started.");
  }
  return std::unique_ptr<ByteReader>(std::move(reader));
}

}  // namespace

namespace {

/// allowance + ratio * bytes, `most` at most.
std::uint64_t budget_of(std::uint64_t bytes, std::uint64_t allowance, std::uint64_t ratio, std::uint64_t most) {
  if (ratio != 0 && bytes > (std::numeric_limits<std::uint64_t>::max() - allowance) / ratio) {
    return most;
  }
  return std::min(most, allowance + ratio * bytes);
}

}  // namespace

std::uint64_t DecodeLimits::expanded_budget(std::uint64_t compressed_bytes) const {
  return budget_of(compressed_bytes, expansion_allowance, expansion_ratio, max_expanded_bytes);
}

std::uint64_t DecodeLimits::columns_budget(std::uint64_t input_bytes) const {
  return budget_of(input_bytes, columns_allowance, columns_ratio, 8 * max_expanded_bytes);
}

std::string_view name_of(Compression compression) {
  switch (compression) {
    case Compression::None:
      return "none";
    case Compression::Gzip:
      return "gzip";
    case Compression::Xz:
      return "xz";
    case Compression::Zstd:
      return "zstd";
  }
  return "none";
}

Compression sniff_compression(std::string_view head) {
  for (const Compression kind : {Compression::Gzip, Compression::Xz, Compression::Zstd}) {
    if (head.starts_with(magic_of(kind))) {
      return kind;
    }
  }
  return Compression::None;
}

Result<std::unique_ptr<ByteReader>> make_decompressor(Compression compression, ByteSource compressed,
                                                      const DecodeLimits& limits) {
  switch (compression) {
    case Compression::Gzip:
      return started(std::make_unique<GzipReader>(Compression::Gzip, std::move(compressed), limits));
    case Compression::Xz:
      return started(std::make_unique<XzReader>(std::move(compressed), limits));
    case Compression::Zstd:
      return started(std::make_unique<ZstdReader>(std::move(compressed), limits));
    case Compression::None:
      break;
  }
  return fail(ErrorCode::Internal, "There is no decompressor for uncompressed bytes.");
}

}  // namespace driftlab
