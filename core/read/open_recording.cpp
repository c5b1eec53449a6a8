#include "core/read/open_recording.hpp"

#include <utility>

namespace driftlab {

Result<OpenRecording> open_recording(const std::filesystem::path& columns, const RecordingSpec& spec, ViewUse use) {
  auto file = ColumnFile::open(columns);
  if (!file) {
    return fail(std::move(file.error()));
  }
  Passed passed;
  if (use == ViewUse::Survey) {
    passed = [&](std::span<const double> samples) { file->release(samples); };
  }
  auto view =
      view_recording(spec, file->names(), file->rows(), [&](std::size_t i) { return file->column(i); }, use, passed);
  if (!view) {
    return fail(std::move(view.error()));
  }
  return OpenRecording{std::move(*file), std::move(*view)};
}

}  // namespace driftlab
