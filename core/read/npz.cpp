/// NumPy .npz: a ZIP archive of .npy arrays, one entry per name. Source: numpy.savez, NumPy manual.
#include "core/read/formats.hpp"
#include "core/read/variables.hpp"
#include "core/read/zip_entries.hpp"

namespace driftlab::formats {
namespace {

int sniff(std::string_view head) { return zip_holds(head, ".npy") ? 100 : 0; }

/// One entry as a variable; nothing, and a note, where its type is none that is read.
Status take_array(const std::string& path, ByteSource& content, const DecodeLimits& limits, std::size_t& budget,
                  const RunControl& control, ColumnSink& sink, std::vector<Variable>& variables) {
  if (!path.ends_with(".npy")) {
    sink.note("'" + path.substr(0, limits.max_name_bytes) + "' is no array and is left out.");
    return {};
  }
  MemoryTable table;
  MemorySink into(table, budget);
  const std::string name = path.substr(0, path.size() - 4);
  if (auto status = kNpy.decode(content, limits, into, control); !status) {
    const ErrorCode code = status.error().code;
    if (code == ErrorCode::UnsupportedType || code == ErrorCode::NoSamples) {
      sink.note("The array '" + name.substr(0, limits.max_name_bytes) + "' is left out: " + status.error().message);
      return {};
    }
    return status;
  }
  variables.push_back({name, std::move(table.columns)});
  return {};
}

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  std::vector<Variable> variables;
  std::size_t budget = limits.max_tables_bytes;
  auto status = for_each_zip_entry(source, limits, [&](const std::string& path, ByteSource& content) {
    return take_array(path, content, limits, budget, control, sink, variables);
  });
  return status ? deliver_variables(std::move(variables), limits, sink) : status;
}

}  // namespace

const Format kNpz{"npz", "NumPy archive of float arrays of one length", sniff, decode};

}  // namespace driftlab::formats
