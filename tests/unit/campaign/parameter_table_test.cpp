#include "core/campaign/parameter_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace driftlab {
namespace {

ReportedValue cell(double value, std::optional<double> low, std::optional<double> high) {
  return {value, low, high, "deg/sqrt(h)", ""};
}

ReportedValue none(const char* reason) { return {{}, {}, {}, "", reason}; }

/// A channel that was fitted with WN and WN+GM: `n` is N of both, `wic` their criteria.
ReportedChannel channel(const ReportedValue& n, double wic_wn, double wic_gm,
                        const ReportedValue& beta = none("No beta.")) {
  const ReportedProcess white{"white_noise", {{"N", n}}};
  const ReportedProcess markov{"gauss_markov", {{"sigma", none("No sigma.")}, {"beta", beta}}};
  ReportedChannel made;
  made.unit = "deg/s";
  made.allan = {{"N", n}, {"B", none("No B.")}, {"K", none("No K.")}, {"Q", none("")}, {"R", none("")}};
  made.fits.resize(2);
  made.fits[0].model = "WN";
  made.fits[0].wic = wic_wn;
  made.fits[0].processes = {white};
  made.fits[1].model = "WN+GM";
  made.fits[1].wic = wic_gm;
  made.fits[1].processes = {white, markov};
  return made;
}

TableRequest request(TableMethod method = TableMethod::Gmwm, std::string model = "") {
  return {"phone-07", Quantity::AngularRate, "z", method, std::move(model)};
}

ParameterTable table(const TableRequest& wanted, const std::vector<TableSource>& sources) {
  auto built = build_parameter_table(wanted, sources);
  EXPECT_TRUE(built) << built.error().message;
  return built ? *built : ParameterTable{};
}

TEST(ParameterTable, PutsStaticFirstThenRatesBySize) {
  const ReportedValue n = cell(1.0, 0.9, 1.1);
  const ParameterTable found = table(request(), {{"rec_a", "constant_rate:z:40:deg/s", channel(n, 1, 2)},
                                                 {"rec_b", "constant_rate:z:9:deg/s", channel(n, 1, 2)},
                                                 {"rec_c", "static", channel(n, 1, 2)}});
  ASSERT_EQ(found.rows.size(), 3U);
  EXPECT_EQ(found.rows[0].label, "static");
  EXPECT_EQ(found.rows[1].label, "9 deg/s about z");
  EXPECT_EQ(found.rows[2].recordings, std::vector<std::string>{"rec_a"});
}

TEST(ParameterTable, ShowsTheModelWithTheSmallestSumOfTheCriterion) {
  const ReportedValue n = cell(1.0, 0.9, 1.1);
  // WN wins one row by 1, WN+GM the other by 5.
  const std::vector<TableSource> sources{{"rec_a", "static", channel(n, 1, 2)}, {"rec_b", "drive", channel(n, 9, 4)}};
  EXPECT_EQ(table(request(), sources).model, "WN+GM");
  EXPECT_EQ(table(request(TableMethod::Gmwm, "WN"), sources).model, "WN");
  EXPECT_EQ(table(request(TableMethod::Av), sources).model, "");
}

TEST(ParameterTable, PoolsReplicatesOnTheLogScale) {
  // Half-widths ln 1.1 and ln 1.21 = 2 ln 1.1: weights 4 to 1, so the mean log is (4 ln 1 + ln 2)/5 = ln 2 / 5.
  const ParameterTable found =
      table(request(TableMethod::Av), {{"rec_a", "static", channel(cell(1.0, 1.0 / 1.1, 1.1), 1, 2)},
                                       {"rec_b", "static", channel(cell(2.0, 2.0 / 1.21, 2.42), 1, 2)}});
  ASSERT_EQ(found.rows.size(), 1U);
  const ReportedValue& pooled = found.rows[0].cells[0].estimate;
  const double h = std::log(1.1);
  const double half = 1.0 / std::sqrt(1.0 / (h * h) + 1.0 / (4.0 * h * h));
  EXPECT_NEAR(*pooled.value, std::exp(std::log(2.0) / 5.0), 1e-12);
  EXPECT_NEAR(std::log(*pooled.high / *pooled.value), half, 1e-12);
  EXPECT_EQ(found.rows[0].recordings.size(), 2U);
}

TEST(ParameterTable, TellsWhatSpeaksAgainstARow) {
  // The worst verdict of the replicates stands for the row; a warning that both fits give is said once.
  ReportedChannel sound = channel(cell(1.0, 0.9, 1.1), 1, 2);
  sound.contamination = "clean";
  sound.fits[0].warnings = {"The model does not fit."};
  ReportedChannel spoiled = sound;
  spoiled.contamination = "contaminated";
  const ParameterTable found =
      table(request(), {{"rec_a", "static", sound}, {"rec_b", "static", spoiled}, {"rec_c", "drive", sound}});
  EXPECT_EQ(found.rows[0].contamination, "contaminated");
  EXPECT_EQ(found.rows[0].warnings, std::vector<std::string>{"The model does not fit."});
  EXPECT_EQ(found.rows[1].contamination, "clean");
}

TEST(ParameterTable, MarksChangesAgainstTheFirstRow) {
  const auto row = [](const char* condition, double value) {
    return TableSource{"rec", condition, channel(cell(value, value / 1.05, value * 1.05), 1, 2)};
  };
  const ParameterTable found =
      table(request(TableMethod::Av), {row("static", 1.0), row("constant_rate:z:1:deg/s", 1.06),
                                       row("constant_rate:z:2:deg/s", 1.08), row("constant_rate:z:3:deg/s", 0.9)});
  // Two half-widths ln 1.05 make sqrt(2) ln 1.05 = ln 1.0714: 1.06 is within, 1.08 and 0.9 are beyond.
  const Change wanted[] = {Change::None, Change::Up, Change::Down};
  EXPECT_EQ(found.rows[0].cells[0].change, std::nullopt);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found.rows[i + 1].cells[0].change, wanted[i]);
  }
}

