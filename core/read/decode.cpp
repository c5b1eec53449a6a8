#include "core/read/bag_folder.hpp"
#include "core/read/column_file.hpp"
#include "core/read/euroc.hpp"
#include "core/read/format.hpp"
#include "core/read/kitti.hpp"
#include "core/read/phone_export.hpp"
#include "core/read/recognised_stream.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace driftlab {
namespace {

/// Passes on to another sink; counts rows, reports progress and stops when asked, so that no format has to.
class WatchingSink final : public ColumnSink {
 public:
  WatchingSink(ColumnSink& next, const ByteSource& source, const DecodeLimits& limits, const RunControl& control)
      : next_(next),
        source_(source),
        limits_(limits),
        budget_(limits.columns_budget(source.input_size())),
        control_(control) {}

  Status begin(const ColumnLayout& layout) override {
    auto sound = sound_layout(layout);
    if (!sound) {
      return fail(sound.error());
    }
    decoded_.names = sound->names;
    decoded_.has_header = layout.has_header;
    return next_.begin(*sound);
  }
  Status rows(std::span<const double> values) override {
    decoded_.rows += values.size() / decoded_.names.size();
    auto status = watch(values.size());
    return status ? next_.rows(values) : status;
  }
  Status column(std::size_t index, std::span<const double> values) override {
    decoded_.rows += index == 0 ? values.size() : 0;
    auto status = watch(values.size());
    return status ? next_.column(index, values) : status;
  }
  void note(std::string sentence) override {
    if (decoded_.notes.size() >= limits_.max_notes) {
      ++notes_left_out_;
      return;
    }
    sentence = sound_note(sentence, limits_);
    decoded_.notes.push_back(sentence);
    next_.note(std::move(sentence));
  }
  /// What was decoded, once everything was.
  [[nodiscard]] Decoded finished() {
    if (notes_left_out_ > 0) {
      decoded_.notes.push_back("There are " + std::to_string(notes_left_out_) + " more notes of this kind.");
    }
    return std::move(decoded_);
  }
  [[nodiscard]] Decoded& decoded() { return decoded_; }

 private:
  Status watch(std::size_t values) {
    budget_used_ += values * sizeof(double);
    if (budget_used_ > budget_) {
      return fail(ErrorCode::DecompressionLimit, "The columns of this file of " + std::to_string(source_.input_size()) +
                                                     " bytes take more than the " + std::to_string(budget_) +
                                                     " bytes that it may become.");
    }
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    control_.report("decode", std::min(source_.fraction(), 0.99));
    return {};
  }

  ColumnSink& next_;
  const ByteSource& source_;
  const DecodeLimits& limits_;
  std::uint64_t budget_;  ///< bytes of columns
  std::uint64_t budget_used_ = 0;
  std::size_t notes_left_out_ = 0;
  const RunControl& control_;
  Decoded decoded_;
};

/// The column file as a sink.
class FileSink final : public ColumnSink {
 public:
  explicit FileSink(std::filesystem::path path) : path_(std::move(path)) {}

  Status begin(const ColumnLayout& layout) override {
    auto writer = ColumnFileWriter::create(path_, layout.names);
    if (!writer) {
      return fail(writer.error());
    }
    writer_ = std::make_unique<ColumnFileWriter>(std::move(*writer));
    return {};
  }
  Status rows(std::span<const double> values) override { return writer_->append_rows(values); }
  Status column(std::size_t index, std::span<const double> values) override {
    return writer_->append_column(index, values);
  }
  void note(std::string) override {}
  Result<std::size_t> finish() { return writer_->finish(); }

 private:
  std::filesystem::path path_;
  std::unique_ptr<ColumnFileWriter> writer_;  ///< from begin() on
};

/// A folder as one recording; `nothing` stands for the bytes it does not have.
Result<Decoded> decode_tables(const std::filesystem::path& folder, std::unique_ptr<ByteReader> nothing,
                              ColumnSink& sink, const DecodeLimits& limits, const RunControl& control) {
  const ByteSource source(std::move(nothing));
  WatchingSink watching(sink, source, limits, control);
  const bool kitti = is_kitti_folder(folder);
  const auto euroc = kitti ? std::nullopt : find_euroc_table(folder);
  auto status = kitti   ? decode_kitti_folder(folder, limits, watching, control)
                : euroc ? decode_euroc_table(*euroc, limits, watching, control)
                        : decode_folder(folder, limits, watching, control);
  if (!status) {
    return fail(sound_error(status.error()));
  }
  watching.decoded().format = kitti ? "kitti_folder" : euroc ? "euroc_folder" : "phone_folder";
  control.report("decode", 1.0);
  return watching.finished();
}

}  // namespace

Result<Decoded> decode_stream(std::unique_ptr<ByteReader> reader, ColumnSink& sink, const DecodeLimits& limits,
                              const RunControl& control) {
  auto stream = recognise_stream(std::move(reader), limits);
  if (!stream) {
    return fail(stream.error());
  }
  ByteSource& source = stream->source;
  WatchingSink watching(sink, source, limits, control);
  if (auto status = stream->format->decode(source, limits, watching, control); !status) {
    return fail(sound_error(status.error()));
  }
  watching.decoded().format = stream->format->name;
  watching.decoded().compression = stream->compression;
  control.report("decode", 1.0);
  return watching.finished();
}

Result<Decoded> decode_file(const std::filesystem::path& input, const std::filesystem::path& output,
                            const DecodeLimits& limits, const RunControl& control) {
  std::error_code none;
  const bool directory = std::filesystem::is_directory(input, none);
  const auto bag = directory ? find_bag_file(input) : Result<std::optional<std::filesystem::path>>(std::nullopt);
  if (!bag) {
    return fail(bag.error());
  }
  const bool folder = directory && !*bag;
  auto reader =
      folder ? Result<std::unique_ptr<ByteReader>>(make_memory_reader("")) : open_file_reader(bag->value_or(input));
  if (!reader) {
    return fail(reader.error());
  }
  FileSink sink(output);
  auto decoded = folder ? decode_tables(input, std::move(*reader), sink, limits, control)
                        : decode_stream(std::move(*reader), sink, limits, control);
  if (!decoded) {
    return decoded;
  }
  auto rows = sink.finish();
  if (!rows) {
    return fail(rows.error());
  }
  return decoded;
}

}  // namespace driftlab
