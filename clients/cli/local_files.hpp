#pragma once
/// Recordings from files on this machine (core/analysis/recording_source.hpp), each decoded into a temporary column
/// file.
#include "clients/cli/input.hpp"
#include "clients/cli/workspace.hpp"
#include "core/analysis/recording_source.hpp"

namespace driftlab::cli {

class LocalFiles final : public RecordingSource {
 public:
  /// `inputs` must outlive this object. Error: Io (no temporary directory).
  [[nodiscard]] static Result<std::unique_ptr<LocalFiles>> of(const Inputs& inputs);

  [[nodiscard]] std::size_t count() const override { return inputs_.files.size(); }
  /// Errors: those of decode_file and ColumnFile::open.
  [[nodiscard]] Result<SourceRecording> open(std::size_t index, const RunControl& control) override;
  [[nodiscard]] Result<Calibration> calibration(std::size_t index) override { return inputs_.files[index].calibration; }
  /// The path of the file, before the sentence.
  [[nodiscard]] Error located(std::size_t index, Error error) const override;
  [[nodiscard]] double opening_share() const override { return 0.3; }

 private:
  LocalFiles(const Inputs& inputs, Workspace workspace) : inputs_(inputs), workspace_(std::move(workspace)) {}

  const Inputs& inputs_;
  Workspace workspace_;
};

}  // namespace driftlab::cli