TEST(ParameterTable, ComparesWithTheRowAskedFor) {
  const auto row = [](const char* condition, double value) {
    return TableSource{"rec", condition, channel(cell(value, value / 1.05, value * 1.05), 1, 2)};
  };
  const std::vector<TableSource> sources{row("static", 1.0), row("constant_rate:z:1:deg/s", 2.0)};
  TableRequest wanted = request(TableMethod::Av);
  const ReportedValue up = table(wanted, sources).rows[1].cells[0].ratio;
  // Half-widths of ln 1.05 each make sqrt(2) ln 1.05 for the ratio.
  const double factor = std::exp(std::sqrt(2.0) * std::log(1.05));
  EXPECT_NEAR(*up.value, 2.0, 1e-12);
  EXPECT_NEAR(*up.low, 2.0 / factor, 1e-12);
  EXPECT_NEAR(*up.high, 2.0 * factor, 1e-12);
  EXPECT_EQ(up.unit, "1");
  wanted.reference = parse_condition("constant_rate:z:1:deg/s").value();
  const ParameterTable against = table(wanted, sources);
  EXPECT_EQ(against.reference, 1U);
  EXPECT_EQ(against.rows[0].cells[0].change, Change::Down);
  EXPECT_NEAR(*against.rows[0].cells[0].ratio.value, 0.5, 1e-12);
  EXPECT_EQ(against.rows[0].density.change, Change::Down);
  EXPECT_EQ(against.rows[1].cells[0].change, std::nullopt);
  EXPECT_EQ(against.rows[1].cells[0].ratio.value, std::nullopt);
  wanted.reference = parse_condition("constant_rate:z:2:deg/s").value();
  const auto refused = build_parameter_table(wanted, sources);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().fields[0], (ErrorField{"parameter", "reference"}));
  EXPECT_NE(refused.error().message.find("static, constant_rate:z:1:deg/s"), std::string::npos);
}

TEST(ParameterTable, GivesARatioWithoutIntervalWhereAnIntervalIsOpenAndNoneWithoutAValue) {
  const ReportedValue open = ratio_of(cell(3.0, {}, 4.0), cell(2.0, 1.9, 2.1));
  EXPECT_EQ(open.value, 1.5);
  EXPECT_FALSE(open.low || open.high);
  EXPECT_FALSE(ratio_of(none("No."), cell(2.0, 1.9, 2.1)).value);
  EXPECT_FALSE(ratio_of(cell(2.0, 1.9, 2.1), cell(0.0, {}, 1.0)).value);
}

