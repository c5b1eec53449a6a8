#include "server/configuration.hpp"

#include "core/signal/text.hpp"
#include "server/places/place.hpp"
#include "server/store/network.hpp"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>

// The library's own warnings are not ours.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wconversion"
#define TOML_EXCEPTIONS 0
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>
#pragma GCC diagnostic pop

namespace driftlab::server {
namespace {

tl::unexpected<Error> refuse(std::string_view name, const std::string& what) {
  return fail(ErrorCode::InvalidArgument, "The setting " + std::string(name) + " " + what,
              {{"parameter", std::string(name)}});
}

std::optional<std::int64_t> whole(const std::string& text) {
  std::int64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stop != text.data() + text.size() || text.empty()) {
    return std::nullopt;
  }
  return value;
}

Setting text_setting(std::string_view name, std::string Settings::* member, std::string_view meaning) {
  return {name, SettingKind::Text, meaning,
          [member](Settings& settings, const std::vector<std::string>& values) -> Status {
            settings.*member = values.back();
            return {};
          },
          [member](const Settings& settings) { return Json(settings.*member); }};
}

Setting whole_setting(std::string_view name, int Settings::* member, int least, int most, std::string_view meaning) {
  return {name, SettingKind::Text, meaning,
          [=](Settings& settings, const std::vector<std::string>& values) -> Status {
            const auto value = whole(values.back());
            if (!value || *value < least || *value > most) {
              return refuse(name, "must be a whole number from " + std::to_string(least) + " to " +
                                      std::to_string(most) + ", not '" + values.back() + "'.");
            }
            settings.*member = static_cast<int>(*value);
            return {};
          },
          [member](const Settings& settings) { return Json(settings.*member); }};
}

Setting list_setting(std::string_view name, std::vector<std::string> Settings::* member, std::string_view meaning) {
  return {name, SettingKind::List, meaning,
          [member](Settings& settings, const std::vector<std::string>& values) -> Status {
            settings.*member = values;
            return {};
          },
          [member](const Settings& settings) { return Json(settings.*member); }};
}

/// A list of which each entry is one that `holds`; `names` ends the sentence "NAME names … , not 'ENTRY'".
Setting checked_list_setting(std::string_view name, std::vector<std::string> Settings::* member,
                             std::string_view meaning, bool (*holds)(const std::string& entry),
                             std::string_view names) {
  Setting setting = list_setting(name, member, meaning);
  setting.set = [=](Settings& settings, const std::vector<std::string>& values) -> Status {
    const auto wrong = std::find_if_not(values.begin(), values.end(), holds);
    if (wrong != values.end()) {
      return refuse(name, "names " + std::string(names) + ", not '" + *wrong + "'.");
    }
    settings.*member = values;
    return {};
  };
  return setting;
}

bool is_network(const std::string& entry) { return Network::parse(entry).has_value(); }

/// Without a port, for a proxy may stand before the daemon's own.
bool is_host(const std::string& entry) {
  const bool is_v6 = is_network(entry) || (entry.starts_with('[') && entry.ends_with(']'));
  return !entry.empty() && entry.find('/') == std::string::npos && (is_v6 || entry.find(':') == std::string::npos);
}

Setting switch_setting(std::string_view name, bool Settings::* member, std::string_view meaning) {
  return {name, SettingKind::Switch, meaning,
          [=](Settings& settings, const std::vector<std::string>& values) -> Status {
            const std::string& value = values.back();
            const bool on = value == "true" || value == "1" || value == "on" || value == "yes";
            const bool off = value == "false" || value == "0" || value == "off" || value == "no" || value.empty();
            if (!on && !off) {
              return refuse(name, "must be true or false, not '" + value + "'.");
            }
            settings.*member = on;
            return {};
          },
          [member](const Settings& settings) { return Json(settings.*member); }};
}

Setting data_setting() {
  return {"data", SettingKind::Text, "Directory of database and recordings, made if absent",
          [](Settings& settings, const std::vector<std::string>& values) -> Status {
            settings.data = values.back();
            return values.back().empty() ? Status(refuse("data", "must name a directory.")) : Status{};
          },
          [](const Settings& settings) { return Json(settings.data.string()); }};
}

/// A database's password is never shown.
Setting store_setting() {
  return {"store", SettingKind::Text,
          "PostgreSQL database of the rows, postgresql://USER@HOST/DATABASE; none: an SQLite file in --data",
          [](Settings& settings, const std::vector<std::string>& values) -> Status {
            const std::string& uri = values.back();
            if (!uri.empty() && !uri.starts_with("postgresql://") && !uri.starts_with("postgres://")) {
              return refuse("store", "must be postgresql://USER@HOST:PORT/DATABASE, or nothing for SQLite in --data.");
            }
            settings.store = uri;
            return {};
          },
          [](const Settings& settings) { return Json(without_password(settings.store)); }};
}

Setting blobs_setting() {
  return {"blobs", SettingKind::Text,
          "Recordings that several daemons and workers share: a folder, `database`, or "
          "s3://BUCKET/PREFIX?endpoint=URL&region=NAME; none: in --data",
          [](Settings& settings, const std::vector<std::string>& values) -> Status {
            const std::string& where = values.back();
            const BlobPlace* const place = find_blob_place(where);
            if (place == nullptr) {
              return refuse("blobs", "must be " + meanings_of_blob_places() + ".");
            }
            const std::string fault = place->fault(where);
            if (!fault.empty()) {
              return refuse("blobs", fault);
            }
            settings.blobs = where;
            return {};
          },
          [](const Settings& settings) { return Json(settings.blobs); }};
}

Setting path_setting(std::string_view name, std::filesystem::path Settings::* member, std::string_view meaning) {
  return {name, SettingKind::Text, meaning,
          [member](Settings& settings, const std::vector<std::string>& values) -> Status {
            settings.*member = values.back();
            return {};
          },
          [member](const Settings& settings) { return Json((settings.*member).string()); }};
}

Setting log_level_setting() {
  return {"log_level", SettingKind::Text, "Least severe events to log: debug, info, warning, error",
          [](Settings& settings, const std::vector<std::string>& values) -> Status {
            const std::string& level = values.back();
            if (level != "debug" && level != "info" && level != "warning" && level != "error") {
              return refuse("log_level", "must be debug, info, warning or error, not '" + level + "'.");
            }
            settings.log_level = level;
            return {};
          },
          [](const Settings& settings) { return Json(settings.log_level); }};
}

std::string variable_of(std::string_view name) {
  std::string variable = "DRIFTLAB_";
  std::transform(name.begin(), name.end(), std::back_inserter(variable),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return variable;
}

std::string flag_of(std::string_view name) {
  std::string flag = "--" + std::string(name);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    if (end > begin) {
      parts.push_back(text.substr(begin, end - begin));
    }
    begin = end + 1;
  }
  return parts;
}

Status set_budget(Budgets& budgets, std::string_view name, const std::string& text) {
  const auto& all = all_budgets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Budget& budget) { return budget.name == name; });
  if (found == all.end()) {
    return fail(ErrorCode::InvalidArgument,
                "There is no budget '" + std::string(name) + "'; `driftlabd config` lists them.",
                {{"parameter", "budgets." + std::string(name)}});
  }
  const auto value = whole(text);
  if (!value || *value < found->least || *value > found->most) {
    return fail(ErrorCode::InvalidArgument,
                "The budget " + std::string(name) + " is a whole number from " + std::to_string(found->least) + " to " +
                    std::to_string(found->most) + ", not '" + text + "'.",
                {{"parameter", "budgets." + std::string(name)}});
  }
  budgets.*found->value = *value;
  return {};
}

