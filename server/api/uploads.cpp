// Resumable uploads by tus 1.0.0 (tus.io: core, creation, expiration, termination, checksum), and how a complete one
// becomes a recording.
#include "core/signal/text.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/record_blob.hpp"
#include "server/api/upload.hpp"
#include "server/http/problem.hpp"
#include "server/store/base64.hpp"
#include "server/store/resumable_uploads.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>

namespace driftlab::server {
namespace {

constexpr std::string_view kVersion = "1.0.0";
constexpr std::size_t kCopied = 1024UL * 1024;

std::optional<std::uint64_t> whole_number(std::optional<std::string_view> text) {
  std::uint64_t value = 0;
  if (!text || text->empty()) {
    return std::nullopt;
  }
  const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), value);
  return error == std::errc{} && stop == text->data() + text->size() ? std::optional(value) : std::nullopt;
}

Response with_version(Response response) {
  response.headers.emplace_back("Tus-Resumable", kVersion);
  return response;
}

/// Another version of the protocol is refused before anything else (tus 1.0, Tus-Resumable).
std::optional<Response> refuse_version(const Request& request) {
  if (request.header("tus-resumable") == kVersion) {
    return std::nullopt;
  }
  Response response = problem_response(HttpFault::PreconditionFailed,
                                       "Send the header Tus-Resumable: 1.0.0, the version of tus that is spoken here.");
  response.headers.emplace_back("Tus-Version", kVersion);
  return with_version(std::move(response));
}

/// The file name in Upload-Metadata, `filename <base64>,…`; empty where there is none.
std::string file_name_in(std::string_view metadata) {
  while (!metadata.empty()) {
    const std::string_view pair = trimmed(metadata.substr(0, metadata.find(',')));
    if (const std::size_t space = pair.find(' ');
        space != std::string_view::npos && pair.substr(0, space) == "filename") {
      return shown_file_name(from_base64(std::string(pair.substr(space + 1))).value_or(""));
    }
    const std::size_t comma = metadata.find(',');
    metadata.remove_prefix(comma == std::string_view::npos ? metadata.size() : comma + 1);
  }
  return "";
}

Json to_json(const ResumableUpload& upload) {
  return Json{{"id", upload.id},
              {"length", upload.length},
              {"offset", upload.offset},
              {"file_name", upload.file_name.empty() ? Json(nullptr) : Json(upload.file_name)},
              {"expires_at", rfc3339(upload.expires_at)}};
}

void add_headers(Response& response, const ResumableUpload& upload) {
  response.headers.emplace_back("Upload-Offset", std::to_string(upload.offset));
  response.headers.emplace_back("Upload-Length", std::to_string(upload.length));
  response.headers.emplace_back("Upload-Expires", rfc3339(upload.expires_at));
  response.headers.emplace_back("Cache-Control", "no-store");
}

Result<Response> create(ApiContext& context, ResumableUploads& uploads, const Request& request) {
  if (auto refusal = refuse_version(request)) {
    return std::move(*refusal);
  }
  const auto length = whole_number(request.header("upload-length"));
  if (!length || *length == 0) {
    return fail(ErrorCode::InvalidArgument, "Say how many bytes will come in Upload-Length, at least 1.",
                {{"parameter", "Upload-Length"}});
  }
  const Budgets& budgets = context.budgets;
  if (*length > static_cast<std::uint64_t>(budgets.upload_bytes)) {
    return problem_response(HttpFault::BodyTooLarge, "An upload may not be that large " +
                                                         naming_budget("upload_bytes", budgets.upload_bytes) + ".");
  }
  uploads.forget_expired();
  if (auto within = require_quota_of_token(context, "", *length); !within) {
    return fail(within.error());
  }
  const auto upload = uploads.create(*length, file_name_in(request.header("upload-metadata").value_or("")));
  if (!upload) {
    return fail(upload.error());
  }
  Response response = json_response(201, to_json(*upload));
  response.headers.emplace_back("Location", "/v1/uploads/" + upload->id);
  add_headers(response, *upload);
  return with_version(std::move(response));
}

Result<Response> get(ResumableUploads& uploads, const Request& request) {
  const auto upload = uploads.find(request.parameters[0]);
  if (!upload) {
    return fail(upload.error());
  }
  Response response = json_response(200, to_json(*upload));
  add_headers(response, *upload);
  return with_version(std::move(response));
}