TEST(ParameterTable, SaysOfEachRowHowLongItIsAndWhetherItsOneFitStands) {
  ReportedChannel one = channel(cell(1.0, 0.9, 1.1), 1, 2);
  one.samples = 2000;
  one.dt_s = 0.01;
  one.fits[0].j_test = JTest{3.0, 5.0, 0.25};
  const ParameterTable found = table(request(), {{"a", "static", one}, {"b", "drive", one}, {"c", "drive", one}});
  EXPECT_NEAR(found.rows[0].duration_s, 20.0, 1e-12);
  EXPECT_EQ(found.rows[0].j_test_p, 0.25);
  EXPECT_EQ(found.rows[0].fits(), true);
  EXPECT_NEAR(found.rows[1].duration_s, 40.0, 1e-12);
  EXPECT_EQ(found.rows[1].j_test_p, std::nullopt) << "two fits averaged are no fit";
  EXPECT_EQ(found.rows[1].fits(), std::nullopt);
  EXPECT_EQ(table(request(TableMethod::Av), {{"a", "static", one}}).rows[0].j_test_p, std::nullopt);
}

TEST(ParameterTable, SaysWhyItsModelIsNotTheOneOfTheStructure) {
  PooledSensor pooled;
  pooled.model = "WN";
  for (const char* const condition : {"static", "drive"}) {
    PooledCondition entry;
    entry.key = condition;
    entry.members = {condition == std::string("static") ? "a" : "b"};
    pooled.conditions.push_back(entry);
  }
  pooled.structure = PooledStructure{
      "one_structure", "One structure, WN+GM, describes every condition.", 0.3, 9, 8, "WN+GM", 0.0, {}, {}};
  const ReportedChannel made = channel(cell(1.0, 0.9, 1.1), 1, 2);
  const std::vector<TableSource> sources{{"a", "static", made}, {"b", "drive", made}};
  const auto noted = [&](TableRequest wanted, const std::vector<TableSource>& from) {
    return build_parameter_table(wanted, from, &pooled)->model_note;
  };
  EXPECT_EQ(
      noted(request(), sources),
      "The table shows WN, whose criterion summed over the conditions is the least; WN+GM is the smallest structure "
      "that, whole or in part, comes close to the best in each condition by itself.");
  EXPECT_NE(noted(request(TableMethod::Gmwm, "WN"), sources).find("WN, as was asked; WN+GM"), std::string::npos);
  EXPECT_EQ(noted(request(TableMethod::Gmwm, "WN+GM"), sources), "") << "they are one";
  EXPECT_EQ(noted(request(TableMethod::Av), sources), "");
  EXPECT_EQ(noted(request(), {{"c", "static", made}}), "") << "of other recordings the pooled result says nothing";
}

TEST(ParameterTable, TellsNothingFoundFromNothingIdentified) {
  EXPECT_EQ(absence_of("The data show no random walk: the best fit has none of it."), Absence::NoneFound);
  EXPECT_EQ(absence_of("Not identifiable: the data are compatible with no random walk at all."),
            Absence::NotIdentifiable);
}

TEST(ParameterTable, GivesTheReasonForWhatIsNotIdentified) {
  const ParameterTable found = table(request(TableMethod::Gmwm, "WN+GM"),
                                     {{"rec_a", "static", channel(none("No white noise."), 1, 2, cell(1.0, 0.5, {}))}});
  ASSERT_EQ(found.columns[2].key, "gauss_markov_1.beta");
  const std::vector<TableCell>& cells = found.rows[0].cells;
  EXPECT_FALSE(cells[0].estimate.value);
  EXPECT_EQ(cells[0].estimate.reason, "No white noise.");
  EXPECT_FALSE(cells[1].estimate.value);
  EXPECT_EQ(cells[2].estimate.low, 0.5);
  EXPECT_EQ(cells[2].estimate.high, std::nullopt);
}

