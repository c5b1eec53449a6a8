#include "core/export/exportable_columns.hpp"

#include "core/campaign/words.hpp"

#include <algorithm>
#include <iterator>
#include <optional>

namespace driftlab {
namespace {

std::optional<Dimension> wanted_of(Quantity quantity) {
  return quantity == Quantity::AngularRate     ? std::optional(Dimension::AngularRate)
         : quantity == Quantity::SpecificForce ? std::optional(Dimension::SpecificForce)
                                               : std::nullopt;
}

/// "columns gx and gy have no unit of their sensor; say which, for example --columns gx=angular_rate:x:deg/s,…", of
/// those that lack it.
std::string units_wanted(const std::vector<ExportColumn>& columns) {
  std::vector<std::string> names;
  std::string repair;
  for (const ExportColumn& column : columns) {
    if (wanted_of(column.quantity) && !column.exportable()) {
      names.push_back(column.name);
      repair += (repair.empty() ? "" : ",") + column.name + "=" + std::string(name_of(column.quantity)) + ":" +
                (column.axis.empty() ? "x" : column.axis) +
                (column.quantity == Quantity::AngularRate ? ":deg/s" : ":m/s^2");
    }
  }
  if (names.empty()) {
    return "";
  }
  const bool one = names.size() == 1;
  return std::string(one ? "column " : "columns ") + joined(names) +
         (one ? " has no unit of its sensor" : " have no unit of their sensor") +
         "; say which, for example --columns " + repair + ".";
}

/// " (there are a, b and c)", of many the first.
std::string names_in_brackets(const std::vector<ExportColumn>& columns) {
  constexpr std::size_t kShown = 6;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(columns.size(), kShown); ++i) {
    names.push_back(columns[i].name);
  }
  if (columns.size() > kShown) {
    names.push_back(std::to_string(columns.size() - kShown) + " more");
  }
  return names.empty() ? "" : " (there are " + joined(names) + ")";
}

}  // namespace

bool ExportColumn::exportable() const { return wanted_of(quantity) == dimension; }

Status check_exportable(const std::vector<ExportColumn>& columns) {
  if (std::any_of(columns.begin(), columns.end(), [](const ExportColumn& column) { return column.exportable(); })) {
    return {};
  }
  std::string why = units_wanted(columns);
  if (why.empty()) {
    why = "no column is known to be an axis of a gyroscope or an accelerometer" + names_in_brackets(columns) +
          "; say which are, for example --columns 0=angular_rate:z:deg/s.";
  }
  return fail(ErrorCode::NotFound, "There is nothing to export: " + why);
}

std::string missing_units(const std::vector<ExportColumn>& columns, Quantity quantity) {
  std::vector<ExportColumn> own;
  std::copy_if(columns.begin(), columns.end(), std::back_inserter(own),
               [&](const ExportColumn& column) { return column.quantity == quantity; });
  return capital(units_wanted(own));
}

}  // namespace driftlab