/// Values as they were given, by name, with their origin. A budget's name is `budgets.NAME`.
struct GivenValue {
  std::vector<std::string> values;
  std::string origin;
};
using GivenValues = std::map<std::string, GivenValue, std::less<>>;

/// A value of the file as text; nothing for what no setting can be.
std::optional<std::string> text_of(const toml::node& node) {
  if (const auto* const text = node.as_string()) {
    return text->get();
  }
  if (const auto* const number = node.as_integer()) {
    return std::to_string(number->get());
  }
  if (const auto* const truth = node.as_boolean()) {
    return truth->get() ? "true" : "false";
  }
  return std::nullopt;
}

Status take_from_table(const toml::table& table, const std::string& prefix, const std::string& origin,
                       GivenValues& into) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (prefix.empty() && name == "budgets" && node.is_table()) {
      if (auto taken = take_from_table(*node.as_table(), "budgets.", origin, into); !taken) {
        return taken;
      }
      continue;
    }
    GivenValue given{{}, origin};
    if (const auto* const list = node.as_array()) {
      for (const toml::node& element : *list) {
        const auto text = text_of(element);
        if (!text) {
          return refuse(name, "in the configuration file is a list of something else than texts.");
        }
        given.values.push_back(*text);
      }
    } else if (const auto text = text_of(node)) {
      given.values.push_back(*text);
    } else {
      return refuse(name, "in the configuration file must be a text, a whole number, true or false, or a list.");
    }
    into.insert_or_assign(name, std::move(given));
  }
  return {};
}

