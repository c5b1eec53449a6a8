#pragma once
/// What the daemon was told; where each value came from: server/configuration.hpp.
#include "core/signal/result.hpp"
#include "server/store/budgets.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace driftlab::server {

struct Settings {
  std::filesystem::path data = "driftlab-data";
  std::string store;  ///< postgresql://... of the database that keeps the rows; empty: an SQLite file in `data`
  /// Where recordings are kept: empty: in `data`; or one of server/places/place.hpp.
  std::string blobs;
  std::filesystem::path blobs_credentials;  ///< file of the key of an object storage; empty: AWS_* variables have it
  int cache_megabytes = 10'000;             ///< of local copies of what lies in no folder
  std::string listen = "127.0.0.1:8477";
  std::vector<std::string> allow_host;     ///< Host names answered for, beside the address and localhost
  std::vector<std::string> proxies;        ///< addresses whose many connections are those of many people
  std::vector<std::string> webhook_allow;  ///< where webhooks may lead beside the Internet (server/webhooks)
  int workers = 0;                         ///< jobs at a time; 0: as many as threads
  int threads = 0;                         ///< that compute for all jobs together; 0: one per core
  int io_threads = 2;
  bool require_tokens = false;            ///< refuse requests without a token even before there is one
  std::filesystem::path tls_certificate;  ///< PEM, with its chain; empty: plain HTTP
  std::filesystem::path tls_key;
  bool insecure = false;  ///< listen on other addresses than loopback without TLS or tokens
  std::string log_level = "info";
  std::string log_file;           ///< empty: standard error
  std::filesystem::path backups;  ///< directory of the backups that the daemon makes by itself; empty: none
  int backup_hours = 24;          ///< between two of them; 0: only when asked
  int keep_backups = 7;           ///< complete ones; 0: all
  Budgets budgets;
  bool is_moving = false;  ///< opens a store that `driftlabd migrate` has under way
  bool serves_api = true;  ///< false: a worker, which answers /healthz, /readyz and /metrics alone
};

struct ListenAddress {
  std::string address;
  std::uint16_t port = 0;
};

/// `127.0.0.1:8477`, `[::1]:8477`. Errors: InvalidArgument, naming the parameter.
[[nodiscard]] Result<ListenAddress> listen_address(const Settings& settings);

/// Whether the daemon may listen there: beyond loopback only with TLS and tokens, unless `insecure`. `has_tokens` may
/// be false while that is not known yet but tokens are required. Errors: InvalidArgument, with the way out.
[[nodiscard]] Status require_safe_address(const Settings& settings, const ListenAddress& address, bool has_tokens);

/// A connection string without its password, for people and logs.
[[nodiscard]] std::string without_password(const std::string& uri);

/// Names the daemon answers for, lower case, without port.
[[nodiscard]] std::vector<std::string> allowed_hosts(const Settings& settings, const ListenAddress& address);

}  // namespace driftlab::server
