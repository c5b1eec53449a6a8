#include "server/api/upload.hpp"

#include "core/signal/text.hpp"
#include "server/api/device_name.hpp"
#include "server/api/documents.hpp"
#include "server/api/record_blob.hpp"
#include "server/http/guard.hpp"
#include "server/http/multipart.hpp"
#include "server/http/problem.hpp"
#include "server/store/base64.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

/// `sha-256=:<base64>:` of Repr-Digest (RFC 9530) as lower-case hex; nothing where the header has no SHA-256.
std::optional<std::string> stated_digest(std::string_view header) {
  const std::size_t start = header.find("sha-256=:");
  if (start == std::string_view::npos) {
    return std::nullopt;
  }
  const std::string_view rest = header.substr(start + 9);
  const auto bytes = from_base64(std::string(rest.substr(0, rest.find(':'))));
  if (!bytes || bytes->size() != 32) {
    return "malformed";
  }
  std::string hex;
  constexpr std::string_view kDigits = "0123456789abcdef";
  for (const char byte : *bytes) {
    hex += kDigits[static_cast<unsigned char>(byte) >> 4U];
    hex += kDigits[static_cast<unsigned char>(byte) & 15U];
  }
  return hex;
}

class RecordingUpload final : public UploadSession {
 public:
  RecordingUpload(ApiContext& context, Request request, std::unique_ptr<IncomingBlob> blob)
      : context_(context), request_(std::move(request)), blob_(std::move(blob)) {}

  void expect_multipart(std::string_view boundary) {
    multipart_.emplace(boundary,
                       MultipartReader::Callbacks{
                           [this](const std::string& name, const std::string& file) { return begin_part(name, file); },
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
    return record_once(own_key(request_, *key));
  }

 private:
  Status begin_part(const std::string& name, const std::string& file_name) {
    const auto fields = metadata_parameters();
    const bool is_field = std::find(fields.begin(), fields.end(), name) != fields.end();
    if (name != "metadata" && name != "file" && !is_field) {
      return fail(ErrorCode::InvalidArgument,
                  "The parts of an upload are file and metadata, or file and the parameters of the query; '" + name +
                      "' is none of them.",
                  {{"part", name}});
    }
    const bool again = name == "file"       ? file_seen_
                       : name == "metadata" ? metadata_seen_
                                            : request_.parameter(name) != std::nullopt;
    if (again) {
      return fail(ErrorCode::InvalidArgument, "The part '" + name + "' comes twice, or stands in the query too.",
                  {{"part", name}});
    }
    file_seen_ = file_seen_ || name == "file";
    metadata_seen_ = metadata_seen_ || name == "metadata";
    in_file_ = name == "file";
    sent_name_ = in_file_ ? file_name : sent_name_;
    in_field_ = is_field;
    if (is_field) {
      request_.query.emplace_back(name, "");
    }
    return {};
  }

  Status part_data(std::span<const std::byte> bytes) {
    if (in_file_) {
      return blob_->append(bytes);
    }
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (in_field_) {
      request_.query.back().second += text;
    } else {
      metadata_text_ += text;
    }
    described_bytes_ += bytes.size();
    if (described_bytes_ > static_cast<std::size_t>(context_.budgets.document_bytes)) {
      return fail(ErrorCode::LimitExceeded,
                  "The metadata are too long " + naming_budget("document_bytes", context_.budgets.document_bytes) + ".",
                  {{"part", in_field_ ? request_.query.back().first : "metadata"}});
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
    if (!file_seen_) {
      return fail(ErrorCode::InvalidArgument, "The part 'file' is missing.", {{"part", "file"}});
    }
    for (const auto& [name, value] : request_.query) {
      if (metadata_seen_ && name != "device") {
        return fail(ErrorCode::InvalidArgument,
                    "Beside a metadata part the query names the device at most; write '" + name + "' into the part.",
                    {{"parameter", name}});
      }
    }
    auto metadata = metadata_seen_ ? metadata_from_json(metadata_text_, request_) : metadata_from_query(request_);
    if (!metadata) {
      return fail(metadata.error());
    }
    metadata_ = std::move(*metadata);
    if (metadata_.file_name.empty()) {
      metadata_.file_name = shown_file_name(sent_name_);
    }
    return resolve_device_name(context_.store, metadata_.device);
  }

  Result<Response> record_once(const std::string& key) {
    // From here to the reply that is remembered: of equal uploads at once one is recorded.
    const auto flight = context_.keys_in_flight.take(key);
    if (!flight) {
      return fail(flight.error());
    }
    if (*flight == nullptr) {
      return problem_response(HttpFault::IdempotencyInFlight, "A request with this Idempotency-Key is running.");
    }
    auto known = context_.store.idempotent_reply(key);
    if (!known) {
      return fail(known.error());
    }
    // Metadata sent as a part are as much of the body as the file is.
    const std::string digest = sha256_hex(blob_->sha256() + metadata_text_ + fields_text());
    if (const std::optional<IdempotentReply>& reply = *known) {
      return replay_whole(context_, *reply, request_, digest);
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

  /// The form's fields, which became part of the query; empty without any, as in a request whose query says it all.
  [[nodiscard]] std::string fields_text() const {
    std::string text;
    for (std::size_t i = stated_in_query_; i < request_.query.size(); ++i) {
      text += '\n' + request_.query[i].first + '=' + request_.query[i].second;
    }
    return text;
  }

  Result<Response> record() { return record_blob(context_, *blob_, metadata_); }

  ApiContext& context_;
  Request request_;
  std::unique_ptr<IncomingBlob> blob_;
  std::optional<MultipartReader> multipart_;
  UploadMetadata metadata_;
  std::string metadata_text_;
  std::string sent_name_;  ///< of the file, as its part calls it
  std::size_t stated_in_query_ = request_.query.size();
  std::size_t described_bytes_ = 0;
  bool in_file_ = false;
  bool in_field_ = false;
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
  if (auto room = require_space(context); !room) {
    return fail(room.error());
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
