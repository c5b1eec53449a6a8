#include "core/signal/recording.hpp"

#include "core/signal/column_streams.hpp"
#include "core/signal/find_column.hpp"
#include "core/signal/infer_role.hpp"
#include "core/signal/number.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace driftlab {
namespace {

bool has_no_axis(Quantity quantity) { return quantity == Quantity::Time || quantity == Quantity::Temperature; }

std::string channel_text(const ColumnRole& role) {
  return std::string(name_of(role.quantity)) + (role.axis.empty() ? "" : " " + role.axis);
}

tl::unexpected<Error> claimed_twice(const std::string& first, const std::string& second, const ColumnRole& role) {
  return fail(ErrorCode::DuplicateColumn,
              "Columns '" + first + "' and '" + second + "' both claim to be " + channel_text(role) +
                  "; state in `columns` which one is.",
              {{"column", second}});
}

/// No two columns may be the same channel; unspecified columns without an axis are each their own.
Status check_distinct(const ColumnNames& names, const std::vector<std::optional<ColumnRole>>& roles) {
  std::map<std::pair<Quantity, std::string>, std::size_t> owner;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    const ColumnRole role = roles[i].value_or(ColumnRole{});
    if (role.quantity == Quantity::Unspecified && role.axis.empty()) {
      continue;
    }
    const auto [seen, fresh] = owner.insert({{role.quantity, role.axis}, i});
    if (!fresh) {
      return claimed_twice(names[seen->second], names[i], role);
    }
  }
  return {};
}

/// The first names of a file, for an error message.
std::string listed(const ColumnNames& names) {
  constexpr std::size_t kMost = 20;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMost; ++i) {
    text.append(text.empty() ? "" : ", ").append(names[i]);
  }
  return names.size() > kMost ? text.append(", ...") : text;
}

Result<std::vector<std::optional<ColumnRole>>> stated_roles(const RecordingSpec& spec, const ColumnNames& names) {
  std::vector<std::optional<ColumnRole>> roles(names.size());
  for (const auto& [column, role] : spec.columns) {
    const auto found = find_column(names, column);
    if (!found) {
      return fail(found.error());
    }
    const std::size_t place = *found;
    if (auto status = check_role(column, role); !status) {
      return fail(status.error());
    }
    if (roles[place]) {
      return fail(ErrorCode::DuplicateColumn,
                  "The column '" + names[place] + "' is stated twice, by its name and by its number.",
                  {{"column", column}});
    }
    roles[place] = role;
  }
  return roles;
}

/// The roles by name, of a stream's columns by what they are called within it.
std::vector<ColumnRole> infer_roles_within(std::string_view stream, const ColumnNames& names) {
  std::vector<ColumnRole> roles = infer_roles(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto within = name_within(stream, names[i]);
    if (within && roles[i].quantity == Quantity::Unspecified) {
      roles[i] = infer_role(*within);
    }
  }
  return roles;
}

/// Of several columns that look like time, the first whose unit is stated is the time column, else the first.
void keep_one_time_column(std::vector<std::optional<ColumnRole>>& roles) {
  const auto is_time = [](const std::optional<ColumnRole>& role) { return role && role->quantity == Quantity::Time; };
  auto keep = std::find_if(roles.begin(), roles.end(), [&](const auto& role) { return is_time(role) && role->unit; });
  if (keep == roles.end()) {
    keep = std::find_if(roles.begin(), roles.end(), is_time);
  }
  for (auto role = roles.begin(); role != roles.end(); ++role) {
    if (role != keep && is_time(*role)) {
      role->reset();
    }
  }
}

