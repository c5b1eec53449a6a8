#pragma once
/// Recordings of a use case from files that a test writes.
#include "core/analysis/recording_source.hpp"
#include "core/read/format.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace driftlab {

class FileSource final : public RecordingSource {
 public:
  FileSource() {
    std::string pattern = (std::filesystem::temp_directory_path() / "driftlab-test-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
  }
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;
  ~FileSource() override { std::filesystem::remove_all(folder_); }

  /// A file of these bytes under what its user says about it.
  void add(const RecordingSpec& spec, const std::string& bytes, const std::string& device = "imu-07") {
    specs_.push_back(spec);
    devices_.push_back(device);
    std::ofstream(path(specs_.size() - 1), std::ios::binary) << bytes;
  }

  [[nodiscard]] std::size_t count() const override { return specs_.size(); }
  [[nodiscard]] Result<SourceRecording> open(std::size_t index, const RunControl& control) override {
    auto decoded = decode_file(path(index), folder_ / "columns", {}, control);
    auto columns = decoded ? ColumnFile::open(folder_ / "columns") : Result<ColumnFile>(fail(decoded.error()));
    if (!columns) {
      return fail(columns.error());
    }
    return SourceRecording{specs_[index], std::move(*columns), std::move(decoded->notes), {}, devices_[index]};
  }
  [[nodiscard]] Result<Calibration> calibration(std::size_t /*index*/) override { return Calibration{}; }
  [[nodiscard]] Error located(std::size_t index, Error error) const override {
    return std::move(error).with("file", std::to_string(index));
  }

 private:
  [[nodiscard]] std::filesystem::path path(std::size_t index) const { return folder_ / std::to_string(index); }

  std::filesystem::path folder_;
  std::vector<RecordingSpec> specs_;
  std::vector<std::string> devices_;
};

}  // namespace driftlab
