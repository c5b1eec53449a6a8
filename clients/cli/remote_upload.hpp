#pragma once
/// Files of this machine as recordings of a daemon.
#include "clients/cli/input.hpp"
#include "clients/cli/remote_job.hpp"
#include "schema/json/recording_tags.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace driftlab::cli {

/// The id of the recording that the daemon has of the file's bytes, uploaded now or before. `file_name`: what people
/// call the file. `sent` is called with the fraction sent.
[[nodiscard]] tl::expected<Json, Failure> upload_recording(HttpClient& client, const std::string& device,
                                                           const RecordingSpec& spec, const RecordingTags& tags,
                                                           const std::filesystem::path& file,
                                                           const std::string& file_name,
                                                           const std::function<void(double)>& sent);

/// The files of inputs with the calibrations that they name stored in the daemon, under whose ids they name them.
[[nodiscard]] tl::expected<std::vector<InputFile>, Failure> with_stored_calibrations(HttpClient& client,
                                                                                     const Inputs& inputs);

/// `upload_recording` of a file from the command line, whose path a refusal names.
[[nodiscard]] tl::expected<Json, Failure> upload_file(HttpClient& client, const std::string& device,
                                                      const InputFile& file, const RecordingTags& tags,
                                                      const std::function<void(double)>& sent);

/// A recording that the daemon has of a file's bytes, and the labels under which it has it.
struct KeptRecording {
  std::string id;
  std::map<std::string, std::string> labels;
};

/// What the daemon has of the bytes, where it refused an upload for nothing but other labels than `wanted`; for every
/// other refusal the refusal itself.
[[nodiscard]] tl::expected<KeptRecording, Failure> kept_under_other_labels(
    HttpClient& client, const Failure& refusal, const std::map<std::string, std::string>& wanted);

}  // namespace driftlab::cli
