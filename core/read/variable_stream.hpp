#pragma once
/// Named arrays as bytes: how `driftlab-decode` hands what it has read to the program that asked for it. Internal to
/// core/read and clients/decode, which are built together; the bytes never leave the machine.
///
/// Records, each of one letter and, in the machine's own byte order:
///   V  name (u32 bytes), rows u64, columns u64, then the values, column by column, as doubles
///   N  a sentence for the user (u32 bytes)
///   E  an error: its code (u32) and its sentence (u32 bytes); nothing follows
///   Z  the end: everything was read
#include "core/read/variables.hpp"
#include "core/signal/result.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

/// Writes the records to a file descriptor. False once a write has failed, as when the reader has closed the stream.
class VariableWriter {
 public:
  explicit VariableWriter(int fd) : fd_(fd) {}
  bool variable(std::string_view name, std::span<const std::vector<double>> columns);
  bool note(std::string_view sentence);
  bool error(const Error& error);
  bool end();

 private:
  bool bytes(const void* data, std::size_t size);
  bool number(std::uint64_t value, std::size_t size);
  bool text(std::string_view text);
  int fd_;
};

/// What was read of a stream.
struct VariableStream {
  std::vector<Variable> variables;
  std::vector<std::string> notes;
  bool whole = false;  ///< the end was there
};

/// Reads the records. `read(into)` delivers the next bytes: at least one unless the stream has ended, 0 then. Arrays of
/// more than `budget_bytes` together, their names and empty columns included, and names of more than `most_text` bytes
/// end it; notes beyond the 64th are dropped. Errors: LimitExceeded, also where an E record says it, ShapeMismatch for
/// any other E record; those of `read`. A stream that breaks off is not `whole`.
[[nodiscard]] Result<VariableStream> read_variables(const std::function<Result<std::size_t>(std::span<char>)>& read,
                                                    std::size_t budget_bytes, std::size_t most_text);

}  // namespace driftlab
