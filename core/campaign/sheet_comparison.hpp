#pragma once
/// Comparison of the measured parameters of a sensor axis with its data sheet.
///
/// Data sheets state typical values of many sensors, so a measured one agrees where its 95 % interval reaches within a
/// factor 1.5 of the stated figure; otherwise it is above or below. Compared are N, the density at low frequencies that
/// every row has, with the stated random walk or density (core/datasheet/data_sheet.hpp says which), and, where a table
/// has it, B with the stated in-run bias stability. Data sheets state the least Allan deviation, which flicker noise of
/// coefficient B has at sqrt(2 ln 2 / pi) B = 0.664 B (IEEE Std 952, C.1.3), so the stated figure over 0.664 stands
/// beside B.
#include "core/campaign/reported_channel.hpp"
#include "core/datasheet/data_sheet.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace driftlab {

enum class SheetVerdict { Agrees, Above, Below };

/// `agrees`, `above`, `below`.
[[nodiscard]] std::string_view name_of(SheetVerdict verdict);

struct SheetFigure {
  std::string parameter;        ///< `N`, `B`
  double stated = 0.0;          ///< comparable to the measured one
  std::string unit;             ///< of both
  ReportedValue measured;       ///< of the row that is compared
  std::optional<double> ratio;  ///< measured over stated; empty: not measured
  std::optional<double> ratio_low;
  std::optional<double> ratio_high;
  std::optional<SheetVerdict> verdict;
};

struct SheetComparison {
  std::string sensor;     ///< `MPU-6050`
  std::string source;     ///< document with revision and table
  std::string condition;  ///< of the row that is compared, for people
  std::vector<SheetFigure> figures;
};

/// `density`: N. `flicker`: B, or nullptr where a table has none. Values in other units than `lab_unit` gives are left
/// out, and so is what the data sheet does not state; nothing where no figure is left.
[[nodiscard]] std::optional<SheetComparison> compare_with_sheet(const KnownSensor& known, std::string_view axis,
                                                                const std::string& condition,
                                                                const ReportedValue& density,
                                                                const ReportedValue* flicker);

/// `N is 1.2 times the 0.3 deg/sqrt(h) of its data sheet`: a figure in words, without the end of the sentence.
[[nodiscard]] std::string sentence_of(const SheetFigure& figure);

}  // namespace driftlab
