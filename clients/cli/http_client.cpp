#include "clients/cli/http_client.hpp"

#include "clients/cli/link.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/url/parse.hpp>
#include <boost/url/url_view.hpp>

#include <algorithm>
#include <fstream>

namespace driftlab::cli {

namespace asio = boost::asio;
namespace http = boost::beast::http;

namespace {

/// How long one answer may be waited for.
constexpr int kPatienceS = 20;

std::string& token_of_process() {
  static std::string token;
  return token;
}

std::string& ca_file_of_process() {
  static std::string file;
  return file;
}

/// One connection for one exchange.
class Exchange {
 public:
  Exchange(const std::string& host, const std::string& port, bool secure)
      : link_(io_, secure, ca_file_of_process()), host_(host), port_(port), secure_(secure) {}

  Status connect() { return link_.connect(host_, port_); }

  [[nodiscard]] tl::unexpected<Error> lost(const boost::system::error_code& error) const {
    return fail(ErrorCode::Io, std::string("The daemon at http") + (secure_ ? "s" : "") + "://" + host_ + ":" + port_ +
                                   " cannot be reached: " + error.message() + ".");
  }

  template <class Body>
  void prepare(http::request<Body>& request) const {
    request.version(11);
    request.set(http::field::host, host_ + ":" + port_);
    request.set(http::field::user_agent, "driftlab/" DRIFTLAB_VERSION);
    request.keep_alive(false);
    if (!token_of_process().empty()) {
      request.set(http::field::authorization, "Bearer " + token_of_process());
    }
  }

  template <class Body>
  Result<HttpReply> ask(http::request<Body>& request) {
    boost::system::error_code error;
    http::write(link_, request, error);
    return read_reply(error);
  }

  /// An error of the write is set aside until the reply is read: a daemon that refuses an upload early says why.
  Result<HttpReply> read_reply(const boost::system::error_code& write_error) {
    boost::system::error_code error;
    boost::beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(boost::none);
    http::read(link_, buffer, parser, error);
    if (error && error != http::error::end_of_stream && !parser.is_done()) {
      return lost(write_error ? write_error : error);
    }
    if (!parser.is_header_done()) {
      return lost(write_error ? write_error : error);
    }
    const auto& message = parser.get();
    return HttpReply{static_cast<int>(message.result_int()), std::string(message[http::field::content_type]),
                     message.body(), message.find(http::field::retry_after) != message.end()};
  }

  [[nodiscard]] Link& link() { return link_; }

 private:
  asio::io_context io_;
  Link link_;
  std::string host_;
  std::string port_;
  bool secure_;
};

}  // namespace

void HttpClient::trust(std::string ca_file) { ca_file_of_process() = std::move(ca_file); }

void HttpClient::use_token(std::string token) { token_of_process() = std::move(token); }

Result<HttpClient> HttpClient::to(std::string_view server) {
  const auto url = boost::urls::parse_uri(boost::core::string_view(server.data(), server.size()));
  const bool secure = url && url->scheme() == "https";
  const bool sound =
      url && (secure || url->scheme() == "http") && !url->host().empty() && url->encoded_path().size() <= 1;
  if (!sound) {
    return fail(
        ErrorCode::InvalidArgument,
        "The server is written http://HOST:PORT or https://HOST:PORT, for example http://127.0.0.1:8477, not '" +
            std::string(server) + "'.");
  }
  std::string host = url->host();
  if (host.size() > 2 && host.front() == '[') {
    host = host.substr(1, host.size() - 2);
  }
  return HttpClient(host, url->has_port() ? std::string(url->port()) : secure ? "443" : "80", secure);
}

Result<HttpReply> HttpClient::get(const std::string& target, const std::string& accept) {
  return get(target, accept, 0);
}

Result<HttpReply> HttpClient::get_settled(const std::string& target, const std::string& accept,
                                          const std::function<bool()>& stop) {
  while (true) {
    auto reply = get(target, accept, kPatienceS);
    if (!reply || reply->status != 200 || !reply->pending || stop()) {
      return reply;
    }
  }
}

Result<HttpReply> HttpClient::get(const std::string& target, const std::string& accept, int wait_s) {
  Exchange exchange(host_, port_, secure_);
  if (auto connected = exchange.connect(); !connected) {
    return fail(connected.error());
  }
  http::request<http::empty_body> request(http::verb::get, target, 11);
  exchange.prepare(request);
  request.set(http::field::accept, accept);
  if (wait_s > 0) {
    request.set(http::field::prefer, "wait=" + std::to_string(wait_s));
  }
  return exchange.ask(request);
}

Result<HttpReply> HttpClient::post(const std::string& target, const std::string& json) {
  return send({"POST", target, json, "*/*", ""});
}

Result<HttpReply> HttpClient::send(const HttpRequest& wanted) {
  Exchange exchange(host_, port_, secure_);
  if (auto connected = exchange.connect(); !connected) {
    return fail(connected.error());
  }
  http::request<http::string_body> request(http::string_to_verb(wanted.method), wanted.target, 11);
  exchange.prepare(request);
  request.set(http::field::accept, wanted.accept);
  if (!wanted.if_match.empty()) {
    request.set(http::field::if_match, wanted.if_match);
  }
  if (!wanted.json.empty()) {
    request.set(http::field::content_type, "application/json");
    request.body() = wanted.json;
  }
  request.prepare_payload();
  return exchange.ask(request);
}

Result<HttpReply> HttpClient::upload(const std::string& target, const std::filesystem::path& file,
                                     const std::function<void(double)>& sent) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code no_size;
  const auto size = std::filesystem::file_size(file, no_size);
  if (!stream || no_size) {
    return fail(ErrorCode::NotFound, "The file " + file.string() + " cannot be opened.");
  }
  Exchange exchange(host_, port_, secure_);
  if (auto connected = exchange.connect(); !connected) {
    return fail(connected.error());
  }
  http::request<http::empty_body> request(http::verb::post, target, 11);
  exchange.prepare(request);
  request.set(http::field::content_type, "application/octet-stream");
  request.content_length(size);
  boost::system::error_code error;
  http::request_serializer<http::empty_body> serializer(request);
  http::write_header(exchange.link(), serializer, error);
  std::vector<char> piece(std::size_t{256} * 1024);
  std::uintmax_t done = 0;
  while (!error && done < size) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const auto count = static_cast<std::size_t>(stream.gcount());
    if (count == 0) {
      return fail(ErrorCode::Io, "The file " + file.string() + " became shorter while it was sent.");
    }
    asio::write(exchange.link(), asio::buffer(piece.data(), count), error);
    done += count;
    sent(static_cast<double>(done) / static_cast<double>(size));
  }
  return exchange.read_reply(error);
}

