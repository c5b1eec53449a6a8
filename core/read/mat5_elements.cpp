#include "core/read/mat5_elements.hpp"

#include "core/read/text_shape.hpp"
#include "core/signal/missing.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace driftlab::mat5 {
namespace {

constexpr int kDeepest = 8;  // structs in structs
constexpr std::size_t kMostFields = 4096;

tl::unexpected<Error> contradicts(const std::string& what) {
  return fail(ErrorCode::ShapeMismatch, "The MATLAB file contradicts itself: " + what + ".");
}

template <class Word>
Word load(std::string_view bytes, std::size_t at, bool swap) {
  Word word{};
  std::memcpy(&word, bytes.data() + at, sizeof word);
  if (swap) {
    std::array<char, sizeof(Word)> turned{};
    std::memcpy(turned.data(), &word, sizeof word);
    std::reverse(turned.begin(), turned.end());
    std::memcpy(&word, turned.data(), sizeof word);
  }
  return word;
}

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Elements one after the other.
class Elements {
 public:
  Elements(std::string_view bytes, bool swap) : rest_(bytes), swap_(swap) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }

  [[nodiscard]] Result<Element> next() {
    if (rest_.size() < 8) {
      return contradicts("an element ends inside its tag");
    }
    const auto word = load<std::uint32_t>(rest_, 0, swap_);
    if (word >> 16U != 0) {  // the small form: the data lie in the tag
      const std::size_t size = word >> 16U;
      if (size > 4) {
        return contradicts("a small element is larger than its tag");
      }
      const Element element{word & 0xFFFFU, rest_.substr(4, size)};
      rest_.remove_prefix(8);
      return element;
    }
    const std::size_t size = load<std::uint32_t>(rest_, 4, swap_);
    if (size > rest_.size() - 8) {
      return contradicts("an element is longer than what holds it");
    }
    const Element element{word, rest_.substr(8, size)};
    rest_.remove_prefix(std::min(rest_.size(), 8 + (size + 7) / 8 * 8));
    return element;
  }

 private:
  std::string_view rest_;
  bool swap_;
};

std::size_t bytes_of(std::uint32_t type) {
  switch (type) {
    case Int8:
    case UInt8:
      return 1;
    case Int16:
    case UInt16:
      return 2;
    case Int32:
    case UInt32:
    case Single:
      return 4;
    case Double:
    case Int64:
    case UInt64:
      return 8;
    default:
      return 0;
  }
}

double number_at(const Element& element, std::size_t index, bool swap) {
  const std::string_view data = element.data;
  switch (element.type) {
    case Int8:
      return load<std::int8_t>(data, index, swap);
    case UInt8:
      return load<std::uint8_t>(data, index, swap);
    case Int16:
      return load<std::int16_t>(data, index * 2, swap);
    case UInt16:
      return load<std::uint16_t>(data, index * 2, swap);
    case Int32:
      return load<std::int32_t>(data, index * 4, swap);
    case UInt32:
      return load<std::uint32_t>(data, index * 4, swap);
    case Single:
      return load<float>(data, index * 4, swap);
    case Int64:
      return static_cast<double>(load<std::int64_t>(data, index * 8, swap));
    case UInt64:
      return static_cast<double>(load<std::uint64_t>(data, index * 8, swap));
    default:
      return load<double>(data, index * 8, swap);
  }
}

/// Array classes (table 1-3), for sentences.
std::string_view class_name(unsigned array_class) {
  constexpr std::array<std::string_view, 18> kNames{"unknown", "cell",   "struct", "object", "char",     "sparse",
                                                    "double",  "single", "int8",   "uint8",  "int16",    "uint16",
                                                    "int32",   "uint32", "int64",  "uint64", "function", "opaque"};
  return array_class < kNames.size() ? kNames[array_class] : kNames[0];
}

constexpr unsigned kStruct = 2;
constexpr unsigned kFirstNumeric = 6;
constexpr unsigned kLastNumeric = 15;
constexpr unsigned kOpaque = 17;
constexpr unsigned kComplex = 0x08;

class MatrixReader {
 public:
  MatrixReader(bool swap, std::size_t& budget_bytes, Contents& contents)
      : swap_(swap), budget_bytes_(budget_bytes), contents_(contents) {}

  Status read(std::string_view body, const std::string& given_name, int depth);

 private:
  struct Head {
    unsigned array_class = 0;
    unsigned flags = 0;
    std::vector<std::int64_t> dimensions;
    std::string name;
  };
  Result<Head> read_head(Elements& elements) const;
  Status read_numbers(Elements& elements, const Head& head, const std::string& name);
  Status read_struct(Elements& elements, const std::string& name, int depth);
  Status leave_out(const std::string& name, std::string_view why) {
    contents_.left_out.push_back("'" + name + "' (" + std::string(why) + ")");
    return {};
  }

  bool swap_;
  std::size_t& budget_bytes_;
  Contents& contents_;
};