Status take_from_file(const std::string& path, GivenValues& into) {
  std::error_code none;
  std::ifstream stream(path);
  if (!stream || std::filesystem::is_directory(path, none)) {  // which opens like a file
    const bool there = std::filesystem::exists(path, none);
    return fail(there ? ErrorCode::Io : ErrorCode::NotFound,
                "The configuration file '" + path + "' " + (there ? "cannot be read." : "does not exist."),
                {{"parameter", "config"}});
  }
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  const toml::parse_result parsed = toml::parse(text, path);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    const std::string line = std::to_string(error.source().begin.line);
    return fail(ErrorCode::ParseError,
                "The configuration file '" + path + "' is no TOML at line " + line + ": " +
                    std::string(error.description()) + ".",
                {{"line", line}});
  }
  return take_from_table(parsed.table(), "", "file " + path, into);
}

/// Of names that a later release or a typing error made: never ignored.
Status require_known(const GivenValues& given) {
  for (const auto& [name, value] : given) {
    const std::string_view seen = name;
    const bool budget = name.starts_with("budgets.");
    const bool known = budget ? std::any_of(all_budgets().begin(), all_budgets().end(),
                                            [&](const Budget& one) { return one.name == seen.substr(8); })
                              : std::any_of(all_settings().begin(), all_settings().end(),
                                            [&](const Setting& one) { return one.name == seen; });
    if (!known) {
      return fail(ErrorCode::InvalidArgument,
                  "There is no setting '" + name + "' (" + value.origin + "); `driftlabd config` lists them.",
                  {{"parameter", name}});
    }
  }
  return {};
}

/// Variables that are no settings.
bool is_for_others(std::string_view variable) {
  for (const std::string_view name : {"DRIFTLAB_CONFIG", "DRIFTLAB_CRASH_AT", "DRIFTLAB_TOKEN", "DRIFTLAB_SERVER"}) {
    if (variable == name) {
      return true;
    }
  }
  return false;
}

/// Whether one letter more, less or other turns one into the other.
bool is_one_letter_off(std::string_view one, std::string_view other) {
  if (one.size() > other.size()) {
    std::swap(one, other);
  }
  if (other.size() - one.size() > 1) {
    return false;
  }
  const auto [left, right] = std::mismatch(one.begin(), one.end(), other.begin());
  const bool is_changed = one.size() == other.size();
  return std::equal(left == one.end() || !is_changed ? left : left + 1, one.end(),
                    right == other.end() ? right : right + 1, other.end());
}

/// Other programs have variables of this prefix too (tests, the command line; Kubernetes makes DRIFTLAB_PORT and others
/// for a service of that name), so that not every unknown one is a mistake. One that is a letter off is.
Status require_no_slip(std::string_view variable) {
  for (const Setting& setting : all_settings()) {
    if (is_one_letter_off(variable, variable_of(setting.name))) {
      return fail(ErrorCode::InvalidArgument,
                  "There is no variable " + std::string(variable) + "; " + variable_of(setting.name) + " is meant?",
                  {{"parameter", std::string(variable)}});
    }
  }
  return {};
}

Status take_from_environment(const Environment& environment, GivenValues& into) {
  constexpr std::string_view kBudget = "DRIFTLAB_BUDGET_";
  for (const auto& [variable, value] : environment) {
    if (is_for_others(variable)) {
      continue;
    }
    const std::string origin = "variable " + variable;
    if (variable.starts_with(kBudget)) {
      into.insert_or_assign("budgets." + lower_case(std::string_view(variable).substr(kBudget.size())),
                            GivenValue{{value}, origin});
      continue;
    }
    const auto& all = all_settings();
    const auto found = std::find_if(
        all.begin(), all.end(), [&sought = variable](const Setting& one) { return variable_of(one.name) == sought; });
    if (found == all.end()) {
      if (auto meant = require_no_slip(variable); !meant) {
        return meant;
      }
    } else if (!value.empty()) {
      const bool list = found->kind == SettingKind::List;
      into.insert_or_assign(std::string(found->name),
                            GivenValue{list ? split_list(value) : std::vector{value}, origin});
    }
  }
  return {};
}

Status take_from_flags(const GivenFlags& flags, GivenValues& into) {
  for (const auto& [name, values] : flags.values) {
    if (!values.empty()) {
      into.insert_or_assign(name, GivenValue{values, "flag " + flag_of(name)});
    }
  }
  for (const std::string& pair : flags.budgets) {
    const std::size_t equals = pair.find('=');
    if (equals == std::string::npos) {
      return fail(ErrorCode::InvalidArgument, "A budget is given as NAME=VALUE, not '" + pair + "'.",
                  {{"parameter", "budget"}});
    }
    into.insert_or_assign("budgets." + pair.substr(0, equals), GivenValue{{pair.substr(equals + 1)}, "flag --budget"});
  }
  return {};
}

}  // namespace

