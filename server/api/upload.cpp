#include "server/api/upload.hpp"

#include "core/read/format.hpp"
#include "core/read/open_recording.hpp"
#include "core/signal/text.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/upload_metadata.hpp"
#include "server/http/guard.hpp"
#include "server/http/multipart.hpp"
#include "server/http/problem.hpp"
#include "server/jobs/recording_calibration.hpp"
#include "server/store/crash_point.hpp"
#include "server/store/digest.hpp"

#include <openssl/evp.h>

#include <array>

namespace driftlab::server {
namespace {

constexpr std::size_t kLongestMetadata = 1024UL * 1024;
/// Uploads need this much room beyond nothing at all, so that the database can still write.
constexpr std::uintmax_t kLeastFreeBytes = 64ULL * 1024 * 1024;

/// `sha-256=:<base64>:` of Repr-Digest (RFC 9530) as lower-case hex; nothing where the header has no SHA-256.
std::optional<std::string> stated_digest(std::string_view header) {
  const std::size_t start = header.find("sha-256=:");
  if (start == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view rest = header.substr(start + 9);
  const std::string encoded(rest.substr(0, rest.find(':')));
  std::array<unsigned char, 64> bytes{};
  if (encoded.size() != 44 ||
      EVP_DecodeBlock(bytes.data(), reinterpret_cast<const unsigned char*>(encoded.data()), 44) != 33) {
    return "malformed";
  }
  std::string hex;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (std::size_t i = 0; i < 32; ++i) {
    hex += kDigits[bytes[i] >> 4U];
    hex += kDigits[bytes[i] & 15U];
  }
  return hex;
}

class RecordingUpload final : public UploadSession {
 public:
  RecordingUpload(ApiContext& context, Request request, std::unique_ptr<IncomingBlob> blob)
      : context_(context), request_(std::move(request)), blob_(std::move(blob)) {}

  void expect_multipart(std::string_view boundary) {
    multipart_.emplace(
        boundary, MultipartReader::Callbacks{[this](const std::string& name) { return begin_part(name); },
                                             [this](std::span<const std::byte> bytes) { return part_data(bytes); }});
  }
  void set_metadata(UploadMetadata metadata) { metadata_ = std::move(metadata); }

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    return multipart_ ? multipart_->feed(bytes) : blob_->append(bytes);
  }

  [[nodiscard]] Result<Response> finish() override {
    if (auto complete = finish_parts(); !complete) {
      return fail(complete.error());
    }
    if (auto sealed = blob_->seal(); !sealed) {
      return fail(sealed.error());
    }
    if (blob_->size() == 0) {
      return fail(ErrorCode::EmptyInput, "The upload is empty; with curl, write @ before the file name.");
    }
    if (const auto header = request_.header("repr-digest")) {
      if (const auto digest = stated_digest(*header); digest && *digest != blob_->sha256()) {
        return problem_response(HttpFault::DigestMismatch,
                                "The bytes received have the SHA-256 " + blob_->sha256() + ", not the one stated.");
      }
    }
    const auto key = request_.header("idempotency-key");
    if (!key) {
      return record();
    }
    return record_once(std::string(*key));
  }

 private:
  Status begin_part(const std::string& name) {
    if (name != "metadata" && name != "file") {
      return fail(ErrorCode::InvalidArgument,
                  "The parts of an upload are metadata and file; '" + name + "' is neither.", {{"part", name}});
    }
    bool& seen = name == "file" ? file_seen_ : metadata_seen_;
    if (seen) {
      return fail(ErrorCode::InvalidArgument, "The part '" + name + "' comes twice.", {{"part", name}});
    }
    seen = true;
    in_file_ = name == "file";
    return {};
  }

  Status part_data(std::span<const std::byte> bytes) {
    if (in_file_) {
      return blob_->append(bytes);
    }
    metadata_text_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (metadata_text_.size() > kLongestMetadata) {
      return fail(ErrorCode::LimitExceeded, "The metadata are longer than 1 MiB.", {{"part", "metadata"}});
    }
    return {};
  }

  Status finish_parts() {
    if (!multipart_) {
      return {};
    }
    if (auto closed = multipart_->finish(); !closed) {
      return closed;
    }
    for (const auto& [seen, name] : {std::pair{file_seen_, "file"}, std::pair{metadata_seen_, "metadata"}}) {
      if (!seen) {
        return fail(ErrorCode::InvalidArgument, std::string("The part '") + name + "' is missing.", {{"part", name}});
      }
    }
    auto metadata = metadata_from_json(metadata_text_, request_);
    if (!metadata) {
      return fail(metadata.error());
    }
    metadata_ = std::move(*metadata);
    return resolve_device_name(context_.store, metadata_.device);
  }

  Result<Response> record_once(const std::string& key) {
    auto known = context_.store.idempotent_reply(key);
    if (!known) {
      return fail(known.error());
    }
    // Metadata sent as a part are as much of the body as the file is.
    const std::string digest = sha256_hex(blob_->sha256() + metadata_text_);
    if (const std::optional<IdempotentReply>& reply = *known) {
      return replay(*reply, request_, digest);
    }
    auto response = record();
    if (response && response->status < 300) {
      auto remembered =
          context_.store.remember_reply(reply_to_remember(key, request_, digest, *response, context_.clock.now()));
      if (!remembered) {
        return fail(remembered.error());
      }
    }
    return response;
  }

  /// The blob row of these bytes: known already, or decoded now.
  Result<Blob> decode() {
    auto known = context_.store.blob(blob_->sha256());
    if (!known) {
      return fail(known.error());
    }
    const std::optional<Blob>& blob = *known;
    if (blob && ColumnFile::open(context_.blobs.columns_path(blob_->sha256()))) {
      columns_ = context_.blobs.columns_path(blob_->sha256());
      return *blob;
    }
    auto decoded = decode_file(blob_->path(), blob_->columns_path());
    if (!decoded) {
      return fail(decoded.error());
    }
    columns_ = blob_->columns_path();
    Blob row;
    row.sha256 = blob_->sha256();
    row.bytes = static_cast<std::int64_t>(blob_->size());
    row.format = decoded->format;
    row.compression = driftlab::name_of(decoded->compression);
    row.rows = static_cast<std::int64_t>(decoded->rows);
    row.columns_json = to_text(Json(decoded->names));
    row.notes_json = to_text(Json(decoded->notes));
    row.created_at = context_.clock.now();
    return row;
  }

  Result<Response> record() {
    auto blob = decode();
    if (!blob) {
      return fail(blob.error());
    }
    crash_point("upload.decoded");
    auto quality = check_against_columns();
    if (!quality) {
      return fail(quality.error());
    }
    if (auto kept = blob_->keep(); !kept) {
      return fail(kept.error());
    }
    auto device = context_.store.ensure_device(metadata_.device);
    if (!device) {
      return fail(device.error());
    }
    Recording recording;
    recording.device_id = device->device.id;
    recording.blob_sha256 = blob->sha256;
    recording.metadata_json = canonical_text(driftlab::to_json(metadata_.spec));
    recording.condition = driftlab::to_text(metadata_.spec.condition);
    recording.quality_json = *quality;
    auto outcome = context_.store.add_recording(*blob, recording);
    if (!outcome) {
      return fail(naming_patch(outcome.error()));
    }
    crash_point("upload.recorded");
    if (outcome->created) {
      context_.events.add("recordings", "recording.created",
                          Json{{"recording", outcome->recording.id}, {"device", outcome->recording.device_id}});
    }
    Response response = json_response(outcome->created ? 201 : 200, to_json(outcome->recording, &*blob));
    response.headers.emplace_back("Location", "/v1/recordings/" + outcome->recording.id);
    response.headers.emplace_back("ETag", etag_of(outcome->recording.id, outcome->recording.revision));
    return response;
  }

  /// A conflict with a recording that is there says by which request that one is changed.
  static Error naming_patch(Error error) {
    for (const ErrorField& field : error.fields) {
      if (error.code == ErrorCode::Conflict && field.name == "recording_id") {
        error.message =
            "The device has these bytes already with other metadata; change those with PATCH /v1/recordings/" +
            field.value + ".";
        break;
      }
    }
    return error;
  }

  /// Metadata and samples must fit together before anything is kept. The recording's quality as JSON text.
  Result<std::string> check_against_columns() {
    const bool calibrated = !metadata_.spec.calibration.empty();
    auto opened = open_recording(columns_, metadata_.spec, calibrated ? ViewUse::Analysis : ViewUse::Survey);
    if (!opened) {
      return fail(opened.error());
    }
    std::string quality = to_text(driftlab::to_json(opened->view.window.quality));
    if (!calibrated) {
      return quality;
    }
    const auto device = context_.store.device(metadata_.device.name);
    auto calibration = calibration_of(context_.store, metadata_.spec, device ? device->id : "");
    if (!calibration) {
      return fail(calibration.error());
    }
    if (auto applied = apply_calibration(*calibration, opened->view); !applied) {
      return fail(applied.error());
    }
    return quality;
  }

  ApiContext& context_;
  Request request_;
  std::unique_ptr<IncomingBlob> blob_;
  std::optional<MultipartReader> multipart_;
  std::filesystem::path columns_;
  UploadMetadata metadata_;
  std::string metadata_text_;
  bool in_file_ = false;
  bool file_seen_ = false;
  bool metadata_seen_ = false;
};

}  // namespace

Result<std::unique_ptr<UploadSession>> begin_upload(ApiContext& context, const Request& request) {
  const auto type = request.header("content-type");
  const auto boundary = type ? multipart_boundary(*type) : std::nullopt;
  if (const auto key = request.header("idempotency-key"); key && !is_request_id(*key)) {
    return fail(malformed_idempotency_key());
  }
  if (type && !boundary && trimmed(*type).starts_with("multipart/")) {
    return fail(ErrorCode::ParseError, "A multipart upload is multipart/form-data with a boundary.",
                {{"parameter", "Content-Type"}});
  }
  UploadMetadata metadata;
  if (!boundary) {
    auto read = metadata_from_query(request);
    if (!read) {
      return fail(read.error());
    }
    metadata = std::move(*read);
    if (auto resolved = resolve_device_name(context.store, metadata.device); !resolved) {
      return fail(resolved.error());
    }
  }
  if (const auto space = context.blobs.space(); space && space->free_bytes < kLeastFreeBytes) {
    return fail(ErrorCode::DiskFull, "Less than 64 MiB are free where the daemon keeps its data.");
  }
  auto blob = context.blobs.begin();
  if (!blob) {
    return fail(blob.error());
  }
  auto upload = std::make_unique<RecordingUpload>(context, request, std::move(*blob));
  if (boundary) {
    upload->expect_multipart(*boundary);
  } else {
    upload->set_metadata(std::move(metadata));
  }
  return upload;
}

}  // namespace driftlab::server
