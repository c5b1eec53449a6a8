#include "core/read/npy_header.hpp"

#include "core/read/text_shape.hpp"

#include <bit>
#include <charconv>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

namespace driftlab::formats {
namespace {

constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 16;

/// The dictionary as written, before anything is concluded from it.
struct Written {
  std::optional<std::string> descr;  ///< for a structured type: its text
  bool structured = false;
  std::optional<bool> fortran_order;
  std::optional<std::vector<std::uint64_t>> shape;
  bool shape_overflows = false;
};

/// Reads the Python literal {'descr': '<f8', 'fortran_order': False, 'shape': (10, 6), } and nothing beyond it.
class LiteralReader {
 public:
  explicit LiteralReader(std::string_view text) : rest_(text) {}

  std::optional<Written> read() {
    Written written;
    if (!take('{')) {
      return std::nullopt;
    }
    while (!take('}')) {
      const auto key = take_string();
      if (!key || !take(':') || !take_value(*key, written)) {
        return std::nullopt;
      }
      if (!take(',') && !next_is('}')) {
        return std::nullopt;
      }
    }
    skip_blanks();
    return rest_.empty() ? std::optional(written) : std::nullopt;
  }

 private:
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size())); }
  bool next_is(char c) {
    skip_blanks();
    return !rest_.empty() && rest_.front() == c;
  }
  bool take(char c) {
    if (!next_is(c)) {
      return false;
    }
    rest_.remove_prefix(1);
    return true;
  }
  bool take_word(std::string_view word) {
    skip_blanks();
    if (!rest_.starts_with(word)) {
      return false;
    }
    rest_.remove_prefix(word.size());
    return true;
  }
  std::optional<std::string> take_string() {
    skip_blanks();
    if (rest_.empty() || (rest_.front() != '\'' && rest_.front() != '"')) {
      return std::nullopt;
    }
    const std::size_t end = rest_.find(rest_.front(), 1);
    if (end == std::string_view::npos) {
      return std::nullopt;
    }
    std::string text(rest_.substr(1, end - 1));
    rest_.remove_prefix(end + 1);
    return text;
  }
  bool take_value(const std::string& key, Written& written) {
    if (key == "descr" && !written.descr) {
      return take_descr(written);
    }
    if (key == "fortran_order" && !written.fortran_order) {
      const bool yes = take_word("True");
      written.fortran_order = yes;
      return yes || take_word("False");
    }
    return key == "shape" && !written.shape && take_shape(written);
  }
  bool take_descr(Written& written) {
    if (next_is('[')) {  // a structured type is a list of tuples; brackets are all that has to match
      std::size_t depth = 0;
      for (std::size_t i = 0; i < rest_.size(); ++i) {
        depth += rest_[i] == '[' ? 1 : 0;
        depth -= rest_[i] == ']' ? 1 : 0;
        if (depth == 0) {
          written.descr = std::string(rest_.substr(0, i + 1));
          written.structured = true;
          rest_.remove_prefix(i + 1);
          return true;
        }
      }
      return false;
    }
    written.descr = take_string();
    return written.descr.has_value();
  }
  bool take_shape(Written& written) {
    if (!take('(')) {
      return false;
    }
    std::vector<std::uint64_t> shape;
    while (!take(')')) {
      skip_blanks();
      std::uint64_t extent = 0;
      const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), extent);
      if (error == std::errc::invalid_argument) {
        return false;
      }
      written.shape_overflows = written.shape_overflows || error == std::errc::result_out_of_range;
      rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
      take_word("L");  // Python 2 wrote long integers as 10L
      shape.push_back(extent);
      if (!take(',') && !next_is(')')) {
        return false;
      }
    }
    written.shape = std::move(shape);
    return true;
  }

  std::string_view rest_;
};

tl::unexpected<Error> header_ends_early() {
  return fail(ErrorCode::Truncated, "The NumPy file ends inside its header.");
}

tl::unexpected<Error> unreadable_header() {
  return fail(ErrorCode::ShapeMismatch,
              "The header of the NumPy file cannot be read: it is not a dictionary of descr, "
              "fortran_order and shape.");
}