Result<MatrixReader::Head> MatrixReader::read_head(Elements& elements) const {
  Head head;
  auto flags = elements.next();
  if (!flags) {
    return fail(flags.error());
  }
  if (flags->data.size() < 4) {
    return contradicts("a matrix has no flags");
  }
  const auto word = load<std::uint32_t>(flags->data, 0, swap_);
  head.array_class = word & 0xFFU;
  head.flags = (word >> 8U) & 0xFFU;
  if (head.array_class == kOpaque) {
    return head;  // an object: its layout is not published
  }
  auto dimensions = elements.next();
  if (!dimensions) {
    return fail(dimensions.error());
  }
  for (std::size_t i = 0; i + 4 <= dimensions->data.size(); i += 4) {
    head.dimensions.push_back(load<std::int32_t>(dimensions->data, i, swap_));
  }
  auto name = elements.next();
  if (!name) {
    return fail(name.error());
  }
  head.name = text::to_utf8(name->data);
  return head;
}

Status MatrixReader::read(std::string_view body, const std::string& given_name, int depth) {
  Elements elements(body, swap_);
  auto head = read_head(elements);
  if (!head) {
    return fail(head.error());
  }
  const std::string name = given_name.empty() ? head->name : given_name;
  if (head->array_class == kStruct) {
    const bool one = head->dimensions == std::vector<std::int64_t>{1, 1};
    return one && depth < kDeepest ? read_struct(elements, name, depth) : leave_out(name, "an array of structs");
  }
  if (head->array_class < kFirstNumeric || head->array_class > kLastNumeric) {
    return leave_out(name, class_name(head->array_class));
  }
  if ((head->flags & kComplex) != 0) {
    return leave_out(name, "complex");
  }
  return read_numbers(elements, *head, name);
}

Status MatrixReader::read_numbers(Elements& elements, const Head& head, const std::string& name) {
  if (head.dimensions.size() != 2) {
    return leave_out(name, std::to_string(head.dimensions.size()) + " dimensions");
  }
  const std::int64_t rows = head.dimensions[0];
  const std::int64_t columns = head.dimensions[1];
  if (rows <= 0 || columns <= 0) {
    return leave_out(name, "empty");
  }
  auto element = elements.next();
  if (!element) {
    return fail(element.error());
  }
  const std::size_t item = bytes_of(element->type);
  if (item == 0) {
    return contradicts("'" + name + "' holds numbers of an unknown type");
  }
  const std::size_t count = element->data.size() / item;
  const auto wanted = static_cast<std::uint64_t>(rows) * static_cast<std::uint64_t>(columns);  // both below 2^31
  if (count != wanted) {
    return contradicts("'" + name + "' declares " + std::to_string(rows) + " x " + std::to_string(columns) +
                       " numbers and holds " + std::to_string(count));
  }
  if (count * sizeof(double) > budget_bytes_) {
    return fail(ErrorCode::LimitExceeded, "The MATLAB file holds more numbers than can be put together.");
  }
  budget_bytes_ -= count * sizeof(double);
  Variable variable{name, std::vector<std::vector<double>>(static_cast<std::size_t>(columns))};
  std::size_t index = 0;
  for (auto& column : variable.columns) {
    column.resize(static_cast<std::size_t>(rows));
    for (std::size_t row = 0; row < column.size(); ++row) {
      const double value = number_at(*element, index++, swap_);
      column[row] =
          std::isfinite(value) ? value : missing_sample(std::isnan(value) ? Missing::Nan : Missing::Infinite, row + 1);
    }
  }
  contents_.variables.push_back(std::move(variable));
  return {};
}

Status MatrixReader::read_struct(Elements& elements, const std::string& name, int depth) {
  auto length = elements.next();
  if (!length) {
    return fail(length.error());
  }
  auto names = elements.next();
  if (!names) {
    return fail(names.error());
  }
  if (length->data.size() < 4) {
    return contradicts("a struct does not say how long its names are");
  }
  const auto each = load<std::uint32_t>(length->data, 0, swap_);
  if (each == 0 || names->data.size() / each > kMostFields) {
    return contradicts("a struct has names of no length, or too many");
  }
  for (std::size_t at = 0; at + each <= names->data.size(); at += each) {
    const std::string_view field = names->data.substr(at, each);
    auto element = elements.next();
    if (!element) {
      return fail(element.error());
    }
    if (element->type != Matrix || element->data.empty()) {
      continue;  // an empty field
    }
    const std::string full = name + "." + text::to_utf8(field.substr(0, field.find('\0')));
    if (auto status = read(element->data, full, depth + 1); !status) {
      return status;
    }
  }
  return {};
}

}  // namespace

Status read_matrix(std::string_view body, bool swap, std::size_t& budget_bytes, Contents& contents) {
  return MatrixReader(swap, budget_bytes, contents).read(body, "", 0);
}

}  // namespace driftlab::mat5
