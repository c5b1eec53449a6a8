#pragma once
/// The configuration of the daemon: flags win over DRIFTLAB_* variables, these over a TOML file, that over defaults.
///
/// A setting is one line of `all_settings`; a budget is one line of server/store/budgets.hpp. Flag, variable, key of
/// the file, `--help` and `driftlabd config` follow from the line: `io_threads` is `--io-threads`,
/// `DRIFTLAB_IO_THREADS` and `io_threads = 2`; the budget `uploads` is `--budget uploads=4`, `DRIFTLAB_BUDGET_UPLOADS`
/// and `uploads = 4` under
/// `[budgets]`. A key, variable or budget that is not known is an error, never ignored.
#include "core/signal/result.hpp"
#include "schema/json/json.hpp"
#include "server/settings.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab::server {

enum class SettingKind { Text, Switch, List };

/// One setting, as text on its way in and as JSON on its way out.
struct Setting {
  std::string_view name;
  SettingKind kind;
  std::string_view meaning;
  /// Error: InvalidArgument with a sentence that says what is taken.
  std::function<Status(Settings&, const std::vector<std::string>&)> set;
  std::function<Json(const Settings&)> get;
};

/// Every setting but the budgets, once.
[[nodiscard]] const std::vector<Setting>& all_settings();

/// What the command line said: values by the name of the setting, and the configuration file, `NAME=VALUE` of budgets.
struct GivenFlags {
  std::map<std::string, std::vector<std::string>, std::less<>> values;
  std::string file;
  std::vector<std::string> budgets;
};

/// A value in force and where it came from: `flag --workers`, `variable DRIFTLAB_WORKERS`, `file /etc/...`, `default`.
struct ConfiguredValue {
  std::string name;  ///< of a budget: `budgets.uploads`
  Json value;
  std::string origin;
};

struct Configuration {
  Settings settings;
  std::vector<ConfiguredValue> values;  ///< settings in their order, then budgets in theirs
};

/// The environment as names and values.
using Environment = std::map<std::string, std::string, std::less<>>;

/// The variables of this process that begin with DRIFTLAB_. Call before threads start.
[[nodiscard]] Environment own_environment();

/// Errors: InvalidArgument, NotFound and Io (the file), ParseError (the file is no TOML; field `line`).
[[nodiscard]] Result<Configuration> configure(const GivenFlags& flags, const Environment& environment);

/// {"settings": {NAME: {"value", "origin"}}, "budgets": {NAME: {"value", "origin", "least", "most", "meaning"}}}
[[nodiscard]] Json to_json(const Configuration& configuration);

}  // namespace driftlab::server