/// Takes magic, version and length; returns the dictionary's text.
Result<std::string> take_dictionary(ByteSource& source) {
  auto head = source.view(12);
  if (!head) {
    return fail(head.error());
  }
  if (head->size() < 10) {
    return header_ends_early();
  }
  const auto byte = [&head](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>((*head)[i])); };
  const std::size_t version = byte(6);
  if (version < 1 || version > 3) {
    return fail(ErrorCode::UnsupportedType,
                "The NumPy file has format version " + std::to_string(version) + "; versions 1 to 3 are read.");
  }
  const std::size_t front = version == 1 ? 10 : 12;
  if (head->size() < front) {
    return header_ends_early();
  }
  std::size_t length = byte(8) | (byte(9) << 8U);
  if (version > 1) {
    length |= (byte(10) << 16U) | (byte(11) << 24U);
  }
  if (length > kMaxHeaderBytes) {
    return fail(ErrorCode::LimitExceeded, "The header of the NumPy file claims " + std::to_string(length) +
                                              " bytes; a recording needs less than " + std::to_string(kMaxHeaderBytes) +
                                              ".");
  }
  auto whole = source.view(front + length);
  if (!whole) {
    return fail(whole.error());
  }
  if (whole->size() < front + length) {
    return header_ends_early();
  }
  std::string text(whole->substr(front, length));
  source.consume(front + length);
  return text;
}

Status apply_descr(const std::string& descr, bool structured, NpyHeader& header) {
  const auto one_of = [&](std::size_t at, std::string_view letters) {
    return letters.find(descr[at]) != std::string_view::npos;
  };
  const bool sized = !structured && descr.size() == 3 && one_of(0, "<>=|") && one_of(2, "1248");
  const bool known = sized && (descr[1] == 'f' ? one_of(2, "48") : one_of(1, "iu"));
  if (!known || (descr[0] == '|' && descr[2] != '1')) {
    return fail(ErrorCode::UnsupportedType,
                "The NumPy file holds elements of type " + text::excerpt(descr) +
                    "; float32, float64 and whole numbers of 8 to 64 bits ('<f8', '<i2', ...) are read: convert it, "
                    "as with array.astype(float).",
                {{"type", text::excerpt(descr)}});
  }
  header.kind = descr[1] == 'f' ? NpyKind::Float : descr[1] == 'i' ? NpyKind::Signed : NpyKind::Unsigned;
  header.item_bytes = static_cast<std::size_t>(descr[2] - '0');
  header.swap = descr[0] == (std::endian::native == std::endian::little ? '>' : '<');
  return {};
}

Status apply_shape(const std::vector<std::uint64_t>& shape, const DecodeLimits& limits, NpyHeader& header) {
  if (shape.empty() || shape.size() > 2) {
    return fail(ErrorCode::UnsupportedType, "The NumPy array has " + std::to_string(shape.size()) +
                                                " dimensions; a recording is samples, or samples x channels.");
  }
  header.rows = shape[0];
  const std::uint64_t columns = shape.size() == 2 ? shape[1] : 1;
  if (header.rows == 0) {
    return fail(ErrorCode::NoSamples, "The NumPy array has no samples: its first dimension is 0.");
  }
  if (columns == 0) {
    return fail(ErrorCode::NoSamples, "The NumPy array has no channels: its second dimension is 0.");
  }
  constexpr std::uint64_t kMost = std::numeric_limits<std::int64_t>::max();
  if (header.rows > kMost / columns / header.item_bytes) {
    return fail(ErrorCode::ShapeMismatch, "The shape " + std::to_string(header.rows) + " x " + std::to_string(columns) +
                                              " in the header of the NumPy file is larger than any file.");
  }
  if (columns > limits.max_columns) {
    return fail(ErrorCode::LimitExceeded, "The NumPy array has " + std::to_string(columns) + " channels; at most " +
                                              std::to_string(limits.max_columns) +
                                              " are read. Samples go down, channels across: transpose it?");
  }
  header.columns = static_cast<std::size_t>(columns);
  return {};
}

}  // namespace

Result<NpyHeader> read_npy_header(ByteSource& source, const DecodeLimits& limits) {
  auto text = take_dictionary(source);
  if (!text) {
    return fail(text.error());
  }
  const auto written = LiteralReader(*text).read();
  if (!written || !written->descr || !written->fortran_order || !written->shape) {
    return unreadable_header();
  }
  NpyHeader header;
  if (auto status = apply_descr(*written->descr, written->structured, header); !status) {
    return fail(status.error());
  }
  if (written->shape_overflows) {
    return fail(ErrorCode::ShapeMismatch, "The shape in the header of the NumPy file is larger than any file.");
  }
  if (auto status = apply_shape(*written->shape, limits, header); !status) {
    return fail(status.error());
  }
  header.fortran_order = *written->fortran_order && header.columns > 1;
  return header;
}

}  // namespace driftlab::formats
