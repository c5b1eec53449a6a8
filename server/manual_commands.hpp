#pragma once
/// `driftlabd man` and `driftlabd completion`: what the build installs beside the program.
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): the library's name
class App;
}

namespace driftlab::server {

class ManualCommands {
 public:
  /// Adds the subcommands. `app` must outlive this object, which must outlive the parsing.
  explicit ManualCommands(CLI::App& app);
  ManualCommands(const ManualCommands&) = delete;
  ManualCommands& operator=(const ManualCommands&) = delete;
  ~ManualCommands() = default;

  [[nodiscard]] bool parsed() const;
  /// Prints what was asked for. The exit code.
  [[nodiscard]] int run() const;

 private:
  const CLI::App& app_;
  const CLI::App* man_ = nullptr;
  const CLI::App* completion_ = nullptr;
  std::string shell_;
};

}  // namespace driftlab::server
