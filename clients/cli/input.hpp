#pragma once
/// What a user hands to a command: recording files with flags, or a study document (spec/study.md) with files beside
/// it.
#include "clients/cli/workspace.hpp"
#include "core/analysis/recording_source.hpp"
#include "core/signal/recording.hpp"
#include "schema/json/json.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace driftlab::cli {

/// Flags that describe bare files.
struct FileFlags {
  std::string rate_hz;
  std::string columns;
  std::string stream;
  std::string condition = "static";
  std::string device;
  std::string calibration;
  std::size_t skip_lines = 0;  ///< lines at the front of a text that are no table
  std::string comment;         ///< what begins a line that is no row; empty: what every text knows
};

struct InputFile {
  std::filesystem::path path;
  RecordingSpec spec;                   ///< `id` is never empty
  Calibration calibration = {};         ///< what the file that `spec.calibration` names holds
  Json calibration_document = {};       ///< the same as it was read, or null
  std::filesystem::path filtered = {};  ///< a copy without the lines that flags leave out; empty: there is none

  /// What is decoded or sent.
  [[nodiscard]] const std::filesystem::path& bytes() const { return filtered.empty() ? path : filtered; }
};

struct Inputs {
  std::string device;
  /// Texts that describe the device, most telling first: IMU, model, name.
  std::vector<std::string> hardware = {};
  Json study = nullptr;  ///< the id of the study's file, or null
  std::vector<InputFile> files;
  Json baseline;                                   ///< the study's `baseline`, or null
  std::shared_ptr<Workspace> workspace = nullptr;  ///< keeps filtered copies
};

/// The flags that describe bare recordings, those of them that are given: `--rate-hz, --columns`; empty without any.
[[nodiscard]] std::string recording_flags(const FileFlags& flags);

/// Reads the inputs named on the command line: one study.json, or any number of recordings that share the flags.
/// Errors are the user's: unreadable file, malformed study, unknown unit, ...
[[nodiscard]] Result<Inputs> read_inputs(const std::vector<std::string>& names, const FileFlags& flags);

/// One recording that is described already: without the lines that the flags leave out, and with its calibration read.
/// Errors are the user's.
[[nodiscard]] Result<Inputs> described_file(const std::filesystem::path& path, const RecordingSpec& spec,
                                            const FileFlags& flags);

}  // namespace driftlab::cli