TEST(ParameterTable, GivesTheUnitOfAColumnThatNoRowIdentifies) {
  const auto units = [](TableMethod method) {
    const ParameterTable found = table(request(method, method == TableMethod::Gmwm ? "WN+GM" : ""),
                                       {{"rec_a", "static", channel(none("No white noise."), 1, 2)}});
    std::map<std::string, std::string> of_key;
    for (const TableColumn& column : found.columns) {
      of_key[column.key] = column.unit;
    }
    return of_key;
  };
  using Units = std::map<std::string, std::string>;
  EXPECT_EQ(units(TableMethod::Av), (Units{{"N", "deg/sqrt(h)"}, {"B", "deg/h"}, {"K", "deg/h/sqrt(h)"}}));
  EXPECT_EQ(
      units(TableMethod::Gmwm),
      (Units{{"white_noise.N", "deg/sqrt(h)"}, {"gauss_markov_1.sigma", "deg/h"}, {"gauss_markov_1.beta", "1/s"}}));
}

TEST(ParameterTable, LeavesOutQuantizationAndRampWhereNobodyHasThem) {
  const ParameterTable found = table(request(TableMethod::Av), {{"rec_a", "static", channel(cell(1, 0.9, 1.1), 1, 2)}});
  std::vector<std::string> keys;
  for (const TableColumn& column : found.columns) {
    keys.push_back(column.key);
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"N", "B", "K"}));
}

TEST(ParameterTable, RefusesWhatCannotBeShown) {
  EXPECT_EQ(build_parameter_table(request(), {}).error().code, ErrorCode::NotFound);
  const std::vector<TableSource> sources{{"rec_a", "static", channel(cell(1, 0.9, 1.1), 1, 2)}};
  const auto unknown = build_parameter_table(request(TableMethod::Gmwm, "WN+2GM"), sources);
  ASSERT_FALSE(unknown);
  EXPECT_EQ(unknown.error().fields[0], (ErrorField{"parameter", "model"}));
  EXPECT_EQ(parse_table_method("ml").error().fields[0], (ErrorField{"parameter", "method"}));
  EXPECT_EQ(parse_table_method(name_of(TableMethod::Av)).value(), TableMethod::Av);
}

TEST(ParameterTable, ShowsTheLowFrequencyDensityWhateverTheModel) {
  // Story: the interval of the white noise of a rejected model excluded that of the Allan variance without a remark.
  ReportedChannel other = channel(cell(1.0, 0.9, 1.1), 1, 2);
  other.allan[0].second = cell(1.5, 1.4, 1.6);
  other.description = "The curve shows a resonance at 20 Hz.";
  const ParameterTable found =
      table(request(), {{"rec_a", "static", channel(cell(1.0, 0.9, 1.1), 1, 2)}, {"rec_b", "drive", other}});
  ASSERT_EQ(found.rows.size(), 2U);
  EXPECT_EQ(found.rows[0].density.estimate, cell(1.0, 0.9, 1.1));
  EXPECT_TRUE(found.rows[0].warnings.empty());
  EXPECT_EQ(found.rows[1].density.estimate, cell(1.5, 1.4, 1.6));
  EXPECT_EQ(found.rows[0].density.change, std::nullopt);
  EXPECT_EQ(found.rows[1].density.change, Change::Up);
  ASSERT_EQ(found.rows[1].warnings.size(), 2U);
  EXPECT_NE(found.rows[1].warnings[0].find("not the low-frequency density N"), std::string::npos);
  EXPECT_EQ(found.rows[1].warnings[1], other.description);
  other.fits[0].j_test = JTest{3.0, 5.0, 0.7};
  EXPECT_EQ(table(request(), {{"rec_b", "drive", other}}).rows[0].warnings.size(), 1U) << "an accepted model says it";
}

TEST(ParameterTable, WarnsOfARowExactlyWhereItSaysThatItsFitDoesNotStand) {
  // Story: at p = 0.01 itself a row said that it fits, and described its curve as that of a rejected model.
  ReportedChannel one = channel(cell(1.0, 0.9, 1.1), 1, 2);
  one.description = "The curve shows a resonance at 20 Hz.";
  for (const auto& [p, fits] : {std::pair(kRejected, true), std::pair(0.5 * kRejected, false)}) {
    one.fits[0].j_test = JTest{3.0, 5.0, p};
    const ParameterTable found = table(request(), {{"a", "static", one}});
    EXPECT_EQ(found.rows[0].fits(), fits) << p;
    EXPECT_EQ(found.rows[0].warnings.empty(), fits) << p;
  }
}

}  // namespace
}  // namespace driftlab
