#pragma once
/// Recordings from files on this machine (core/analysis/recording_source.hpp), each decoded into a temporary column
/// file.
#include "clients/cli/input.hpp"
#include "clients/cli/workspace.hpp"
#include "core/analysis/recording_source.hpp"

#include <functional>
#include <memory>

namespace driftlab::cli {

/// Says of a recording's columns whether they can be used, before they are.
using ColumnCheck = std::function<Status(const RecordingSpec& spec, const ColumnNames& names)>;

class LocalFiles final : public RecordingSource {
 public:
  /// `inputs` must outlive this object. `check` may be empty. Error: Io (no temporary directory).
  [[nodiscard]] static Result<std::unique_ptr<LocalFiles>> of(const Inputs& inputs, ColumnCheck check = {});

  [[nodiscard]] std::size_t count() const override { return inputs_.files.size(); }
  /// Errors: those of decode_file, ColumnFile::open and the check.
  [[nodiscard]] Result<SourceRecording> open(std::size_t index, const RunControl& control) override;
  [[nodiscard]] Result<Calibration> calibration(std::size_t index) override { return inputs_.files[index].calibration; }
  /// The path of the file, before the sentence.
  [[nodiscard]] Error located(std::size_t index, Error error) const override;
  [[nodiscard]] double opening_share() const override { return 0.3; }

 private:
  LocalFiles(const Inputs& inputs, ColumnCheck check, Workspace workspace)
      : inputs_(inputs), check_(std::move(check)), workspace_(std::move(workspace)) {}

  const Inputs& inputs_;
  ColumnCheck check_;
  Workspace workspace_;
};

}  // namespace driftlab::cli
