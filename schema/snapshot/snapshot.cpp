#include "schema/snapshot/snapshot.hpp"

#include "core/process/registry.hpp"

namespace driftlab {

void SnapshotWriter::put(const FittedProcess& process) {
  put(std::string(process.kind->name));
  put(process.parameters.size());
  for (const FittedParameter& parameter : process.parameters) {
    put(parameter.estimate);
    put(parameter.reason);
    put(parameter.upper_limit);
  }
}

void SnapshotReader::get(FittedProcess& process) {
  std::string name;
  get(name);
  process.kind = find_process(name);
  process.parameters.resize(length());
  sound_ = sound_ && process.kind != nullptr && process.kind->parameters.size() == process.parameters.size();
  for (std::size_t i = 0; sound_ && i < process.parameters.size(); ++i) {
    process.parameters[i].declared = &process.kind->parameters[i];
    get(process.parameters[i].estimate);
    get(process.parameters[i].reason);
    get(process.parameters[i].upper_limit);
  }
}

std::size_t SnapshotReader::length() {
  std::size_t count = 0;
  get(count);
  sound_ = sound_ && count <= left_.size();
  return sound_ ? count : 0;
}

std::string_view SnapshotReader::take(std::size_t count) {
  sound_ = sound_ && count <= left_.size();
  if (!sound_) {
    return {};
  }
  const std::string_view taken = left_.substr(0, count);
  left_.remove_prefix(count);
  return taken;
}

}  // namespace driftlab
