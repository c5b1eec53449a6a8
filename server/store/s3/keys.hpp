#pragma once
/// The key of an object storage, from a file or from the environment; never from a flag.
#include "core/signal/result.hpp"
#include "server/store/s3/client.hpp"

#include <filesystem>
#include <string>

namespace driftlab::server::s3 {

/// `aws_access_key_id`, `aws_secret_access_key` and perhaps `aws_session_token` of the section [default], or before any
/// section, as ~/.aws/credentials has them. Errors: NotFound, Io, ParseError; no sentence repeats the file.
[[nodiscard]] Result<Credentials> read_key_file(const std::filesystem::path& path);

/// The file's key, read again when the file changes; without a file that of AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY
/// and AWS_SESSION_TOKEN, read now. Call before threads start. Error: InvalidArgument where there is neither; those of
/// read_key_file.
[[nodiscard]] Result<Client::KeyRing> find_key(const std::filesystem::path& file);

}  // namespace driftlab::server::s3
