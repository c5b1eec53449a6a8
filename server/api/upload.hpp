#pragma once
/// POST /v1/recordings: bytes stream to disk while they are hashed; then they are recognised, decoded once, checked
/// against their metadata and recorded. Whatever goes wrong before the row is written leaves nothing behind.
#include "server/api/api.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

namespace driftlab::server {

/// Checks everything that is known before the body (query, headers, disk space) and starts an upload.
[[nodiscard]] Result<std::unique_ptr<UploadSession>> begin_upload(ApiContext& context, const Request& request);

/// An upload that is answered as it is: what comes is not looked at, and beyond `most` bytes not awaited either.
class RefusedUpload final : public UploadSession {
 public:
  explicit RefusedUpload(Response refusal, std::uint64_t most = std::numeric_limits<std::uint64_t>::max())
      : refusal_(std::move(refusal)), left_(most) {}
  [[nodiscard]] Status append(std::span<const std::byte> bytes) override {
    if (bytes.size() > left_) {
      return fail(ErrorCode::LimitExceeded, "This upload is refused, and longer than it may be.");
    }
    left_ -= bytes.size();
    return {};
  }
  [[nodiscard]] Result<Response> finish() override { return std::move(refusal_); }

 private:
  Response refusal_;
  std::uint64_t left_;
};

}  // namespace driftlab::server
