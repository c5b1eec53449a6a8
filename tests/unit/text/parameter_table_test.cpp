#include "schema/text/parameter_table.hpp"

#include "schema/text/in_print.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

TableCell cell(std::optional<double> value, std::optional<double> low = {}, std::optional<double> high = {},
               std::optional<Change> change = {}) {
  return {{value, low, high, "deg/sqrt(h)", ""}, change};
}

TableRow row(std::string label, std::vector<std::string> recordings, const TableCell& n) {
  TableRow made;
  made.label = std::move(label);
  made.recordings = std::move(recordings);
  made.cells = {n, cell({}), cell({})};
  return made;
}

ParameterTable table(std::vector<TableRow> rows) {
  return {"phone-07",
          Quantity::AngularRate,
          "z",
          TableMethod::Av,
          "",
          {{"N", "deg/sqrt(h)"}, {"B", "deg/h"}, {"K", "deg/h/sqrt(h)"}},
          std::move(rows)};
}

TEST(TableCsv, QuotesWhatNeedsItAndLeavesUnknownCellsEmpty) {
  EXPECT_EQ(table_to_csv(table({row("9 deg/s, \"about\" z", {"rec_a", "rec_b"}, cell(0.1, {}, 0.3))})),
            "condition,recordings,N [deg/sqrt(h)],N low [deg/sqrt(h)],N high [deg/sqrt(h)],B [deg/h],B low [deg/h],"
            "B high [deg/h],K [deg/h/sqrt(h)],K low [deg/h/sqrt(h)],K high [deg/h/sqrt(h)]\r\n"
            "\"9 deg/s, \"\"about\"\" z\",rec_a rec_b,0.1,,0.3,,,,,,\r\n");
}

TEST(TableText, AlignsColumnsWhateverCharactersTheyHold) {
  const ParameterTable found =
      table({row("static", {"rec_a"}, cell(1.0, 0.95, 1.05)), row("9 deg/s about z", {"rec_b"}, cell(1234.6, 1200.0)),
             row("40 deg/s about z", {"rec_c"}, cell(2.0, 1.9, 2.1, Change::Up))});
  EXPECT_EQ(table_to_text(found),
            "phone-07, gyroscope z, Allan variance (value [95 % interval]; … not identifiable; ↑ ↓ changed against the "
            "first row)\n\n"
            "condition         N                       B      K\n"
            "                  deg/sqrt(h)             deg/h  deg/h/sqrt(h)\n"
            "----------------  ----------------------  -----  -------------\n"
            "static            1.000 [0.9500, 1.050]   …      …\n"
            "9 deg/s about z   1235 [1200, …]          …      …\n"
            "40 deg/s about z  2.000 [1.900, 2.100] ↑  …      …\n");
}

TEST(TableText, InPrintHasTheNamesAndUnitsOfTheFieldUnderTheSameRules) {
  ParameterTable found = table({row("static", {"rec_a"}, cell(1.0, 0.95, 1.05))});
  found.columns = {{"white_noise.N", "deg/sqrt(h)"}, {"gauss_markov_1.sigma", "deg/h"}, {"gauss_markov_1.beta", "1/s"}};
  EXPECT_EQ(table_to_text(in_print(found), false),
            "phone-07, gyroscope z, Allan variance\n\n"
            "condition  white noise N          Gauss-Markov σ  Gauss-Markov β\n"
            "           deg/√h                 deg/h           1/s\n"
            "---------  ---------------------  --------------  --------------\n"
            "static     1.000 [0.9500, 1.050]  …               …\n");
}

TEST(TableText, NamesTheRowThatChangesAreAgainst) {
  ParameterTable found = table({row("static", {"rec_a"}, cell(1.0, 0.95, 1.05, Change::Down)),
                                row("9 deg/s about z", {"rec_b"}, cell(2.0, 1.9, 2.1))});
  found.reference = 1;
  EXPECT_NE(table_to_text(found).find("changed against 9 deg/s about z)"), std::string::npos);
  EXPECT_NE(table_to_markdown(found).find("changed against 9 deg/s about z)"), std::string::npos);
}

TEST(TableLatex, IsATabularWithTheDigitsOfTheIntervals) {
  ParameterTable found = table({row("static", {"rec_a"}, cell(1.0382, 1.0347, 1.0417)),
                                row("9 deg/s & more_", {"rec_b"}, cell(3.2e-5, 3.1e-5, {}, Change::Up))});
  found.device = "phone_07";
  EXPECT_EQ(
      table_to_latex(found),
      "% \\usepackage{booktabs}\n\\begin{table}\n\\centering\n"
      "\\caption{phone\\_07, gyroscope $z$, Allan variance: value and 95\\,\\% interval; $\\uparrow$ $\\downarrow$ "
      "changed against static; \\dots{} not identifiable.}\n"
      "\\begin{tabular}{llll}\n\\toprule\n"
      "condition & N [deg/sqrt(h)] & B [deg/h] & K [deg/h/sqrt(h)] \\\\\n\\midrule\n"
      "static & $1.038\\;[1.035,\\,1.042]$ & \\dots & \\dots \\\\\n"
      "9 deg/s \\& more\\_ & $3.20\\cdot 10^{-5}\\;[3.10\\cdot 10^{-5},\\,\\infty]\\,\\uparrow$ & \\dots & \\dots "
      "\\\\\n"
      "\\bottomrule\n\\end{tabular}\n\\end{table}\n");
}

