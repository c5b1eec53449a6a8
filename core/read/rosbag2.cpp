/// ROS 2 bag in an SQLite database (.db3): the tables `topics` and `messages`; messages about a journey in CDR are read
/// (core/read/ros_topics.hpp). Source: ros2/rosbag2, "rosbag2_storage_sqlite3", README.
///
/// A file from a stranger: the database is opened read-only and immutable (no journal, no log beside it is looked at),
/// its schema is not trusted, triggers and views are off, nothing but reading tables is authorised, and the work is
/// bounded by the size of the file, so that a tree of pages that refer to each other ends. Source: SQLite,
/// "Defense Against The Dark Arts". A bag that comes compressed or from memory is held there whole, within
/// `max_tables_bytes`.
#include "core/read/formats.hpp"
#include "core/read/ros_topics.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>

namespace driftlab::formats {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kMagic = "SQLite format 3\0"sv;
constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd"sv;
constexpr const char* kTopicsSql = "SELECT id, name, type, serialization_format FROM topics";
constexpr const char* kMessagesSql = "SELECT topic_id, timestamp, data FROM messages";
constexpr int kTurnOperations = 1000;  ///< of the virtual machine, between two looks at the budget

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// What a query may cost. A row takes some ten bytes of the file at least and a dozen operations.
struct Work {
  const RunControl& control;
  std::uint64_t turns_left = 0;
};

int may_go_on(void* context) {
  auto& work = *static_cast<Work*>(context);
  if (work.turns_left == 0 || work.control.stop.stop_requested()) {
    return 1;
  }
  --work.turns_left;
  return 0;
}

int authorise(void* /*context*/, int action, const char* /*a*/, const char* /*b*/, const char* /*c*/,
              const char* /*d*/) {
  return action == SQLITE_SELECT || action == SQLITE_READ ? SQLITE_OK : SQLITE_DENY;
}

void confine(sqlite3* database) {
  constexpr std::array kSwitches{std::pair(SQLITE_DBCONFIG_DEFENSIVE, 1), std::pair(SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0),
                                 std::pair(SQLITE_DBCONFIG_ENABLE_TRIGGER, 0),
                                 std::pair(SQLITE_DBCONFIG_ENABLE_VIEW, 0),
                                 std::pair(SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0)};
  for (const auto& [what, value] : kSwitches) {
    ::sqlite3_db_config(database, what, value, nullptr);
  }
  constexpr std::array kLimits{std::pair(SQLITE_LIMIT_LENGTH, 1 << 20),    std::pair(SQLITE_LIMIT_SQL_LENGTH, 1 << 16),
                               std::pair(SQLITE_LIMIT_COLUMN, 64),         std::pair(SQLITE_LIMIT_EXPR_DEPTH, 16),
                               std::pair(SQLITE_LIMIT_COMPOUND_SELECT, 2), std::pair(SQLITE_LIMIT_VDBE_OP, 10'000),
                               std::pair(SQLITE_LIMIT_FUNCTION_ARG, 4),    std::pair(SQLITE_LIMIT_ATTACHED, 0),
                               std::pair(SQLITE_LIMIT_TRIGGER_DEPTH, 1),   std::pair(SQLITE_LIMIT_WORKER_THREADS, 0)};
  for (const auto& [what, value] : kLimits) {
    ::sqlite3_limit(database, what, value);
  }
  ::sqlite3_exec(database, "PRAGMA cell_size_check = ON; PRAGMA mmap_size = 0;", nullptr, nullptr, nullptr);
  ::sqlite3_set_authorizer(database, authorise, nullptr);
}

/// `path` as a URI, every byte but letters, digits and a few signs escaped.
std::string immutable_uri(const std::filesystem::path& path) {
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(path).string()) {
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '/' ||
                       c == '-' || c == '_' || c == '.';
    const auto byte = static_cast<unsigned char>(c);
    uri += plain ? std::string(1, c) : std::string{'%', kHex[byte >> 4U], kHex[byte & 15U]};
  }
  return uri + "?mode=ro&immutable=1";
}

class Bag2Decoder {
 public:
  Bag2Decoder(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control)
      : source_(source), limits_(limits), control_(control), topics_(sink), work_{control} {}

  Status run();

 private:
  Status open();
  Status load();
  Status take_topics();
  Status take_messages();
  Result<Statement> prepare(const char* sql);
  [[nodiscard]] tl::unexpected<Error> damaged(const std::string& where) const;