const std::vector<Setting>& all_settings() {
  static const std::vector<Setting> all{
      data_setting(),
      store_setting(),
      blobs_setting(),
      path_setting("blobs_credentials", &Settings::blobs_credentials,
                   "File of the object storage's key, as ~/.aws/credentials; none: AWS_ACCESS_KEY_ID and its like"),
      whole_setting("cache_megabytes", &Settings::cache_megabytes, 0, 100'000'000,
                    "Local copies of recordings that lie in a database or an object storage, in --data"),
      text_setting("listen", &Settings::listen, "IP:PORT to listen on; port 0 takes any free one"),
      checked_list_setting("allow_host", &Settings::allow_host,
                           "Another name to answer for in the Host header, without a port", is_host,
                           "hosts without a port"),
      checked_list_setting("proxies", &Settings::proxies,
                           "Address of a proxy, or network of proxies, which connect for many people", is_network,
                           "addresses or networks such as 10.1.2.0/24"),
      list_setting("webhook_allow", &Settings::webhook_allow,
                   "Host, address or network that webhooks may lead to beside the Internet, also by plain http"),
      whole_setting("workers", &Settings::workers, 0, 256, "Jobs that run at once; 0 is as many as threads"),
      whole_setting("threads", &Settings::threads, 0, 256, "Threads that all jobs share; 0 is one per core"),
      whole_setting("io_threads", &Settings::io_threads, 1, 64, "Threads that serve connections"),
      log_level_setting(),
      text_setting("log_file", &Settings::log_file, "File for the log, opened again at SIGHUP; none: standard error"),
      path_setting("backups", &Settings::backups, "Directory in which the daemon backs itself up; none: it does not"),
      whole_setting("backup_hours", &Settings::backup_hours, 0, 8760, "Time between two backups; 0: only when asked"),
      whole_setting("keep_backups", &Settings::keep_backups, 0, 100'000, "The newest complete backups stay; 0: all"),
      path_setting("tls_certificate", &Settings::tls_certificate,
                   "PEM file of the certificate and its chain; then HTTPS only"),
      path_setting("tls_key", &Settings::tls_key, "PEM file of the certificate's private key"),
      switch_setting("require_tokens", &Settings::require_tokens,
                     "Ask everybody for a token; makes the first one, for an admin, where there is none"),
      switch_setting("insecure", &Settings::insecure, "Listen beyond loopback without TLS or tokens"),
  };
  return all;
}

Environment own_environment() {
  Environment found;
  for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
    const std::string_view pair = *entry;
    const std::size_t equals = pair.find('=');
    if (pair.starts_with("DRIFTLAB_") && equals != std::string_view::npos) {
      found.emplace(pair.substr(0, equals), pair.substr(equals + 1));
    }
  }
  return found;
}

Result<Configuration> configure(const GivenFlags& flags, const Environment& environment) {
  GivenValues given;
  const auto variable = environment.find("DRIFTLAB_CONFIG");
  const std::string file = !flags.file.empty() || variable == environment.end() ? flags.file : variable->second;
  Status taken = file.empty() ? Status{} : take_from_file(file, given);
  if (taken) {
    taken = take_from_environment(environment, given);
  }
  if (taken) {
    taken = take_from_flags(flags, given);
  }
  if (taken) {
    taken = require_known(given);
  }
  if (!taken) {
    return fail(taken.error());
  }
  Configuration configuration;
  for (const Setting& setting : all_settings()) {
    const auto found = given.find(setting.name);
    if (found != given.end()) {
      if (found->second.values.empty() && setting.kind != SettingKind::List) {
        return refuse(setting.name, "has no value.");
      }
      if (auto set = setting.set(configuration.settings, found->second.values); !set) {
        return fail(set.error());
      }
    }
    configuration.values.push_back({std::string(setting.name), setting.get(configuration.settings),
                                    found == given.end() ? "default" : found->second.origin});
  }
  for (const Budget& budget : all_budgets()) {
    const std::string name = "budgets." + std::string(budget.name);
    const auto found = given.find(name);
    if (found != given.end()) {
      const std::string value = found->second.values.empty() ? "" : found->second.values.back();
      if (auto set = set_budget(configuration.settings.budgets, budget.name, value); !set) {
        return fail(set.error());
      }
    }
    configuration.values.push_back(
        {name, configuration.settings.budgets.*budget.value, found == given.end() ? "default" : found->second.origin});
  }
  return configuration;
}

Json to_json(const Configuration& configuration) {
  Json document{{"settings", Json::object()}, {"budgets", Json::object()}};
  std::size_t budget = 0;
  for (const ConfiguredValue& one : configuration.values) {
    Json entry{{"value", one.value}, {"origin", one.origin}};
    if (!one.name.starts_with("budgets.")) {
      document["settings"][one.name] = std::move(entry);
      continue;
    }
    const Budget& known = all_budgets()[budget++];
    entry["least"] = known.least;
    entry["most"] = known.most;
    entry["meaning"] = known.meaning;
    document["budgets"][one.name.substr(8)] = std::move(entry);
  }
  return document;
}

}  // namespace driftlab::server