Result<Response> terminate(ResumableUploads& uploads, const Request& request) {
  if (auto refusal = refuse_version(request)) {
    return std::move(*refusal);
  }
  if (auto removed = uploads.remove(request.parameters[0]); !removed) {
    return fail(removed.error());
  }
  Response response;
  response.status = 204;
  return with_version(std::move(response));
}

/// `sha256 <base64>` or `sha1 <base64>` of Upload-Checksum, computed while the piece streams in.
class Checksum {
 public:
  static Result<std::unique_ptr<Checksum>> stated(std::string_view header) {
    const std::size_t space = header.find(' ');
    const std::string_view name = header.substr(0, space);
    const EVP_MD* const method = name == "sha256" ? EVP_sha256() : name == "sha1" ? EVP_sha1() : nullptr;
    const auto expected =
        space == std::string_view::npos ? std::nullopt : from_base64(std::string(trimmed(header.substr(space))));
    if (method == nullptr || !expected) {
      return fail(ErrorCode::InvalidArgument, "Upload-Checksum is sha256 or sha1, a space and the digest in base64.",
                  {{"parameter", "Upload-Checksum"}});
    }
    return std::make_unique<Checksum>(method, *expected);
  }
  Checksum(const EVP_MD* method, std::string expected)
      : context_(EVP_MD_CTX_new(), &EVP_MD_CTX_free), expected_(std::move(expected)) {
    EVP_DigestInit_ex(context_.get(), method, nullptr);
  }
  void update(std::span<const std::byte> bytes) { EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()); }
  [[nodiscard]] bool holds() {
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
    unsigned int length = 0;
    EVP_DigestFinal_ex(context_.get(), digest.data(), &length);
    return expected_ == std::string_view(reinterpret_cast<const char*>(digest.data()), length);
  }

 private:
  std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context_;
  std::string expected_;
};

class PieceUpload final : public UploadSession {
 public:
  PieceUpload(ResumableUploads& uploads, std::string id, std::unique_ptr<ResumableUploads::Piece> piece,
              std::unique_ptr<Checksum> checksum, std::uint64_t room)
      : uploads_(uploads), id_(std::move(id)), piece_(std::move(piece)), checksum_(std::move(checksum)), room_(room) {
    if (checksum_) {
      piece_->whole();
    }
  }

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    if (bytes.size() > room_) {
      return fail(ErrorCode::InvalidArgument, "This piece goes beyond the length that the upload was said to have.",
                  {{"parameter", "Upload-Length"}});
    }
    room_ -= bytes.size();
    if (checksum_) {
      checksum_->update(bytes);
    }
    return piece_->append(bytes);
  }

  [[nodiscard]] Result<Response> finish() override {
    if (checksum_ && !checksum_->holds()) {
      piece_.reset();
      return with_version(problem_response(HttpFault::ChecksumMismatch,
                                           "The piece does not have the stated checksum; it was taken back."));
    }
    const auto offset = piece_->finish();
    if (!offset) {
      return fail(offset.error());
    }
    piece_.reset();
    const auto upload = uploads_.find(id_);
    if (!upload) {
      return fail(upload.error());
    }
    Response response;
    response.status = 204;
    add_headers(response, *upload);
    return with_version(std::move(response));
  }

 private:
  ResumableUploads& uploads_;
  std::string id_;
  std::unique_ptr<ResumableUploads::Piece> piece_;
  std::unique_ptr<Checksum> checksum_;
  std::uint64_t room_;  ///< a chunked piece does not say beforehand how long it is
};