TEST(TableText, PutsTheDataSheetBelowTheRowsAndTheRatioBelowTheTable) {
  ParameterTable found = table({row("static", {"rec_a"}, cell(1.0, 0.95, 1.05))});
  found.data_sheet =
      SheetComparison{"MPU-6050",
                      "InvenSense PS-MPU-6000A-00, revision 3.4, section 6.1",
                      "static",
                      {{"N", 0.5, "deg/sqrt(h)", cell(1.0, 0.95, 1.05).estimate, 2.0, 1.9, 2.1, SheetVerdict::Above}}};
  const std::string text = table_to_text(found, false);
  EXPECT_NE(text.find("static      1.000 [0.9500, 1.050]  …      …\ndata sheet  0.5000\n"), std::string::npos) << text;
  EXPECT_NE(
      text.find("= static: N is 2.00 times the 0.500 deg/sqrt(h) of its data sheet: above it. MPU-6050: InvenSense"),
      std::string::npos)
      << text;
  EXPECT_NE(table_to_csv(found).find("\r\ndata sheet,\"MPU-6050: InvenSense PS-MPU-6000A-00, revision 3.4, section "
                                     "6.1\",0.5,,,,,,,,\r\n"),
            std::string::npos);
  EXPECT_NE(table_to_markdown(found).find("\n- static: N is 2.00 times"), std::string::npos);
}

TEST(TableText, PutsTheLowFrequencyDensityBeforeTheParametersOfAModel) {
  ParameterTable found = table({row("static", {"rec_a"}, cell(1.0, 0.95, 1.05)), row("drive", {"rec_b"}, cell(2.0))});
  found.method = TableMethod::Gmwm;
  found.model = "WN";
  found.columns = {{"white_noise.N", "deg/sqrt(h)"}};
  for (TableRow& one : found.rows) {
    one.cells.resize(1);
  }
  found.rows[0].density = cell(1.2, 1.1, 1.3);
  EXPECT_EQ(table_to_text(found),
            "phone-07, gyroscope z, GMWM, model WN (value [95 % interval]; … not identifiable; ↑ ↓ changed against the "
            "first row)\n\n"
            "condition  N                     white_noise.N\n"
            "           deg/sqrt(h)           deg/sqrt(h)\n"
            "---------  --------------------  ---------------------\n"
            "static     1.200 [1.100, 1.300]  1.000 [0.9500, 1.050]\n"
            "drive      …                     2.000 […, …]\n");
  EXPECT_EQ(table_to_csv(found),
            "condition,recordings,N [deg/sqrt(h)],N low [deg/sqrt(h)],N high [deg/sqrt(h)],white_noise.N [deg/sqrt(h)],"
            "white_noise.N low [deg/sqrt(h)],white_noise.N high [deg/sqrt(h)]\r\n"
            "static,rec_a,1.2,1.1,1.3,1,0.95,1.05\r\n"
            "drive,rec_b,,,,2,,\r\n");
}

TEST(TableText, SaysBelowWhatSpeaksAgainstARow) {
  ParameterTable found = table({row("static", {"a", "b"}, cell(1.0)), row("drive", {"c"}, cell(1.0))});
  found.rows[0].contamination = "contaminated";
  found.rows[0].robust = true;
  found.rows[0].agreement = RecordingAgreement{"WN", 9.0, 1.0, 0.0027};
  found.rows[1].contamination = "clean";
  found.rows[1].warnings = {"The model does not fit."};
  const std::string text = table_to_text(found);
  EXPECT_NE(text.find("\nstatic *"), std::string::npos);
  EXPECT_NE(text.find("! static: gross errors move the variances of this recording; the values are from robust "
                      "variances.\n! static: its recordings disagree (p = 0.002700);"),
            std::string::npos);
  EXPECT_NE(text.find("! drive: The model does not fit.\n"), std::string::npos);
  EXPECT_EQ(text.find("! drive: gross errors"), std::string::npos);
  const std::string markdown = table_to_markdown(found);
  EXPECT_NE(markdown.find("| static * |"), std::string::npos);
  EXPECT_NE(markdown.find("\n- drive: The model does not fit.\n"), std::string::npos);
}

}  // namespace
}  // namespace driftlab
