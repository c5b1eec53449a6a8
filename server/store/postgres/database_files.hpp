#pragma once
/// Files of recordings in a PostgreSQL database, in parts of 1 MiB: nothing but the database has to be shared, at the
/// price of one as large as the recordings. Base backups and pg_dump hold them too.
#include "server/store/remote_files.hpp"
#include "server/store/sql/database.hpp"

#include <cstdint>
#include <optional>

namespace driftlab::server {

class DatabaseFiles final : public RemoteFiles {
 public:
  /// `database` must outlive this object.
  explicit DatabaseFiles(Database& database) : database_(database) {}

  [[nodiscard]] Status store(const std::string& blob, std::span<const LocalFile> files) override;
  [[nodiscard]] Result<std::string> read(const std::string& blob, FileKind kind, const Sink& sink) const override;
  [[nodiscard]] Status remove(const std::string& blob) override;
  [[nodiscard]] Result<bool> remove_if_older(const std::string& blob, std::chrono::microseconds age) override;
  [[nodiscard]] Result<std::vector<std::string>> hashes_older_than(std::chrono::microseconds age) override;
  /// Of the database itself the store knows.
  [[nodiscard]] Status ping() const override { return {}; }

 private:
  struct Known {
    std::int64_t id = 0;
    std::string sha256;
  };
  [[nodiscard]] Result<std::optional<Known>> find(const std::string& blob, FileKind kind) const;
  [[nodiscard]] Status read_parts(std::int64_t id, const Sink& sink) const;
  [[nodiscard]] Result<bool> holds(const Known& known) const;
  [[nodiscard]] Result<bool> mark_as_new(const Known& known);
  [[nodiscard]] Status store_file(const std::string& blob, const LocalFile& file);

  Database& database_;
};

}  // namespace driftlab::server