/// Where neither a time column nor a rate is stated: the one column whose name says that it is time in a known unit.
/// Naming the sensors of a file is no reason to lose the time that it has.
void add_time_by_name(const ColumnNames& names, std::vector<std::optional<ColumnRole>>& roles) {
  if (std::any_of(roles.begin(), roles.end(),
                  [](const auto& role) { return role && role->quantity == Quantity::Time; })) {
    return;
  }
  std::vector<std::optional<ColumnRole>> guessed(names.size());
  std::size_t times = 0;
  std::vector<ColumnRole> inferred = infer_roles(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    ColumnRole& role = inferred[i];
    if (!roles[i] && role.quantity == Quantity::Time && role.unit && role.unit->dimension == Dimension::Time) {
      guessed[i] = std::move(role);
      ++times;
    }
  }
  for (std::size_t i = 0; i < names.size() && times == 1; ++i) {
    if (guessed[i]) {
      roles[i] = std::move(guessed[i]);
    }
  }
}

}  // namespace

Result<std::size_t> find_column(const ColumnNames& names, const std::string& column) {
  const auto named = std::find(names.begin(), names.end(), column);
  if (named != names.end()) {
    return static_cast<std::size_t>(named - names.begin());
  }
  const bool digits = !column.empty() && column.size() < 6 &&
                      std::all_of(column.begin(), column.end(), [](char c) { return c >= '0' && c <= '9'; });
  const std::size_t number = digits ? std::stoul(column) : names.size();
  if (number < names.size()) {
    return number;
  }
  return fail(ErrorCode::UnknownColumn, "The file has no column '" + column + "'; it has " + listed(names) + ".",
              {{"column", column}});
}

Status check_role(const std::string& column, const ColumnRole& role) {
  const std::string quantity(name_of(role.quantity));
  const bool axis_fits = role.axis.empty() ? has_no_axis(role.quantity) || role.quantity == Quantity::Unspecified
                                           : is_axis_of(role.axis, role.quantity);
  if (!axis_fits) {
    const std::string what = has_no_axis(role.quantity) ? "takes no axis"
                             : role.axis.empty()        ? "needs an axis"
                                                        : "has no axis '" + role.axis + "'";
    return fail(ErrorCode::InvalidArgument, "Column '" + column + "': " + quantity + " " + what + ".",
                {{"column", column}, {"parameter", "axis"}});
  }
  if (role.unit && !measures(*role.unit, role.quantity)) {
    return fail(ErrorCode::UnitMismatch,
                "Column '" + column + "': the unit " + role.unit->symbol + " does not measure " + quantity + ".",
                {{"column", column}, {"unit", role.unit->symbol}});
  }
  return {};
}

Result<std::vector<std::optional<ColumnRole>>> assign_roles(const RecordingSpec& spec, const ColumnNames& names) {
  if (auto status = check_stream(spec, names); !status) {
    return fail(status.error());
  }
  auto stated = stated_roles(spec, names);
  if (!stated) {
    return stated;
  }
  std::vector<std::optional<ColumnRole>> roles = std::move(*stated);
  if (reads_names(spec)) {
    const bool time_stated = !spec.columns.empty();
    std::vector<ColumnRole> by_name = infer_roles_within(spec.stream, names);
    const std::vector<bool> other = of_other_streams(spec, names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (roles[i] || other[i] || (time_stated && by_name[i].quantity == Quantity::Time)) {
        continue;
      }
      if (auto status = check_bracketed_unit(names[i]); !status) {
        return fail(status.error());
      }
      if (auto status = check_role(names[i], by_name[i]); !status) {
        return fail(status.error());
      }
      roles[i] = std::move(by_name[i]);
    }
    if (!time_stated) {
      keep_one_time_column(roles);
    }
    if (!spec.stream.empty() && !spec.rate_hz) {
      add_time_by_name(names, roles);
    }
  } else if (!spec.rate_hz) {
    add_time_by_name(names, roles);
  }
  if (auto status = check_distinct(names, roles); !status) {
    return fail(status.error());
  }
  return roles;
}

const ChannelQuality* Quality::of(std::string_view column) const {
  const auto found = std::find_if(channels.begin(), channels.end(),
                                  [&](const ChannelQuality& channel) { return channel.column == column; });
  return found == channels.end() ? nullptr : &*found;
}

std::size_t frozen_samples(const Quality& quality, std::string_view column) {
  const ChannelQuality* const channel = quality.of(column);
  return channel == nullptr ? 0 : channel->frozen;
}

}  // namespace driftlab
