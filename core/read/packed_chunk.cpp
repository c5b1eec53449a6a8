#include "core/read/packed_chunk.hpp"

#include "core/read/little_endian.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace driftlab {
namespace {

constexpr std::size_t kBlock = std::size_t{64} * 1024;

/// The next `length` bytes of another source.
class Stretch final : public ByteReader {
 public:
  Stretch(ByteSource& outer, std::uint64_t length) : outer_(outer), left_(length) {}

  Result<std::size_t> read(std::span<char> into) override {
    if (left_ == 0) {
      return std::size_t{0};
    }
    auto view = outer_.view();
    if (!view) {
      return fail(view.error());
    }
    const std::size_t count = std::min<std::uint64_t>({view->size(), into.size(), left_});
    std::copy_n(view->begin(), count, into.data());
    outer_.consume(count);
    left_ -= count;
    ended_early_ = count == 0;
    return count;
  }
  [[nodiscard]] double fraction() const override { return outer_.fraction(); }
  [[nodiscard]] std::uint64_t size() const override { return outer_.input_size(); }
  [[nodiscard]] std::uint64_t left() const { return left_; }
  [[nodiscard]] bool ended_early() const { return ended_early_; }

 private:
  ByteSource& outer_;
  std::uint64_t left_;
  bool ended_early_ = false;
};

/// Passes on what a reader that lives longer delivers, and sums it up.
class Summed final : public ByteReader {
 public:
  Summed(ByteReader& reader, ::uLong* crc) : reader_(reader), crc_(crc) {}
  Result<std::size_t> read(std::span<char> into) override {
    auto count = reader_.read(into);
    if (count && crc_ != nullptr) {
      *crc_ = ::crc32_z(*crc_, reinterpret_cast<const Bytef*>(into.data()), *count);
    }
    return count;
  }
  [[nodiscard]] double fraction() const override { return reader_.fraction(); }
  [[nodiscard]] std::uint64_t size() const override { return reader_.size(); }

 private:
  ByteReader& reader_;
  ::uLong* crc_;
};

int filter_of(Packing packing) {
  switch (packing) {
    case Packing::Bzip2:
      return ARCHIVE_FILTER_BZIP2;
    case Packing::Lz4:
      return ARCHIVE_FILTER_LZ4;
    case Packing::Zstd:
      return ARCHIVE_FILTER_ZSTD;
    case Packing::None:
      break;
  }
  return ARCHIVE_FILTER_NONE;
}

/// What a packed stretch expands to. Opened at the first read.
class Unpacked final : public ByteReader {
 public:
  Unpacked(Stretch& packed, Packing packing, ExpansionBudget& budget)
      : packed_(packed), filter_(filter_of(packing)), budget_(budget) {}

  Result<std::size_t> read(std::span<char> into) override {
    if (!handle_) {
      if (auto status = open(); !status) {
        return fail(status.error());
      }
    }
    const la_ssize_t count = ::archive_read_data(handle_.get(), into.data(), into.size());
    if (count < 0) {
      return damaged();
    }
    const auto produced = static_cast<std::uint64_t>(count);
    if (produced > budget_.left) {
      return fail(ErrorCode::DecompressionLimit,
                  "The chunks of the file expand to more than " + std::to_string(budget_.total) +
                      " bytes; no recording compresses that well.",
                  {{"limit", std::to_string(budget_.total)}});
    }
    budget_.left -= produced;
    return static_cast<std::size_t>(count);
  }
  [[nodiscard]] double fraction() const override { return packed_.fraction(); }
  [[nodiscard]] std::uint64_t size() const override { return packed_.size(); }

 private:
  Status open() {
    block_.resize(kBlock);
    handle_.reset(::archive_read_new());
    archive* const reader = handle_.get();
    // Whole blocks whatever the pieces in which the bytes arrive; what is not packed as stated is no chunk.
    if (reader == nullptr || ::archive_read_support_filter_by_code(reader, filter_) != ARCHIVE_OK ||
        ::archive_read_support_format_raw(reader) != ARCHIVE_OK) {
      return fail(ErrorCode::Internal, "The decompressor of chunks could not be started.");
    }
    archive_entry* entry = nullptr;
    if (::archive_read_open(reader, this, nullptr, next_block, nullptr) != ARCHIVE_OK ||
        ::archive_filter_code(reader, 0) != filter_ || ::archive_read_next_header(reader, &entry) != ARCHIVE_OK) {
      return damaged();
    }
    return {};
  }
  [[nodiscard]] tl::unexpected<Error> damaged() const {
    return error_ ? fail(*error_) : fail(ErrorCode::CorruptCompression, "it does not decompress");
  }
  static la_ssize_t next_block(archive* /*reader*/, void* self, const void** bytes) {
    auto& unpacked = *static_cast<Unpacked*>(self);
    std::size_t filled = 0;
    while (filled < kBlock) {
      auto count = unpacked.packed_.read(std::span(unpacked.block_).subspan(filled));
      if (!count) {
        unpacked.error_ = count.error();
        return -1;
      }
      if (*count == 0) {
        break;
      }
      filled += *count;
    }
    *bytes = unpacked.block_.data();
    return static_cast<la_ssize_t>(filled);
  }

  Stretch& packed_;
  int filter_;
  ExpansionBudget& budget_;
  std::vector<char> block_;
  std::optional<Error> error_;
  std::unique_ptr<archive, int (*)(archive*)> handle_{nullptr, ::archive_read_free};
};

}  // namespace

std::optional<Packing> packing_of(std::string_view name) {
  if (name.empty() || name == "none") {
    return Packing::None;
  }
  return name == "bz2"    ? std::optional(Packing::Bzip2)
         : name == "lz4"  ? std::optional(Packing::Lz4)
         : name == "zstd" ? std::optional(Packing::Zstd)
                          : std::nullopt;
}

Result<bool> read_chunk(ByteSource& outer, std::uint64_t length, const ChunkKind& kind, ExpansionBudget& budget,
                        const RunControl& control, const ReadChunk& read) {
  const std::string where = "The chunk at byte " + std::to_string(outer.offset());
  Stretch stretch(outer, length);
  Unpacked unpacked(stretch, kind.packing, budget);
  ByteReader& plain = kind.packing == Packing::None ? static_cast<ByteReader&>(stretch) : unpacked;
  ::uLong crc = 0;
  ByteSource content(std::make_unique<Summed>(plain, kind.crc32 ? &crc : nullptr));
  auto whole = read(content);
  if (!whole && whole.error().code == ErrorCode::CorruptCompression && !stretch.ended_early()) {
    return fail(ErrorCode::CorruptCompression, where + " is damaged: it does not decompress.");
  }
  if (!whole && whole.error().code != ErrorCode::CorruptCompression) {
    return whole;
  }
  auto rest = skip_bytes(outer, stretch.left(), control);
  if (!rest) {
    return fail(rest.error());
  }
  if (stretch.ended_early() || *rest < stretch.left()) {
    return false;
  }
  if (!*whole) {
    return fail(ErrorCode::ShapeMismatch, where + " ends within a record.");
  }
  if (kind.crc32 && crc != *kind.crc32) {
    return fail(ErrorCode::CorruptCompression, where + " is damaged: its checksum is wrong.");
  }
  return true;
}

}  // namespace driftlab
