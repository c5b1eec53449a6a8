#pragma once
/// Files of this machine as recordings of a daemon.
#include "clients/cli/input.hpp"
#include "clients/cli/remote_job.hpp"
#include "schema/json/recording_tags.hpp"

#include <filesystem>
#include <functional>
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

}  // namespace driftlab::cli