  ByteSource& source_;
  const DecodeLimits& limits_;
  const RunControl& control_;
  RosTopics topics_;
  Work work_;
  std::vector<unsigned char> bytes_;  ///< of a database that is no file
  Database database_{nullptr, ::sqlite3_close};
  std::map<std::int64_t, std::size_t> numbers_;  ///< topic by id
  std::uint64_t messages_ = 0;
};

tl::unexpected<Error> Bag2Decoder::damaged(const std::string& where) const {
  if (control_.stop.stop_requested()) {
    return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
  }
  if (::sqlite3_errcode(database_.get()) == SQLITE_INTERRUPT) {
    return fail(ErrorCode::ShapeMismatch, "The ROS 2 bag is damaged: its pages hold more rows than bytes.");
  }
  return fail(ErrorCode::ShapeMismatch,
              "The ROS 2 bag cannot be read " + where + ": " + std::string(::sqlite3_errmsg(database_.get())) + ".");
}

/// The whole input in memory.
Status Bag2Decoder::load() {
  while (true) {
    if (control_.stop.stop_requested()) {
      return fail(ErrorCode::Cancelled, "Decoding was cancelled.");
    }
    auto view = source_.view();
    if (!view) {
      return fail(view.error());
    }
    if (view->empty()) {
      break;
    }
    if (bytes_.size() + view->size() > limits_.max_tables_bytes) {
      return fail(ErrorCode::LimitExceeded,
                  "A compressed ROS 2 bag of more than " + std::to_string(limits_.max_tables_bytes) +
                      " bytes cannot be read; decompress it first.",
                  {{"limit", std::to_string(limits_.max_tables_bytes)}});
    }
    bytes_.insert(bytes_.end(), view->begin(), view->end());
    source_.consume(view->size());
  }
  constexpr std::size_t kWriteVersion = 18;
  if (bytes_.size() > kWriteVersion + 1) {
    bytes_[kWriteVersion] = bytes_[kWriteVersion + 1] = 1;  // a log beside the database is not looked at
  }
  return {};
}

Status Bag2Decoder::open() {
  const auto path = source_.path();
  const std::uint64_t size = path ? source_.input_size() : limits_.max_tables_bytes;
  if (!path) {
    if (auto status = load(); !status) {
      return status;
    }
  }
  constexpr std::uint64_t kOperationsPerByte = 4;
  const std::uint64_t bytes = path ? size : bytes_.size();
  work_.turns_left = 1000 + kOperationsPerByte * bytes / kTurnOperations;
  sqlite3* database = nullptr;
  const std::string uri = path ? immutable_uri(*path) : ":memory:";
  const int opened =
      ::sqlite3_open_v2(uri.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX, nullptr);
  database_.reset(database);
  if (database == nullptr) {
    return fail(ErrorCode::Internal, "The database reader could not be started.");
  }
  if (opened != SQLITE_OK) {
    return damaged("at all");
  }
  if (!path &&
      ::sqlite3_deserialize(database, "main", bytes_.data(), static_cast<sqlite3_int64>(bytes_.size()),
                            static_cast<sqlite3_int64>(bytes_.size()), SQLITE_DESERIALIZE_READONLY) != SQLITE_OK) {
    return damaged("at all");
  }
  confine(database);
  ::sqlite3_progress_handler(database, kTurnOperations, may_go_on, &work_);
  return {};
}

Result<Statement> Bag2Decoder::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (::sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    return damaged("as one (tables `topics` and `messages`)");
  }
  return Statement(statement, ::sqlite3_finalize);
}

/// A column of the current row as bytes, valid until the next row.
std::string_view bytes_at(sqlite3_stmt* row, int column) {
  const void* const bytes = ::sqlite3_column_blob(row, column);
  const int size = ::sqlite3_column_bytes(row, column);
  return bytes == nullptr || size <= 0
             ? std::string_view()
             : std::string_view(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
}

Status Bag2Decoder::take_topics() {
  auto rows = prepare(kTopicsSql);
  if (!rows) {
    return fail(rows.error());
  }
  int code = SQLITE_ROW;
  while ((code = ::sqlite3_step(rows->get())) == SQLITE_ROW) {
    const std::string name(bytes_at(rows->get(), 1));
    const std::string type(bytes_at(rows->get(), 2));
    auto topic = topics_.add(name, type, bytes_at(rows->get(), 3));
    if (!topic) {
      return fail(topic.error());
    }
    numbers_.emplace(::sqlite3_column_int64(rows->get(), 0), *topic);
  }
  return code == SQLITE_DONE ? Status{} : damaged("in its topics");
}

Status Bag2Decoder::take_messages() {
  auto rows = prepare(kMessagesSql);
  if (!rows) {
    return fail(rows.error());
  }
  int code = SQLITE_ROW;
  while ((code = ::sqlite3_step(rows->get())) == SQLITE_ROW) {
    const auto topic = numbers_.find(::sqlite3_column_int64(rows->get(), 0));
    if (topic == numbers_.end() || !topics_.wants(topic->second)) {
      continue;
    }
    ++messages_;
    const auto log_ns = static_cast<std::uint64_t>(::sqlite3_column_int64(rows->get(), 1));
    const std::string_view message = bytes_at(rows->get(), 2);
    if (messages_ == 1 && message.starts_with(kZstdMagic)) {
      return fail(ErrorCode::UnsupportedType,
                  "The messages of the ROS 2 bag are compressed one by one; `ros2 bag convert` unpacks them.");
    }
    if (auto status = topics_.take(topic->second, message, log_ns); !status) {
      return status;
    }
  }
  return code == SQLITE_DONE ? Status{} : damaged("behind message " + std::to_string(messages_));
}

Status Bag2Decoder::run() {
  if (auto status = open(); !status) {
    return status;
  }
  if (auto status = take_topics(); !status) {
    return status;
  }
  if (auto status = take_messages(); !status) {
    return status;
  }
  return topics_.finish("ROS 2 bag");
}

int sniff(std::string_view head) { return head.starts_with(kMagic) ? 100 : 0; }

Status decode(ByteSource& source, const DecodeLimits& limits, ColumnSink& sink, const RunControl& control) {
  return Bag2Decoder(source, limits, sink, control).run();
}

}  // namespace

const Format kRosbag2{"rosbag2", "ROS 2 bag in an SQLite database (.db3)", sniff, decode};

}  // namespace driftlab::formats
