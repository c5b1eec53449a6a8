#include "core/read/variable_stream.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

namespace driftlab {
namespace {

constexpr std::size_t kMostNotes = 64;
constexpr std::size_t kMostColumns = 4096;

/// Takes whole values out of what `read` delivers.
class Taker {
 public:
  explicit Taker(const std::function<Result<std::size_t>(std::span<char>)>& read) : read_(read) {}

  /// False at the end of the stream.
  Result<bool> take(void* into, std::size_t size) {
    auto* out = static_cast<char*>(into);
    while (size > 0) {
      auto got = read_({out, size});
      if (!got) {
        return fail(got.error());
      }
      if (*got == 0) {
        return false;
      }
      out += *got;
      size -= *got;
    }
    return true;
  }

  /// False at the end of the stream.
  Result<bool> text(std::string& into, std::size_t most) {
    std::uint32_t size = 0;
    auto there = take(&size, sizeof size);
    if (!there || !*there) {
      return there;
    }
    if (size > most) {
      return fail(ErrorCode::LimitExceeded, "A name in the file has more than " + std::to_string(most) + " bytes.",
                  {{"limit", std::to_string(most)}});
    }
    into.assign(size, '\0');
    return take(into.data(), size);
  }

 private:
  const std::function<Result<std::size_t>(std::span<char>)>& read_;
};

/// One V record behind its letter; false where the stream breaks off.
Result<bool> take_variable(Taker& taker, std::size_t most_text, std::size_t& budget_bytes, VariableStream& stream) {
  Variable variable;
  auto there = taker.text(variable.name, most_text);
  if (!there || !*there) {
    return there;
  }
  std::uint64_t shape[2] = {0, 0};
  there = taker.take(shape, sizeof shape);
  if (!there || !*there) {
    return there;
  }
  const std::uint64_t rows = shape[0];
  const std::uint64_t columns = shape[1];
  // An array without samples takes memory too: a stream of nothing else must end.
  const std::uint64_t own = sizeof(Variable) + variable.name.size() + columns * sizeof(std::vector<double>);
  const bool fits = columns <= kMostColumns && own <= budget_bytes;
  const std::uint64_t most = fits ? (budget_bytes - own) / sizeof(double) : 0;
  if (!fits || (columns > 0 && rows > most / columns)) {
    return fail(ErrorCode::LimitExceeded, "The arrays of the file take more memory than one decoding may.");
  }
  budget_bytes -= own + rows * columns * sizeof(double);
  for (std::uint64_t c = 0; c < columns; ++c) {
    std::vector<double>& column = variable.columns.emplace_back(rows);
    there = taker.take(column.data(), rows * sizeof(double));
    if (!there || !*there) {
      return there;
    }
  }
  stream.variables.push_back(std::move(variable));
  return true;
}

Result<bool> take_error(Taker& taker, std::size_t most_text) {
  std::uint32_t code = 0;
  auto there = taker.take(&code, sizeof code);
  if (!there || !*there) {
    return there;
  }
  std::string sentence;
  there = taker.text(sentence, most_text);
  if (!there || !*there) {
    return there;
  }
  // What the process says of a file; it knows nothing of disks and of this program.
  const bool too_much = code == static_cast<std::uint32_t>(ErrorCode::LimitExceeded);
  return fail(too_much ? ErrorCode::LimitExceeded : ErrorCode::ShapeMismatch, std::move(sentence));
}

}  // namespace

bool VariableWriter::bytes(const void* data, std::size_t size) {
  const auto* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(fd_, from, size);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      return false;
    }
    from += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

bool VariableWriter::number(std::uint64_t value, std::size_t size) {
  const auto small = static_cast<std::uint32_t>(value);
  return size == sizeof small ? bytes(&small, size) : bytes(&value, size);
}

bool VariableWriter::text(std::string_view text) {
  return number(text.size(), sizeof(std::uint32_t)) && bytes(text.data(), text.size());
}

bool VariableWriter::variable(std::string_view name, std::span<const std::vector<double>> columns) {
  const std::size_t rows = columns.empty() ? 0 : columns.front().size();
  bool sound = bytes("V", 1) && text(name) && number(rows, sizeof(std::uint64_t)) &&
               number(columns.size(), sizeof(std::uint64_t));
  for (const std::vector<double>& column : columns) {
    sound = sound && bytes(column.data(), column.size() * sizeof(double));
  }
  return sound;
}

bool VariableWriter::note(std::string_view sentence) { return bytes("N", 1) && text(sentence); }

bool VariableWriter::error(const Error& error) {
  return bytes("E", 1) && number(static_cast<std::uint64_t>(error.code), sizeof(std::uint32_t)) && text(error.message);
}

bool VariableWriter::end() { return bytes("Z", 1); }

Result<VariableStream> read_variables(const std::function<Result<std::size_t>(std::span<char>)>& read,
                                      std::size_t budget_bytes, std::size_t most_text) {
  Taker taker(read);
  VariableStream stream;
  for (;;) {
    char kind = 0;
    auto there = taker.take(&kind, 1);
    if (there && *there && kind == 'V') {
      there = take_variable(taker, most_text, budget_bytes, stream);
    } else if (there && *there && kind == 'E') {
      there = take_error(taker, most_text);
    } else if (there && *there && kind == 'N') {
      std::string note;
      there = taker.text(note, 4 * most_text);
      if (there && *there && stream.notes.size() < kMostNotes) {
        stream.notes.push_back(std::move(note));
      }
    } else {
      stream.whole = there && *there && kind == 'Z';
    }
    if (!there) {
      return fail(there.error());
    }
    if (!*there || stream.whole || (kind != 'V' && kind != 'N')) {
      return stream;
    }
  }
}

}  // namespace driftlab
