#include "core/export/exportable_columns.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

ExportColumn column(const std::string& name, Quantity quantity, const std::string& axis, Dimension dimension) {
  return {name, quantity, axis, dimension};
}

std::string refusal(const std::vector<ExportColumn>& columns) {
  const Status checked = check_exportable(columns);
  return checked ? "" : checked.error().message;
}

TEST(ExportableColumns, OneAxisInAUnitOfItsSensorIsEnough) {
  EXPECT_EQ(refusal({column("t", Quantity::Time, "", Dimension::Time),
                     column("gz", Quantity::AngularRate, "z", Dimension::AngularRate),
                     column("ax", Quantity::SpecificForce, "x", Dimension::One)}),
            "");
}

TEST(ExportableColumns, NamesColumnsWithoutAUnitInOneSentenceWithARepairToCopy) {
  const std::vector<ExportColumn> columns{column("gx", Quantity::AngularRate, "x", Dimension::One),
                                          column("temp", Quantity::Temperature, "", Dimension::Temperature),
                                          column("az", Quantity::SpecificForce, "z", Dimension::One)};
  EXPECT_EQ(
      refusal(columns),
      "There is nothing to export: columns gx and az have no unit of their sensor; say which, for example --columns "
      "gx=angular_rate:x:deg/s,az=specific_force:z:m/s^2.");
  EXPECT_EQ(missing_units(columns, Quantity::AngularRate),
            "Column gx has no unit of its sensor; say which, for example --columns gx=angular_rate:x:deg/s.");
  EXPECT_EQ(missing_units({}, Quantity::AngularRate), "");
}

TEST(ExportableColumns, SaysWhichColumnsThereAreWhereNoneIsKnown) {
  std::vector<ExportColumn> columns;
  for (const char* const name : {"a", "b", "c", "d", "e", "f", "g", "h"}) {
    columns.push_back(column(name, Quantity::Unspecified, "", Dimension::One));
  }
  EXPECT_EQ(
      refusal(columns),
      "There is nothing to export: no column is known to be an axis of a gyroscope or an accelerometer (there are "
      "a, b, c, d, e, f and 2 more); say which are, for example --columns 0=angular_rate:z:deg/s.");
  EXPECT_NE(refusal({}), "");
}

}  // namespace
}  // namespace driftlab
