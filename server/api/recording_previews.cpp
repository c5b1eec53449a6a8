// What a file would be as a recording, from its first bytes: nothing is kept.
#include "core/signal/number.hpp"
#include "core/signal/text.hpp"
#include "schema/json/recording_preview.hpp"
#include "schema/json/recording_spec.hpp"
#include "server/api/api.hpp"
#include "server/api/documents.hpp"
#include "server/api/stored_blob.hpp"
#include "server/http/guard.hpp"
#include "server/jobs/stored_recordings.hpp"

#include <charconv>

namespace driftlab::server {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;

/// What is stated of the file; only the columns, the rate and the condition matter here.
struct Stated {
  RecordingSpec spec;
  bool condition = false;
  std::vector<std::string> hardware;
  std::optional<std::uint64_t> file_bytes;  ///< of a Content-Range
};

/// The size of the file in `bytes 0-1048575/5242880` (RFC 9110 section 14.4); nothing without the header.
Result<std::optional<std::uint64_t>> file_bytes_of(const Request& request) {
  const auto header = request.header("content-range");
  if (!header) {
    return std::optional<std::uint64_t>();
  }
  const std::string_view text = trimmed(*header);
  const std::size_t slash = text.find('/');
  std::uint64_t bytes = 0;
  if (text.starts_with("bytes 0-") && slash != std::string_view::npos) {
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + slash + 1, end, bytes);
    if (error == std::errc{} && stop == end) {
      return std::optional<std::uint64_t>(bytes);
    }
  }
  return fail(ErrorCode::InvalidArgument,
              "A preview is of the first bytes of a file: Content-Range: bytes 0-LAST/SIZE.",
              {{"parameter", "Content-Range"}});
}

Result<Stated> stated_in(ApiContext& context, const Request& request) {
  Stated stated;
  const auto bytes = file_bytes_of(request);
  if (!bytes) {
    return fail(bytes.error());
  }
  stated.file_bytes = *bytes;
  if (const auto text = request.parameter("condition"); text && !text->empty()) {
    const auto condition = parse_condition(*text);
    if (!condition) {
      return fail(Error(condition.error()).with("parameter", "condition"));
    }
    stated.spec.condition = *condition;
    stated.condition = true;
  }
  if (const auto text = request.parameter("rate_hz"); text && !text->empty()) {
    stated.spec.rate_hz = parse_double(*text);
    if (!stated.spec.rate_hz || !is_sampling_rate(*stated.spec.rate_hz)) {
      return fail(ErrorCode::InvalidArgument, "The rate is a number from 1e-6 to 1e9 Hz.", {{"parameter", "rate_hz"}});
    }
  }
  if (const auto text = request.parameter("columns"); text && !text->empty()) {
    auto columns = parse_columns(*text);
    if (!columns) {
      return fail(Error(columns.error()).with("parameter", "columns"));
    }
    stated.spec.columns = std::move(*columns);
  }
  if (const auto name = request.parameter("device"); name && !name->empty()) {
    const auto device = context.store.device(std::string(*name));
    stated.hardware = device ? hardware_of(*device) : std::vector<std::string>{std::string(*name)};
  }
  return stated;
}

class PreviewUpload final : public UploadSession {
 public:
  PreviewUpload(const Budgets& budgets, Stated stated) : budgets_(budgets), stated_(std::move(stated)) {}

  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    if (bytes_.size() + bytes.size() > kMostBytes) {
      return fail(ErrorCode::LimitExceeded, "A preview takes the first 1 MiB of a file; send no more.");
    }
    bytes_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return {};
  }

  [[nodiscard]] Result<Response> finish() override {
    PreviewRequest asked;
    asked.bytes = bytes_;
    asked.extent = stated_.file_bytes == bytes_.size() ? HeadExtent::WholeFile : HeadExtent::Beginning;
    asked.spec = stated_.spec;
    asked.condition_is_stated = stated_.condition;
    asked.hardware = stated_.hardware;
    return json_response(200, driftlab::to_json(preview_recording(asked, decode_limits(budgets_))));
  }

 private:
  const Budgets& budgets_;
  Stated stated_;
  std::string bytes_;
};

Result<std::unique_ptr<UploadSession>> begin_preview(ApiContext& context, const Request& request) {
  if (const auto key = request.header("idempotency-key"); key && !is_request_id(*key)) {
    return fail(malformed_idempotency_key());
  }
  auto stated = stated_in(context, request);
  if (!stated) {
    return fail(stated.error());
  }
  return std::make_unique<PreviewUpload>(context.budgets, std::move(*stated));
}

}  // namespace

void add_recording_preview_routes(Router& router, ApiContext& context) {
  router.add({"POST",
              "/v1/recordings/preview",
              "previewRecording",
              {"device", "condition", "rate_hz", "columns"},
              UploadHandler([&](const Request& request) { return begin_preview(context, request); })});
}

}  // namespace driftlab::server
