/// NumPy .npy, versions 1 to 3: float32, float64 or whole numbers of 8 to 64 bits (rounded to float64 beyond 2^53), of
/// either byte order, 1-D or samples x channels, C or Fortran order.
/// Source: numpy/lib/format.py, "Format Version 1.0" to "3.0" of the NumPy manual (NEP 1).
#include "core/read/formats.hpp"
#include "core/read/npy_header.hpp"
#include "core/signal/missing.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::size_t kBatchBytes = std::size_t{1} << 17;

template <class Word>
Word byte_swapped(Word word) {
  Word swapped = 0;
  for (std::size_t i = 0; i < sizeof word; ++i) {
    swapped = static_cast<Word>(swapped << 8U) | static_cast<Word>(word & 0xFFU);
    word = static_cast<Word>(word >> 8U);
  }
  return swapped;
}

/// The numbers in `bytes` (any alignment) as doubles. Returns whether all are finite.
template <class Number, class Word>
bool convert(std::string_view bytes, bool swap, double* into) {
  bool finite = true;
  const std::size_t count = bytes.size() / sizeof(Word);
  for (std::size_t i = 0; i < count; ++i) {
    Word word = 0;
    std::memcpy(&word, bytes.data() + i * sizeof word, sizeof word);
    const auto value = static_cast<double>(std::bit_cast<Number>(swap ? byte_swapped(word) : word));
    finite = finite && std::isfinite(value);
    into[i] = value;
  }
  return finite;
}

using Converter = bool (*)(std::string_view bytes, bool swap, double* into);

/// For the elements that a header declares.
Converter converter_of(const NpyHeader& header) {
  if (header.kind == NpyKind::Float) {
    return header.item_bytes == 8 ? convert<double, std::uint64_t> : convert<float, std::uint32_t>;
  }
  const bool is_signed = header.kind == NpyKind::Signed;
  switch (header.item_bytes) {
    case 1:
      return is_signed ? convert<std::int8_t, std::uint8_t> : convert<std::uint8_t, std::uint8_t>;
    case 2:
      return is_signed ? convert<std::int16_t, std::uint16_t> : convert<std::uint16_t, std::uint16_t>;
    case 4:
      return is_signed ? convert<std::int32_t, std::uint32_t> : convert<std::uint32_t, std::uint32_t>;
    default:
      return is_signed ? convert<std::int64_t, std::uint64_t> : convert<std::uint64_t, std::uint64_t>;
  }
}

class NpyDecoder {
 public:
  NpyDecoder(ByteSource& source, ColumnSink& sink, const RunControl& control, const NpyHeader& header)
      : source_(source), sink_(sink), control_(control), header_(header), total_(header.rows * header.columns) {}

  Status run();

 private:
  Status deliver(std::span<const double> values);
  void mark_missing(std::span<double> values) const;
  [[nodiscard]] Status ends_early(std::size_t left_over) const;

  ByteSource& source_;
  ColumnSink& sink_;
  const RunControl& control_;
  const NpyHeader& header_;
  std::uint64_t total_;      ///< numbers declared
  std::uint64_t taken_ = 0;  ///< numbers delivered
};

Status NpyDecoder::run() {
  const Converter converter = converter_of(header_);
  // Whole rows in C order, so that every batch is a block of rows.
  const std::size_t unit = header_.fortran_order ? 1 : header_.columns;
  std::vector<double> batch(std::max<std::size_t>(kBatchBytes / header_.item_bytes / unit, 1) * unit);
  while (taken_ < total_) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source_.view(unit * header_.item_bytes);
    if (!view) {
      return fail(view.error());
    }
    if (view->size() < unit * header_.item_bytes) {
      return ends_early(view->size());
    }
    const std::uint64_t left = total_ - taken_;
    std::size_t count = std::min<std::uint64_t>({view->size() / header_.item_bytes, batch.size(), left});
    count -= count % unit;
    const std::string_view bytes = view->substr(0, count * header_.item_bytes);
    const bool finite = converter(bytes, header_.swap, batch.data());
    const std::span<double> values(batch.data(), count);
    if (!finite) {
      mark_missing(values);
    }
    source_.consume(bytes.size());
    if (auto status = deliver(values); !status) {
      return status;
    }
  }
  auto rest = source_.view();
  if (!rest) {
    return fail(rest.error());
  }
  if (!rest->empty()) {
    return fail(ErrorCode::ShapeMismatch, "The header declares " + header_.shape_text() + " numbers of " +
                                              std::to_string(header_.item_bytes) +
                                              " bytes, but the file holds more bytes than that.");
  }
  return {};
}

Status NpyDecoder::deliver(std::span<const double> values) {
  if (!header_.fortran_order) {
    taken_ += values.size();
    return sink_.rows(values);
  }
  while (!values.empty()) {
    const auto column = static_cast<std::size_t>(taken_ / header_.rows);
    const std::size_t count = std::min<std::uint64_t>(values.size(), header_.rows - taken_ % header_.rows);
    if (auto status = sink_.column(column, values.first(count)); !status) {
      return status;
    }
    taken_ += count;
    values = values.subspan(count);
  }
  return {};
}

/// NaN and infinities as missing samples that know their row.
void NpyDecoder::mark_missing(std::span<double> values) const {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) {
      const std::uint64_t index = taken_ + i;
      const std::uint64_t row = header_.fortran_order ? index % header_.rows : index / header_.columns;
      values[i] = missing_sample(std::isnan(values[i]) ? Missing::Nan : Missing::Infinite, row + 1);
    }
  }
}

Status NpyDecoder::ends_early(std::size_t left_over) const {
  const std::uint64_t held = taken_ * header_.item_bytes + left_over;
  return fail(
      ErrorCode::Truncated,
      "The header declares " + header_.shape_text() + " numbers of " + std::to_string(header_.item_bytes) +
          " bytes, but only " + std::to_string(held) +
          " bytes follow it: the file is cut short, or its header is wrong.",
      {{"row", std::to_string(header_.fortran_order ? taken_ % header_.rows + 1 : taken_ / header_.columns + 1)}});
}

int sniff(std::string_view head) { return head.starts_with("\x93NUMPY") ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  auto header = read_npy_header(source, limits);
  if (!header) {
    return fail(header.error());
  }
  ColumnLayout layout;
  for (std::size_t i = 0; i < header->columns; ++i) {
    layout.names.push_back(std::to_string(i));
  }
  if (auto status = sink.begin(layout); !status) {
    return status;
  }
  return NpyDecoder(source, sink, control, *header).run();
}

}  // namespace

const Format kNpy{"npy", "NumPy array of floats or whole numbers, one- or two-dimensional", sniff, decode};

}  // namespace driftlab::formats
