/// MATLAB level 5 (save -v6 and -v7): real numeric arrays, and those in structs, compressed or not.
///
/// Read here, without a library, in the same bounded way as .npy: nothing is allocated from what a header claims, an
/// element is inflated as it streams by and its expansion counts against the budget of decompression. Source: The
/// MathWorks, "MAT-File Format", version R2020a, chapter 1.
#include "core/read/formats.hpp"
#include "core/read/mat5_elements.hpp"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace driftlab::formats {
namespace {

constexpr std::string_view kSignature = "MATLAB 5.0 MAT-file";
constexpr std::size_t kHeaderBytes = 128;

tl::unexpected<Error> ends_early() {
  return fail(ErrorCode::Truncated, "The MATLAB file ends before its last array is complete.");
}

/// Passes on the next `count` bytes of `source` piece by piece.
template <class Take>
Status take_bytes(ByteSource& source, std::uint64_t count, const RunControl& control, const Take& take) {
  while (count > 0) {
    if (control.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source.view();
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      return ends_early();
    }
    const std::size_t piece = std::min<std::uint64_t>(count, view->size());
    if (auto status = take(view->substr(0, piece)); !status) {
      return status;
    }
    source.consume(piece);
    count -= piece;
  }
  return {};
}

/// zlib (RFC 1950) of one element.
class Inflater {
 public:
  Inflater() { started_ = ::inflateInit(&stream_) == Z_OK; }
  ~Inflater() { ::inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;

  Status take(std::string_view packed, std::string& plain, std::size_t most) {
    if (!started_) {
      return fail(ErrorCode::Internal, "The decompressor could not be started.");
    }
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream_.avail_in = static_cast<uInt>(packed.size());  // a view is at most some MiB
    while (stream_.avail_in > 0 && !ended_) {
      char buffer[16384];
      stream_.next_out = reinterpret_cast<Bytef*>(buffer);
      stream_.avail_out = sizeof buffer;
      const int code = ::inflate(&stream_, Z_NO_FLUSH);
      if (code != Z_OK && code != Z_STREAM_END && code != Z_BUF_ERROR) {
        return fail(ErrorCode::CorruptCompression, "An array of the MATLAB file is damaged: it does not decompress.");
      }
      plain.append(buffer, sizeof buffer - stream_.avail_out);
      if (plain.size() > most) {
        return fail(ErrorCode::DecompressionLimit,
                    "An array of the MATLAB file expands to more than " + std::to_string(most) + " bytes.",
                    {{"limit", std::to_string(most)}});
      }
      ended_ = code == Z_STREAM_END;
      if (code == Z_BUF_ERROR) {
        break;
      }
    }
    return {};
  }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  z_stream stream_{};
  bool started_ = false;
  bool ended_ = false;
};

class Mat5Decoder {
 public:
  Mat5Decoder(ByteSource& source, const DecodeLimits& limits, const RunControl& control)
      : source_(source), limits_(limits), control_(control), budget_(limits.max_tables_bytes) {}

  Status run();
  mat5::Contents contents;

 private:
  Status take_header();
  Status take_element(std::uint32_t type, std::uint32_t size);
  Status take_compressed(std::uint32_t size);
  [[nodiscard]] std::uint32_t word(std::string_view bytes) const {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data(), sizeof value);
    return swap_ ? __builtin_bswap32(value) : value;
  }

  ByteSource& source_;
  const DecodeLimits& limits_;
  const RunControl& control_;
  std::size_t budget_;
  bool swap_ = false;
};

Status Mat5Decoder::take_header() {
  auto header = source_.view(kHeaderBytes);
  if (!header) {
    return fail(header.error());
  }
  if (header->size() < kHeaderBytes) {
    return ends_early();
  }
  const std::string_view order = header->substr(126, 2);  // "MI" as a word of the writer's byte order
  if (order != "IM" && order != "MI") {
    return fail(ErrorCode::ShapeMismatch, "The MATLAB file does not state its byte order.");
  }
  swap_ = order == "MI";
  source_.consume(kHeaderBytes);
  return {};
}

Status Mat5Decoder::take_compressed(std::uint32_t size) {
  Inflater inflater;
  std::string plain;
  const std::size_t most =
      std::min<std::uint64_t>(limits_.max_tables_bytes, limits_.expanded_budget(source_.input_size()));
  auto status =
      take_bytes(source_, size, control_, [&](std::string_view piece) { return inflater.take(piece, plain, most); });
  if (!status) {
    return status;
  }
  if (!inflater.ended() || plain.size() < 8) {
    return fail(ErrorCode::CorruptCompression,
                "An array of the MATLAB file is damaged: its compressed data end early.");
  }
  const std::string_view bytes = plain;
  if (word(bytes) != mat5::Matrix) {
    return {};
  }
  const std::size_t inside = word(bytes.substr(4));
  if (inside > bytes.size() - 8) {
    return fail(ErrorCode::ShapeMismatch, "The MATLAB file contradicts itself: an array is longer than its data.");
  }
  return mat5::read_matrix(bytes.substr(8, inside), swap_, budget_, contents);
}

Status Mat5Decoder::take_element(std::uint32_t type, std::uint32_t size) {
  if (type == mat5::Compressed) {
    return take_compressed(size);
  }
  const std::uint64_t padded = (std::uint64_t{size} + 7) / 8 * 8;
  std::string body;
  auto status = take_bytes(source_, padded, control_, [&](std::string_view piece) -> Status {
    if (body.size() + piece.size() > limits_.max_tables_bytes) {
      return fail(ErrorCode::LimitExceeded, "The MATLAB file holds more numbers than can be put together.");
    }
    body.append(type == mat5::Matrix ? piece : std::string_view());
    return {};
  });
  if (!status || type != mat5::Matrix) {
    return status;
  }
  return mat5::read_matrix(std::string_view(body).substr(0, size), swap_, budget_, contents);
}

Status Mat5Decoder::run() {
  if (auto status = take_header(); !status) {
    return status;
  }
  while (true) {
    auto tag = source_.view(8);
    if (!tag) {
      return fail(tag.error());
    }
    if (tag->empty()) {
      return {};
    }
    if (tag->size() < 8) {
      return ends_early();
    }
    const std::uint32_t type = word(*tag);
    const std::uint32_t size = word(tag->substr(4));
    source_.consume(8);
    if (type >> 16U != 0) {
      continue;  // a small element at the top holds no array
    }
    if (auto status = take_element(type, size); !status) {
      return status;
    }
  }
}

int sniff(std::string_view head) { return head.starts_with(kSignature) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  Mat5Decoder decoder(source, limits, control);
  if (auto status = decoder.run(); !status) {
    return status;
  }
  std::string left_out;
  for (const std::string& name : decoder.contents.left_out) {
    left_out += (left_out.empty() ? "" : ", ") + name;
  }
  if (!left_out.empty()) {
    sink.note("What is no array of real numbers is left out: " + left_out.substr(0, 1000) + ".");
  }
  return deliver_variables(std::move(decoder.contents.variables), limits, sink);
}

}  // namespace

const Format kMat5{"mat5", "MATLAB 5 file (save -v6, -v7) of arrays of one length", sniff, decode};

}  // namespace driftlab::formats
