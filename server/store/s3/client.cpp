#include "server/store/s3/client.hpp"

#include "server/store/digest.hpp"
#include "server/store/retry_policy.hpp"
#include "server/store/s3/xml.hpp"
#include "server/store/silent_store.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <thread>

namespace driftlab::server::s3 {
namespace {

constexpr std::size_t kMostIdle = 8;

/// A word of the storage that goes into a sentence: letters alone, of a code such as `AccessDenied`.
std::string letters_of(const std::string& text) {
  std::string letters;
  for (const char c : text.substr(0, 64)) {
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) {
      letters.push_back(c);
    }
  }
  return letters;
}

/// A status in words of the answer: `403 AccessDenied`.
std::string told(int status, const std::string& code) {
  return std::to_string(status) + (code.empty() ? "" : " ") + code;
}

bool is_one_of(std::string_view code, std::initializer_list<std::string_view> codes) {
  return std::find(codes.begin(), codes.end(), code) != codes.end();
}

bool is_full(int status, std::string_view code) {
  return status == 507 || status == 413 ||
         is_one_of(code, {"QuotaExceeded", "EntityTooLarge", "InsufficientStorage", "XMinioStorageFull",
                          "InsufficientCapacity", "ServiceQuotaExceeded"});
}

bool passes_by(int status, std::string_view code) {
  return status == 408 || status == 429 || status == 500 || status == 502 || status == 503 || status == 504 ||
         is_one_of(code, {"RequestTimeout", "SlowDown", "InternalError", "OperationAborted"});
}

std::chrono::milliseconds asked_pause(const Reply& reply) {
  const std::string text = reply.header("retry-after");
  int seconds = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  return std::chrono::seconds(error == std::errc{} && seconds > 0 ? seconds : 0);
}

}  // namespace

std::optional<UtcMicros> read_time(const std::string& text) {
  for (const char* form : {"%a, %d %b %Y %H:%M:%S GMT", "%Y-%m-%dT%H:%M:%S"}) {
    std::tm parts{};
    if (::strptime(text.c_str(), form, &parts) != nullptr) {
      return static_cast<UtcMicros>(::timegm(&parts)) * 1'000'000;
    }
  }
  return std::nullopt;
}

Client::Client(Place place, KeyRing keys, ClientOptions options)
    : place_(std::move(place)), keys_(std::move(keys)), options_(options), connector_(place_, options.patience) {}

Client::~Client() = default;

Result<Reply> Client::send(const Call& call, const Connection::Sink& sink) const {
  const auto until = std::chrono::steady_clock::now() + options_.in_all;
  Outcome outcome = attempt(call, sink);
  auto bound = options_.first_pause;
  const int attempts = sink ? 1 : options_.attempts;
  for (int i = 1; i < attempts && !outcome.reply && outcome.again && std::chrono::steady_clock::now() < until; ++i) {
    std::this_thread::sleep_for(outcome.pause.count() > 0 ? std::min(outcome.pause, options_.longest_pause)
                                                          : draw_pause(bound));
    bound = std::min(bound * 2, options_.longest_pause);
    outcome = attempt(call, sink);
  }
  return std::move(outcome.reply);
}

Result<Reply> Client::send_once(const Call& call) const { return attempt(call, {}).reply; }

std::unique_ptr<Connection> Client::take_open() const {
  const std::lock_guard<std::mutex> guard(idle_mutex_);
  if (idle_.empty()) {
    return nullptr;
  }
  auto connection = std::move(idle_.back());
  idle_.pop_back();
  return connection;
}

/// On a connection that was kept open, or on a new one: the storage may have closed the former meanwhile.
Result<Reply> Client::exchange(const Request& request, const Connection::Sink& sink) const {
  bool took = false;
  const auto watched = [&](std::span<const std::byte> bytes) -> Status {
    took = true;
    return sink(bytes);
  };
  const Connection::Sink watched_sink = sink ? Connection::Sink(watched) : Connection::Sink();
  auto connection = take_open();
  const auto run = [&]() -> Result<Reply> {
    try {
      auto reply = connection->exchange(request, watched_sink);
      if (reply && connection->is_open()) {
        const std::lock_guard<std::mutex> guard(idle_mutex_);
        if (idle_.size() < kMostIdle) {
          idle_.push_back(std::move(connection));
        }
      }
      return reply;
    } catch (const std::exception& unforeseen) {
      return fail(ErrorCode::Io, std::string("could not be asked: ") + unforeseen.what() + ".");
    }
  };
  if (connection) {
    auto reply = run();
    if (reply || took || reply.error().code != ErrorCode::Io ||
        reply.error().message.find("too long") != std::string::npos) {
      return reply;
    }
  }
  auto fresh = connector_.connect();
  if (!fresh) {
    return fail(fresh.error());
  }
  connection = std::move(*fresh);
  return run();
}