namespace {

/// The value of a field of an event, `name: value`; empty where it is not there.
std::string_view field_of(std::string_view block, std::string_view name) {
  while (!block.empty()) {
    const std::string_view line = block.substr(0, block.find('\n'));
    block.remove_prefix(std::min(block.size(), line.size() + 1));
    if (line.starts_with(name)) {
      return line.substr(name.size());
    }
  }
  return {};
}

}  // namespace

Status HttpClient::follow(const std::string& target, const std::function<bool(std::string_view)>& event,
                          std::string* last_id) {
  Exchange exchange(host_, port_, secure_);
  if (auto connected = exchange.connect(); !connected) {
    return connected;
  }
  http::request<http::empty_body> request(http::verb::get, target, 11);
  exchange.prepare(request);
  request.set(http::field::accept, "text/event-stream");
  if (last_id != nullptr && !last_id->empty()) {
    request.set("Last-Event-ID", *last_id);
  }
  boost::system::error_code error;
  http::write(exchange.link(), request, error);
  boost::beast::flat_buffer buffer;
  http::response_parser<http::buffer_body> parser;
  parser.body_limit(boost::none);
  http::read_header(exchange.link(), buffer, parser, error);
  if (error) {
    return exchange.lost(error);
  }
  std::string text;
  std::vector<char> piece(std::size_t{16} * 1024);
  while (!parser.is_done()) {
    parser.get().body().data = piece.data();
    parser.get().body().size = piece.size();
    http::read_some(exchange.link(), buffer, parser, error);
    text.append(piece.data(), piece.size() - parser.get().body().size);
    if (error && error != http::error::need_buffer) {
      return error == http::error::end_of_stream || error == asio::error::eof ||
                     error == asio::ssl::error::stream_truncated
                 ? Status{}
                 : Status(exchange.lost(error));
    }
    std::size_t end = 0;
    while ((end = text.find("\n\n")) != std::string::npos) {
      const std::string block = text.substr(0, end);
      text.erase(0, end + 2);
      if (const std::string_view id = field_of(block, "id: "); last_id != nullptr && !id.empty()) {
        *last_id = id;
      }
      if (const std::string_view data = field_of(block, "data: "); !data.empty() && !event(data)) {
        return {};
      }
    }
  }
  return {};
}

std::string percent_encode(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
                       c == '.' || c == '_' || c == '~';
    if (plain) {
      result += c;
    } else {
      result += '%';
      result += kDigits[byte >> 4U];
      result += kDigits[byte & 15U];
    }
  }
  return result;
}

}  // namespace driftlab::cli
