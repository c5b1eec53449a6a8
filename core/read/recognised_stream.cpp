#include "core/read/recognised_stream.hpp"

#include "core/read/text_shape.hpp"
#include "core/read/zip_entries.hpp"

#include <memory>
#include <set>
#include <utility>

namespace driftlab {
namespace {

/// The surest format; nullptr if none is, or none is certain and the bytes are those of a foreign format.
const Format* recognise(std::string_view head) {
  const Format* best = nullptr;
  constexpr int kCertain = 100;
  int score = recognise_foreign(head) ? kCertain - 1 : 0;
  for (const Format* const format : all_formats()) {
    const int sure = format->sniff(head);
    if (sure > score) {
      best = format;
      score = sure;
    }
  }
  return best;
}

/// Another reader, whose lack of further bytes is the end of the input.
class CutReader final : public ByteReader {
 public:
  explicit CutReader(std::unique_ptr<ByteReader> whole) : whole_(std::move(whole)) {}
  Result<std::size_t> read(std::span<char> into) override {
    auto count = whole_->read(into);
    return !count && count.error().code == ErrorCode::Truncated ? Result<std::size_t>(std::size_t{0}) : count;
  }
  [[nodiscard]] double fraction() const override { return whole_->fraction(); }
  [[nodiscard]] std::uint64_t size() const override { return whole_->size(); }

 private:
  std::unique_ptr<ByteReader> whole_;
};

}  // namespace

Result<RecognisedStream> recognise_stream(std::unique_ptr<ByteReader> reader, const DecodeLimits& limits,
                                          StreamEnd end) {
  ByteSource source(std::move(reader));
  auto head = source.view(8);
  if (!head) {
    return fail(head.error());
  }
  if (head->empty()) {
    return fail(ErrorCode::EmptyInput, "The file is empty.");
  }
  const Compression compression = sniff_compression(*head);
  if (compression != Compression::None) {
    auto plain = make_decompressor(compression, std::move(source), limits);
    if (!plain) {
      return fail(plain.error());
    }
    source =
        ByteSource(end == StreamEnd::Anywhere ? std::make_unique<CutReader>(std::move(*plain)) : std::move(*plain));
  }
  head = source.view(kSniffBytes);
  if (!head) {
    return fail(head.error());
  }
  if (head->empty()) {
    return fail(ErrorCode::EmptyInput, "The " + std::string(name_of(compression)) + " file holds no bytes.");
  }
  const std::string seen(head->substr(0, kSniffBytes));
  std::string files;
  if (is_zip(seen)) {
    auto headers = zip_headers(source);
    if (!headers) {
      return fail(headers.error());
    }
    files = std::move(*headers);
  }
  const Format* const format = recognise(files.empty() ? seen : files);
  if (format == nullptr) {
    const std::string looks = describe_unknown(seen);
    return fail(ErrorCode::UnsupportedFormat, "This looks like " + looks + ".", {{"looks_like", looks}});
  }
  return RecognisedStream{std::move(source), compression, format};
}

Result<ColumnLayout> sound_layout(const ColumnLayout& layout) {
  ColumnLayout sound = layout;
  std::set<std::string_view> seen;
  for (std::string& name : sound.names) {
    name = text::mended_utf8(name);
    if (!seen.insert(name).second) {
      return fail(ErrorCode::DuplicateColumn, "Two columns are called '" + name + "'; give each its own name.",
                  {{"column", name}});
    }
  }
  return sound;
}

std::string sound_note(std::string_view note, const DecodeLimits& limits) {
  const std::string mended = text::mended_utf8(note);
  return mended.size() <= limits.max_note_bytes ? mended
                                                : std::string(text::front_of(mended, limits.max_note_bytes)) + "...";
}

Error sound_error(Error error) {
  error.message = text::mended_utf8(error.message);
  for (ErrorField& field : error.fields) {
    field.value = text::mended_utf8(field.value);
  }
  return error;
}

}  // namespace driftlab
