#include "clients/cli/local_files.hpp"

#include "core/read/format.hpp"

namespace driftlab::cli {

Result<std::unique_ptr<LocalFiles>> LocalFiles::of(const Inputs& inputs, ColumnCheck check) {
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  return std::unique_ptr<LocalFiles>(new LocalFiles(inputs, std::move(check), std::move(*workspace)));
}

Result<SourceRecording> LocalFiles::open(std::size_t index, const RunControl& control) {
  const InputFile& file = inputs_.files[index];
  auto decoded = decode_file(file.bytes(), workspace_.file(), {}, control);
  if (!decoded) {
    return fail(decoded.error());
  }
  auto columns = ColumnFile::open(workspace_.file());
  if (!columns) {
    return fail(columns.error());
  }
  if (check_) {
    if (auto checked = check_(file.spec, columns->names()); !checked) {
      return fail(std::move(checked.error()));
    }
  }
  return SourceRecording{file.spec, std::move(*columns), std::move(decoded->notes), inputs_.hardware, inputs_.device};
}

Error LocalFiles::located(std::size_t index, Error error) const {
  error.message = inputs_.files[index].path.string() + ": " + error.message;
  return error;
}

}  // namespace driftlab::cli
