// Uploads: the body of one request as it streams into a session on the upload pool.
#include "server/http/connection.hpp"

#include <algorithm>

namespace driftlab::server {

namespace asio = boost::asio;

namespace {

Result<Response> finish_upload(UploadSession& session) {
  try {
    return session.finish();
  } catch (const std::bad_alloc&) {
    return problem_response(HttpFault::Busy, "There is not enough memory for this upload now.");
  } catch (const std::exception& unforeseen) {
    return fail(ErrorCode::Internal, std::string("Unforeseen: ") + unforeseen.what() + ".");
  }
}

/// Gives an upload's place back when it ends.
struct UploadPlace {
  UploadPlaces& places;
  const std::string& address;
  UploadPlace(UploadPlaces& given, const std::string& of) : places(given), address(of) {}
  UploadPlace(const UploadPlace&) = delete;
  UploadPlace& operator=(const UploadPlace&) = delete;
  ~UploadPlace() { places.leave(address); }
};

}  // namespace

std::string_view UploadPlaces::take(const std::string& address) {
  const std::lock_guard lock(mutex_);
  if (taken_ >= budgets_.uploads) {
    return "uploads";
  }
  if (!exempt_(address) && of_address_[address] >= budgets_.uploads_per_address) {
    return "uploads_per_address";
  }
  ++taken_;
  ++of_address_[address];
  return "";
}

void UploadPlaces::leave(const std::string& address) {
  const std::lock_guard lock(mutex_);
  --taken_;
  if (--of_address_[address] == 0) {
    of_address_.erase(address);
  }
}

std::size_t UploadPlaces::taken() const {
  const std::lock_guard lock(mutex_);
  return static_cast<std::size_t>(taken_);
}

std::optional<Response> HttpConnection::refuse_before_upload(const Parser& parser) const {
  const auto declared = parser.content_length();
  if (!declared) {
    return problem_response(HttpFault::LengthRequired, "An upload needs Content-Length.");
  }
  if (*declared > static_cast<std::uint64_t>(budgets().upload_bytes)) {
    return problem_response(HttpFault::BodyTooLarge, "An upload may not be that large " +
                                                         naming_budget("upload_bytes", budgets().upload_bytes) + ".");
  }
  return std::nullopt;
}

asio::awaitable<bool> HttpConnection::answer_upload(Parser& parser, const UploadHandler& handler, Request& request) {
  std::optional<Response> refusal = refuse_before_upload(parser);
  if (refusal) {
    co_return co_await refuse(request, std::move(*refusal));
  }
  if (const std::string_view full = shared_.upload_places.take(address_); !full.empty()) {
    const std::int64_t most = full == "uploads" ? budgets().uploads : budgets().uploads_per_address;
    Response busy =
        problem_response(HttpFault::Busy, "Too many uploads are running " + naming_budget(full, most) + ".");
    co_return co_await refuse(request, std::move(busy));
  }
  const UploadPlace place(shared_.upload_places, address_);
  auto begin = [&handler, &request] {
    const ActingFor acting(request.caller);
    return handler(request);
  };
  auto begun = co_await shared_.uploads.run(begin);
  auto settled = settle(std::move(begun));
  if (!settled) {
    co_return co_await refuse(request, std::move(settled.error()));
  }
  std::unique_ptr<UploadSession> session = std::move(*settled);
  while (true) {
    const auto count = co_await read_piece(parser);
    if (!count) {
      session.reset();
      Response incomplete =
          problem_response(HttpFault::IncompleteBody,
                           "The upload ended, or stalled, before Content-Length bytes had arrived; nothing was kept.");
      co_await send(request, std::move(incomplete), false);
      co_return false;
    }
    if (*count == 0) {
      break;
    }
    auto append = [this, &session, size = *count] { return session->append({chunk_.data(), size}); };
    auto appended = co_await shared_.uploads.run(append);
    auto taken = settle(std::move(appended));
    if (!taken) {
      session.reset();
      co_return co_await refuse(request, std::move(taken.error()));
    }
  }
  if (surplus_follows()) {
    session.reset();
    Response surplus = problem_response(HttpFault::BadRequest, "More bytes follow than the Content-Length of " +
                                                                   std::to_string(*parser.content_length()) +
                                                                   " declares; nothing was kept.");
    co_return co_await refuse(request, std::move(surplus));
  }
  auto finish = [&session, &request] {
    const ActingFor acting(request.caller);
    return finish_upload(*session);
  };
  auto finished = co_await shared_.decodings.run(finish);
  session.reset();
  auto answered = settle(std::move(finished));
  Response response = answered ? std::move(*answered) : std::move(answered.error());
  co_return co_await send(request, std::move(response), true);
}

bool HttpConnection::surplus_follows() {
  boost::system::error_code error;
  if (buffer_.size() == 0 && stream_.is_tls()) {
    const std::size_t waiting = std::min(stream_.decrypted(), chunk_.size());
    buffer_.commit(waiting > 0 ? stream_.read_decrypted(buffer_.prepare(waiting), error) : 0);
  } else if (buffer_.size() == 0 && stream_.socket().available(error) > 0 && !error) {
    error = stream_.socket().non_blocking(true, error);
    const std::size_t count = stream_.socket().read_some(buffer_.prepare(chunk_.size()), error);
    buffer_.commit(error ? 0 : count);
  }
  const std::string_view next(static_cast<const char*>(buffer_.data().data()), buffer_.size());
  if (next.empty()) {
    return false;
  }
  // A pipelined request begins with an upper-case method, a space and a slash.
  const std::size_t end = std::min(next.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"), next.size());
  const std::string_view rest = next.substr(end);
  const bool may_be_request = end > 0 && (rest.empty() || rest == " " || rest.starts_with(" /"));
  return !may_be_request;
}

}  // namespace driftlab::server
