#pragma once
/// `driftlabd token` and `driftlabd audit`: what an operator does with tokens and the audit log on the machine itself.
///
/// They open the data directory, so that no daemon may have it open; while one runs, /v1/tokens and /v1/audit do the
/// same for whoever has an admin token.
#include "server/settings.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace driftlab::server {

class AccessCommands {
 public:
  /// Adds the subcommands. This object must outlive the parsing.
  explicit AccessCommands(CLI::App& app);
  AccessCommands(const AccessCommands&) = delete;
  AccessCommands& operator=(const AccessCommands&) = delete;
  ~AccessCommands() = default;

  [[nodiscard]] bool parsed() const;
  /// Runs the one that was given. The exit code: 0, 1 for what failed, 2 for what was asked wrongly; 3 for an audit log
  /// that is not whole.
  [[nodiscard]] int run(const Settings& settings) const;

 private:
  CLI::App* create_ = nullptr;
  CLI::App* list_ = nullptr;
  CLI::App* revoke_ = nullptr;
  CLI::App* rotate_ = nullptr;
  CLI::App* verify_ = nullptr;
  CLI::App* export_ = nullptr;
  std::string name_;
  std::string scope_;
  std::vector<std::string> devices_;
  std::int64_t expires_days_ = 0;
  std::string id_;
  std::string file_;
  std::string head_;
};

}  // namespace driftlab::server
