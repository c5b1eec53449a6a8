// Bodies: what comes in piece by piece, of a stated length or chunked, and files on their way out.
#include "server/http/connection.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/read.hpp>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace driftlab::server {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using namespace std::chrono_literals;

bool HttpConnection::trickles() const {
  const auto elapsed = std::chrono::steady_clock::now() - body_started_;
  const double seconds = std::chrono::duration<double>(elapsed).count();
  return elapsed > std::chrono::seconds(budgets().body_stall_seconds) &&
         static_cast<double>(bytes_in_) < static_cast<double>(budgets().body_bytes_per_second) * seconds;
}

Response HttpConnection::incomplete_body() const {
  if (!framing_fault_.empty()) {
    return problem_response(HttpFault::BadRequest, framing_fault_ + " Nothing was kept.");
  }
  const char* const end = chunked_ ? "its last chunk" : "Content-Length bytes";
  return problem_response(HttpFault::IncompleteBody,
                          "The body ended, or stalled, before " + std::string(end) + " had arrived; nothing was kept.");
}

asio::awaitable<std::optional<std::size_t>> HttpConnection::read_piece(Parser& parser) {
  const Timed sent(for_client_);
  if (wants_continue_) {
    wants_continue_ = false;
    (void)co_await write_text("HTTP/1.1 100 Continue\r\n\r\n");
  }
  if (chunk_.empty() && !parser.is_done()) {
    chunk_.resize(kBodyPiece);
  }
  if (bytes_in_ == 0) {
    body_started_ = std::chrono::steady_clock::now();
  }
  if (chunked_) {
    co_return co_await read_chunk();
  }
  while (!parser.is_done()) {
    if (broken_) {
      co_return std::nullopt;
    }
    auto& body = parser.get().body();
    body.data = chunk_.data();
    body.size = chunk_.size();
    boost::system::error_code error;
    stream_.expires_after(std::chrono::seconds(budgets().body_stall_seconds));
    co_await http::async_read(stream_, buffer_, parser, into(error));
    const std::size_t count = chunk_.size() - body.size;
    bytes_in_ += count;
    if (error && error != http::error::need_buffer) {
      broken_ = true;
      co_return count > 0 ? std::optional(count) : std::nullopt;
    }
    if (trickles()) {
      co_return std::nullopt;
    }
    if (count > 0) {
      co_return count;
    }
  }
  body_unread_ = false;
  co_return 0;
}

asio::awaitable<std::optional<std::size_t>> HttpConnection::read_chunk() {
  while (chunked_ && !chunked_->done()) {
    const std::string_view arrived(static_cast<const char*>(buffer_.data().data()), buffer_.size());
    const auto step = chunked_->step(arrived.substr(0, chunk_.size()));
    if (!step) {
      framing_fault_ = step.error().message;
      co_return std::nullopt;
    }
    const std::size_t count = step->data.size();
    if (count > 0) {
      std::memcpy(chunk_.data(), step->data.data(), count);
    }
    buffer_.consume(step->taken);
    bytes_in_ += count;
    if (trickles()) {
      co_return std::nullopt;
    }
    if (count > 0) {
      co_return count;
    }
    if (step->taken == 0) {
      boost::system::error_code error;
      stream_.expires_after(std::chrono::seconds(budgets().body_stall_seconds));
      const std::size_t room = std::min(kBodyPiece, buffer_.max_size() - buffer_.size());
      const std::size_t more = co_await stream_.async_read_some(buffer_.prepare(room), into(error));
      if (error) {
        co_return std::nullopt;
      }
      buffer_.commit(more);
    }
  }
  body_unread_ = false;
  co_return 0;
}

asio::awaitable<bool> HttpConnection::send_file(const FileStretch& stretch) {
  std::vector<char> piece(static_cast<std::size_t>(std::min<std::uint64_t>(stretch.length, kBodyPiece)));
  std::ifstream file;
  std::uint64_t left = stretch.length;
  while (left > 0) {
    auto read = [&] {
      if (!file.is_open()) {
        file.open(stretch.path, std::ios::binary);
        file.seekg(static_cast<std::streamoff>(stretch.first));
      }
      file.read(piece.data(), static_cast<std::streamsize>(std::min<std::uint64_t>(left, piece.size())));
      return static_cast<std::size_t>(file.gcount());
    };
    const auto count = co_await shared_.handlers.run(read);
    if (!count) {  // every thread is busy, and more than enough wait already
      asio::steady_timer moment(stream_.get_executor(), 20ms);
      boost::system::error_code ignored;
      co_await moment.async_wait(into(ignored));
      continue;
    }
    if (*count == 0 || shared_.stopping) {
      co_return false;
    }
    const bool written = co_await write_text({piece.data(), *count});
    if (!written) {
      co_return false;
    }
    left -= *count;
  }
  co_return true;
}

}  // namespace driftlab::server
