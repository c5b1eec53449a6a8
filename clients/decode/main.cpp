/// driftlab-decode FORMAT BUDGET: reads a recording from descriptor 3 and writes its arrays to the standard output
/// (core/read/variable_stream.hpp). It is started by driftlab and driftlabd, never by hand.
#include "clients/decode/hdf5_variables.hpp"
#include "clients/decode/sandbox.hpp"
#include "core/signal/number.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdint>
#include <new>
#include <string_view>

namespace {

constexpr int kInput = 3;
constexpr int kMisuse = 2;
constexpr std::size_t kOwnNeed = std::size_t{256} << 20;  ///< libraries, buffers of chunks and the stack

}  // namespace

int main(int count, char** words) {
  using namespace driftlab;
  const std::string_view format = count == 3 ? words[1] : "";
  const auto budget = count == 3 ? parse_double(words[2]) : std::nullopt;
  struct stat input{};
  if (format != "hdf5" || !budget || *budget < 0.0 || ::fstat(kInput, &input) != 0) {
    return kMisuse;
  }
  const auto size = static_cast<std::size_t>(input.st_size);
  // HDF5 may write to its image where it mends it in memory: the pages are this process's own.
  void* const image = size > 0 ? ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE, kInput, 0) : MAP_FAILED;
  if (image == MAP_FAILED) {
    return kMisuse;
  }
  const auto budget_bytes = static_cast<std::size_t>(*budget);
  VariableWriter writer(STDOUT_FILENO);
  // Values as the library gives them, the table that is made of them, and that table upright.
  if (!decode::enter_sandbox(kOwnNeed + 2 * size + 4 * budget_bytes)) {
    return 1;
  }
  try {
    const auto done = decode::write_hdf5_variables({static_cast<const std::byte*>(image), size}, budget_bytes, writer);
    return (done ? writer.end() : writer.error(done.error())) ? 0 : 1;
  } catch (const std::bad_alloc&) {
    return 1;
  }
}
