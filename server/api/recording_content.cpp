#include "core/signal/text.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/http/byte_range.hpp"
#include "server/http/problem.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

constexpr std::size_t kLongestStem = 100;

/// Letters, digits and `-_.` of the user's name of the recording, or its id, with the format as the ending: a name that
/// no shell, header or file system reads as anything else.
std::string file_name(const Recording& recording, const Blob& blob) {
  const Json metadata = stored(recording.metadata_json);
  std::string stem = metadata.value("id", "").substr(0, kLongestStem);
  std::replace_if(
      stem.begin(), stem.end(),
      [](char c) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        return !letter && c != '-' && c != '_' && c != '.';
      },
      '_');
  if (stem.find_first_not_of("._-") == std::string::npos || stem.front() == '.' || stem.front() == '-') {
    stem = recording.id;
  }
  const std::string compressed = blob.compression == "gzip"   ? ".gz"
                                 : blob.compression == "none" ? ""
                                                              : "." + blob.compression;
  const std::string ending = "." + blob.format + compressed;
  return stem.ends_with(ending) ? stem : stem + ending;
}

Result<Response> get_content(ApiContext& context, const Request& request) {
  auto recording = context.store.recording(request.parameters[0]);
  if (!recording) {
    return fail(recording.error());
  }
  auto blob = context.store.blob(recording->blob_sha256);
  if (!blob) {
    return fail(blob.error());
  }
  if (auto reached = context.blobs.reach(recording->blob_sha256, BlobPart::Bytes); !reached) {
    return fail(reached.error());
  }
  const std::filesystem::path path = context.blobs.bytes_path(recording->blob_sha256);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const std::optional<Blob>& kept = *blob;
  if (!kept || error || size != static_cast<std::uintmax_t>(kept->bytes)) {
    return fail(ErrorCode::Io, "The uploaded file is missing or damaged; uploading it again heals it.",
                {{"recording", recording->id}});
  }
  const std::string etag = '"' + kept->sha256 + '"';
  Response response;
  response.content_type = "application/octet-stream";
  response.headers = {{"ETag", etag},
                      {"Accept-Ranges", "bytes"},
                      {"Cache-Control", "private, max-age=31536000, immutable"},
                      {"Content-Disposition", "attachment; filename=\"" + file_name(*recording, *kept) + "\""}};
  // If-None-Match comes first (RFC 9110 section 13.2.2): what is known already is not sent in part either.
  const auto known = request.header("if-none-match");
  const bool unchanged = known && (*known == "*" || known->find(etag) != std::string_view::npos);
  const WantedBytes wanted =
      unchanged ? WantedBytes{WantedBytes::Kind::Whole, 0, size} : wanted_bytes(request, size, etag);
  if (wanted.kind == WantedBytes::Kind::None) {
    Response refusal = problem_response(HttpFault::RangeNotSatisfiable, "The file has " + std::to_string(size) +
                                                                            " bytes; the range begins behind them.");
    refusal.headers.emplace_back("Content-Range", "bytes */" + std::to_string(size));
    return refusal;
  }
  if (wanted.kind == WantedBytes::Kind::Part) {
    response.status = 206;
    response.headers.emplace_back("Content-Range", "bytes " + std::to_string(wanted.first) + "-" +
                                                       std::to_string(wanted.first + wanted.length - 1) + "/" +
                                                       std::to_string(size));
  }
  response.file = FileStretch{path, wanted.first, wanted.length};
  return response;
}

}  // namespace

void add_recording_content_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/recordings/{id}/content", "getRecordingContent", {}, Handler([&](const Request& request) {
                return get_content(context, request);
              })});
}

}  // namespace driftlab::server
