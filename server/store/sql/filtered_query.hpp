#pragma once
/// Lists: a SELECT that grows by what a filter asks for and by what its caller may see, and is read a page at a time.
#include "core/signal/text.hpp"
#include "server/store/sql/read_rows.hpp"
#include "server/store/store.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace driftlab::server::tables {

/// The jobs that a caller limited to devices sees: those asked for by its token (first value), and those that name only
/// devices of its list (second value, a JSON list of names).
constexpr std::string_view kVisibleJob =
    "(EXISTS (SELECT 1 FROM owners WHERE object_id = jobs.id AND token_id = ?) OR (EXISTS (SELECT 1 FROM job_devices "
    "WHERE job_id = jobs.id) AND NOT EXISTS (SELECT 1 FROM job_devices JOIN devices ON devices.id = "
    "job_devices.device_id WHERE job_id = jobs.id AND devices.name NOT IN (SELECT value FROM json_each(?)))))";

/// Of verdicts: all but those on a device among the others of its model (server/jobs/line_verdicts.hpp), which would
/// tell a caller limited to devices of those that it does not see.
constexpr std::string_view kNotOfLine = "(recording_id IS NOT NULL OR channel = '')";

/// A SELECT with those conditions that a filter asks for. Texts are constants of our own; values are bound.
class FilteredQuery {
 public:
  explicit FilteredQuery(std::string_view select) : sql_(select) {}
  /// Adds `condition`, for example "device_id = ?", if there is a value.
  void where(std::string_view condition, const std::optional<std::string>& value) {
    if (value) {
      where(condition);
      values_.push_back(*value);
    }
  }
  /// Rows of one value, if there is a value, where an index of (column, id) has them one behind the other. The only
  /// such column leads the order of the page with PostgreSQL. Ordered by the id alone its plan may walk all rows of the
  /// table in the hope that those of the value stand everywhere among them; rows of a campaign do not.
  void along(std::string_view column, const std::optional<std::string>& value) {
    if (value) {
      along_.emplace_back(column, *value);
    }
  }
  /// Rows made at that time or later: their ids, which begin with `prefix`, say when.
  void made_since(std::string_view prefix, const std::optional<UtcMicros>& since) {
    where("id >= ?", since ? std::optional(first_id(prefix, *since)) : std::nullopt);
  }
  /// Keeps rows whose `columns` contain a text, in upper or lower case of ASCII letters. The pattern, in which any
  /// character stands for one that patterns are made of, lets an index of trigrams find them.
  void holds(std::string_view columns, const std::optional<std::string>& text) {
    const std::string lower = "lower(" + std::string(columns) + ")";
    by_values_ = by_values_ || text;
    where(lower + " LIKE ?", text ? std::optional(pattern_of(*text)) : std::nullopt);
    where("instr(" + lower + ", lower(?)) > 0", text);
  }
  void where(std::string_view condition) {
    sql_.append(first_ ? " WHERE " : " AND ").append(condition);
    first_ = false;
  }
  /// For a caller limited to devices (Page::visible), keeps the rows that belong to one of them. `column` holds the
  /// device's id. A page for such a caller is read only after this call or one of its variants below.
  FilteredQuery& visible(const Page& page, std::string_view column) {
    if (page.visible) {
      where(std::string(column) + " IN (SELECT id FROM devices WHERE name IN (SELECT value FROM json_each(?)))",
            page.visible->devices_json);
    }
    guarded_ = true;
    return *this;
  }
  /// The same for objects that may belong to no device: who asked for one sees it too.
  FilteredQuery& visible_or_own(const Page& page, std::string_view column, std::string_view id) {
    if (page.visible) {
      where("(" + std::string(column) +
                " IN (SELECT id FROM devices WHERE name IN (SELECT value FROM json_each(?))) OR EXISTS (SELECT 1 FROM "
                "owners WHERE object_id = " +
                std::string(id) + " AND token_id = ?))",
            page.visible->devices_json);
      values_.push_back(page.visible->token);
    }
    guarded_ = true;
    return *this;
  }
  /// The same for jobs, which name any number of devices.
  FilteredQuery& visible_jobs(const Page& page) {
    if (page.visible) {
      where(kVisibleJob, page.visible->token);
      values_.push_back(page.visible->devices_json);
    }
    guarded_ = true;
    return *this;
  }
  /// Ends the query as a keyset page over `id` and reads it. Errors: Internal where the page is for a caller limited to
  /// devices and the query does not say what such a caller sees.
  template <class Read>
  [[nodiscard]] Result<std::vector<RowOf<Read>>> read_page(Connection& connection, const Page& page,
                                                           Read (*read)(const Statement&)) {
    if (page.visible && !guarded_) {
      return fail(ErrorCode::Internal, "A list does not say what a token limited to devices sees of it.");
    }
    const bool has_lead =
        along_.size() == 1 && page.order != PageOrder::ByName && connection.engine() == Engine::Postgres;
    for (const auto& [column, value] : along_) {
      if (!has_lead) {
        where(column + " = ?", value);
      }
    }
    switch (page.order) {
      case PageOrder::OldestFirst:
        order_by_id(page.after, " > ", "", has_lead);
        break;
      case PageOrder::NewestFirst:
        order_by_id(page.after, " < ", " DESC", has_lead);
        break;
      case PageOrder::ByName:
        if (!page.after.empty()) {
          where("(name, id) > (?, ?)", page.after_name);
          values_.push_back(page.after);
        }
        sql_.append(" ORDER BY name, id");
        break;
    }
    sql_.append(" LIMIT ?");
    if (by_values_) {
      Statement planned = connection.prepare(kPlanByValues);
      if (const Status set = planned.run(); !set) {
        return fail(set.error());
      }
    }
    Statement statement = connection.prepare(sql_);
    for (const std::string& value : values_) {
      statement.bind(value);
    }
    statement.bind(page.limit);
    return all_rows(statement, read);
  }

 private:
  /// What comes behind the last row of the page before, if there was one, by the leading column and the id.
  void order_by_id(const std::string& after, std::string_view behind, std::string_view direction, bool has_lead) {
    std::string key = "id";
    std::string order = key;
    std::string last = "?";
    if (has_lead) {
      const auto& [column, value] = along_.front();
      where(column + " >= ?", value);
      where(column + " <= ?", value);  // were it said to be equal, it would be left out of the order
      key = "(" + column + ", id)";
      order = column + std::string(direction) + ", id";
      last = "(?, ?)";
    }
    if (!after.empty()) {
      where(key + std::string(behind) + last);
      if (has_lead) {
        values_.push_back(along_.front().second);
      }
      values_.push_back(after);
    }
    sql_.append(" ORDER BY ").append(order).append(direction);
  }

  [[nodiscard]] static std::string pattern_of(std::string_view text) {
    std::string pattern = "%" + lower_case(text) + "%";
    std::replace_if(
        pattern.begin() + 1, pattern.end() - 1, [](char c) { return c == '%' || c == '_' || c == '\\'; }, '_');
    return pattern;
  }

  /// Whether an index of trigrams finds few rows or the page is soon full by itself depends on what is sought: for this
  /// transaction PostgreSQL plans by the values, where it would take to one plan for all after five times.
  static constexpr EngineTexts kPlanByValues{"SELECT 1",
                                             "SELECT set_config('plan_cache_mode', 'force_custom_plan', true)"};

  std::string sql_;
  std::vector<std::string> values_;
  std::vector<std::pair<std::string, std::string>> along_;  ///< columns and the values that they equal
  bool by_values_ = false;
  bool first_ = true;
  bool guarded_ = false;
};

}  // namespace driftlab::server::tables