Client::Outcome Client::attempt(const Call& call, const Connection::Sink& sink) const {
  const auto keys = keys_();
  if (!keys) {
    return {fail(keys.error()), false, {}};
  }
  Signed request{
      call.verb, "/" + place_.bucket + (call.key.empty() ? "" : "/" + call.key), call.query, call.headers, {}};
  request.headers.emplace_back("host", place_.authority());
  Sha256 digest;
  digest.update(call.body);
  request.payload_sha256 = digest.finish();
  const std::string query = canonical_query(call.query);
  const std::string target = percent_encoded(request.path, true) + (query.empty() ? "" : "?" + query);
  const UtcMicros now = SystemClock().now() + ahead_micros_.load();
  auto reply = exchange({call.verb, target, signed_headers(request, *keys, place_.region, now), call.body}, sink);
  if (!reply) {
    Error error = std::move(reply.error());
    const bool of_storage = error.code == ErrorCode::Io && error.fields.empty();
    if (of_storage) {
      error = silent_store("The object storage at " + place_.authority() + " " + error.message,
                           {{"storage", place_.authority()}});
    }
    return {fail(std::move(error)), of_storage, {}};
  }
  return judge(call, std::move(*reply));
}

Client::Outcome Client::judge(const Call& call, Reply reply) const {
  // A multipart upload that is completed may fail behind the status 200.
  const bool failed_late = reply.status == 200 && call.verb == "POST" && !elements(reply.body, "Error").empty();
  if (reply.status / 100 == 2 && !failed_late) {
    return {std::move(reply), false, {}};
  }
  const int status = failed_late ? 500 : reply.status;
  const std::string code = letters_of(element_text(reply.body, "Code").value_or(""));
  const std::string storage = "The object storage at " + place_.authority();
  const auto say = [&](ErrorCode kind, const std::string& what) {
    return fail(kind, storage + " " + what + " (" + told(status, code) + ").", {{"storage", place_.authority()}});
  };
  constexpr UtcMicros kSkewMicros = 300'000'000;
  const UtcMicros ours = SystemClock().now();
  const UtcMicros theirs = read_time(reply.header("date")).value_or(ours + ahead_micros_);
  // The answer to HEAD has no code.
  const bool is_skewed = status == 403 && code.empty() && std::abs(theirs - ours - ahead_micros_) > kSkewMicros;
  if (code == "RequestTimeTooSkewed" || is_skewed) {
    ahead_micros_ = theirs - ours;
    return {say(ErrorCode::Io, "says that this machine's clock is wrong"), true, {}};
  }
  if (code == "NoSuchBucket") {
    return {say(ErrorCode::Io, "has no bucket " + place_.bucket), false, {}};
  }
  if (status == 404) {
    return {say(ErrorCode::NotFound, "has no such object"), false, {}};
  }
  if (is_full(status, code)) {
    return {say(ErrorCode::DiskFull, "has no room for more"), false, {}};
  }
  if (status == 401 || status == 403) {
    return {say(ErrorCode::Io, "refuses this key what it asks for in the bucket " + place_.bucket), false, {}};
  }
  if (status / 100 == 3) {
    return {say(ErrorCode::Io, "keeps the bucket " + place_.bucket + " in another region or at another endpoint"),
            false,
            {}};
  }
  if (passes_by(status, code)) {
    return {fail(silent_store(storage + " cannot do it now (" + told(status, code) + ").",
                              {{"storage", place_.authority()}})),
            true, asked_pause(reply)};
  }
  return {say(ErrorCode::Io, "does not understand the request"), false, {}};
}

}  // namespace driftlab::server::s3