/// Adds bytes to an upload. What is wrong with a piece is said before its first byte is read.
Result<std::unique_ptr<UploadSession>> begin_piece(ApiContext& context, ResumableUploads& uploads,
                                                   const Request& request) {
  const auto offset = whole_number(request.header("upload-offset"));
  if (!offset) {
    return fail(ErrorCode::InvalidArgument, "Say where the bytes go in Upload-Offset.",
                {{"parameter", "Upload-Offset"}});
  }
  const auto upload = uploads.find(request.parameters[0]);
  if (!upload) {
    return fail(upload.error());
  }
  const std::uint64_t more = whole_number(request.header("content-length")).value_or(0);
  if (*offset <= upload->length && more > upload->length - *offset) {
    return fail(ErrorCode::InvalidArgument,
                "The upload has " + std::to_string(upload->length) + " bytes; this piece would go beyond.",
                {{"parameter", "Content-Length"}});
  }
  if (auto room = require_space(context); !room) {
    return fail(room.error());
  }
  std::unique_ptr<Checksum> checksum;
  if (const auto stated = request.header("upload-checksum")) {
    auto made = Checksum::stated(*stated);
    if (!made) {
      return fail(made.error());
    }
    checksum = std::move(*made);
  }
  auto piece = uploads.append(upload->id, *offset);
  if (!piece) {
    return fail(piece.error());
  }
  return std::make_unique<PieceUpload>(uploads, upload->id, std::move(*piece), std::move(checksum),
                                       upload->length - *offset);
}

Result<std::unique_ptr<UploadSession>> patch(ApiContext& context, ResumableUploads& uploads, const Request& request) {
  if (auto refusal = refuse_version(request)) {
    return std::make_unique<RefusedUpload>(std::move(*refusal));
  }
  if (trimmed(request.header("content-type").value_or("")) != "application/offset+octet-stream") {
    return std::make_unique<RefusedUpload>(
        problem_response(HttpFault::UnsupportedMediaType, "The type of a piece is application/offset+octet-stream."));
  }
  return begin_piece(context, uploads, request);
}

Status copy_into(IncomingBlob& blob, const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> buffer(kCopied);
  while (file) {
    file.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    if (auto added = blob.append(std::as_bytes(std::span(buffer).first(static_cast<std::size_t>(file.gcount()))));
        !added) {
      return added;
    }
  }
  if (!file.eof()) {
    return fail(ErrorCode::Io, "The upload cannot be read from the disk.");
  }
  return blob.seal();
}

/// A complete upload becomes a recording. Refused metadata leave it as it is, to be tried again with others.
Result<Response> record(ApiContext& context, ResumableUploads& uploads, const Request& request) {
  const auto upload = uploads.find(request.parameters[0]);
  if (!upload) {
    return fail(upload.error());
  }
  if (upload->offset != upload->length) {
    return fail(ErrorCode::Conflict,
                "The upload has " + std::to_string(upload->offset) + " of its " + std::to_string(upload->length) +
                    " bytes; send the rest first.",
                {{"offset", std::to_string(upload->offset)}});
  }
  auto metadata = metadata_from_query(request);
  if (!metadata) {
    return fail(metadata.error());
  }
  if (metadata->file_name.empty()) {
    metadata->file_name = upload->file_name;
  }
  if (auto resolved = resolve_device_name(context.store, metadata->device); !resolved) {
    return fail(resolved.error());
  }
  auto blob = context.blobs.begin();
  if (!blob) {
    return fail(blob.error());
  }
  if (auto copied = copy_into(**blob, uploads.bytes_path(upload->id)); !copied) {
    return fail(copied.error());
  }
  auto response = record_blob(context, **blob, *metadata, upload->id);
  if (response) {
    (void)uploads.remove(upload->id);
  }
  return response;
}

}  // namespace

void add_upload_routes(Router& router, ApiContext& context) {
  static const SystemClock machine;  // dates the files of its directory
  const auto uploads = std::make_shared<ResumableUploads>(context.data / "uploads", machine);
  context.uploads = uploads;
  router.add({"POST", "/v1/uploads", "createUpload", {}, Handler([&context, uploads](const Request& request) {
                return create(context, *uploads, request);
              })});
  router.add({"GET", "/v1/uploads/{id}", "getUpload", {}, Handler([uploads](const Request& request) {
                return get(*uploads, request);
              })});
  router.add(
      {"PATCH", "/v1/uploads/{id}", "appendToUpload", {}, UploadHandler([&context, uploads](const Request& request) {
         return patch(context, *uploads, request);
       })});
  router.add({"DELETE", "/v1/uploads/{id}", "deleteUpload", {}, Handler([uploads](const Request& request) {
                return terminate(*uploads, request);
              })});
  router.add(in_lane(Lane::Decoding, {"POST", "/v1/uploads/{id}/recording", "recordUpload", metadata_parameters(),
                                      Handler([&context, uploads](const Request& request) {
                                        return record(context, *uploads, request);
                                      })}));
}

}  // namespace driftlab::server
