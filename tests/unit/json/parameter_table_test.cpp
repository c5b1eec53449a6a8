#include "schema/json/parameter_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace driftlab {
namespace {

Json cell(double value, const Json& low, const Json& high) {
  return {{"value", value}, {"unit", "deg/sqrt(h)"}, {"ci95", {low, high}}};
}

/// A channel that was fitted with WN and WN+GM: `n` is N of both, `wic` their criteria.
Json channel(const Json& n, double wic_wn, double wic_gm, const Json& beta = nullptr) {
  Json white{{"process", "white_noise"}, {"params", {{"N", n}}}};
  if (n.is_null()) {
    white["reasons"] = {{"N", "No white noise."}};
  }
  Json markov{{"process", "gauss_markov"},
              {"params", {{"sigma", nullptr}, {"beta", beta}}},
              {"reasons", {{"sigma", "No sigma."}, {"beta", "No beta."}}}};
  return {{"unit", "deg/s"},
          {"allan_parameters",
           {{"N", n},
            {"B", nullptr},
            {"K", nullptr},
            {"Q", nullptr},
            {"R", nullptr},
            {"reasons", {{"B", "No B."}, {"K", "No K."}}}}},
          {"fits",
           {{{"model", "WN"}, {"wic", wic_wn}, {"processes", {white}}},
            {{"model", "WN+GM"}, {"wic", wic_gm}, {"processes", {white, markov}}}}}};
}

TableRequest request(TableMethod method = TableMethod::Gmwm, std::string model = "") {
  return {"phone-07", Quantity::AngularRate, "z", method, std::move(model)};
}

Json table(const TableRequest& wanted, const std::vector<TableSource>& sources) {
  auto built = build_parameter_table(wanted, sources);
  EXPECT_TRUE(built) << built.error().message;
  return built ? *built : Json();
}

TEST(ParameterTable, PutsStaticFirstThenRatesBySize) {
  const Json n = cell(1.0, 0.9, 1.1);
  const Json found = table(request(), {{"rec_a", "constant_rate:z:40:deg/s", channel(n, 1, 2)},
                                       {"rec_b", "constant_rate:z:9:deg/s", channel(n, 1, 2)},
                                       {"rec_c", "static", channel(n, 1, 2)}});
  ASSERT_EQ(found["rows"].size(), 3U);
  EXPECT_EQ(found["rows"][0]["label"], "static");
  EXPECT_EQ(found["rows"][1]["label"], "9 deg/s about z");
  EXPECT_EQ(found["rows"][2]["recordings"], Json::array({"rec_a"}));
}

TEST(ParameterTable, ShowsTheModelWithTheSmallestSumOfTheCriterion) {
  const Json n = cell(1.0, 0.9, 1.1);
  // WN wins one row by 1, WN+GM the other by 5.
  const std::vector<TableSource> sources{{"rec_a", "static", channel(n, 1, 2)}, {"rec_b", "drive", channel(n, 9, 4)}};
  EXPECT_EQ(table(request(), sources)["model"], "WN+GM");
  EXPECT_EQ(table(request(TableMethod::Gmwm, "WN"), sources)["model"], "WN");
  EXPECT_EQ(table(request(TableMethod::Av), sources)["model"], nullptr);
}

TEST(ParameterTable, PoolsReplicatesOnTheLogScale) {
  // Half-widths ln 1.1 and ln 1.21 = 2 ln 1.1: weights 4 to 1, so the mean log is (4 ln 1 + ln 2)/5 = ln 2 / 5.
  const Json found = table(request(TableMethod::Av), {{"rec_a", "static", channel(cell(1.0, 1.0 / 1.1, 1.1), 1, 2)},
                                                      {"rec_b", "static", channel(cell(2.0, 2.0 / 1.21, 2.42), 1, 2)}});
  ASSERT_EQ(found["rows"].size(), 1U);
  const Json& pooled = found["rows"][0]["values"]["N"];
  const double h = std::log(1.1);
  const double half = 1.0 / std::sqrt(1.0 / (h * h) + 1.0 / (4.0 * h * h));
  EXPECT_NEAR(pooled["value"].get<double>(), std::exp(std::log(2.0) / 5.0), 1e-12);
  EXPECT_NEAR(std::log(pooled["ci95"][1].get<double>() / pooled["value"].get<double>()), half, 1e-12);
  EXPECT_EQ(found["rows"][0]["recordings"].size(), 2U);
}

TEST(ParameterTable, TellsWhatSpeaksAgainstARow) {
  // The worst verdict of the replicates stands for the row; a warning that both fits give is said once.
  Json sound = channel(cell(1.0, 0.9, 1.1), 1, 2);
  sound["contamination"] = {{"verdict", "clean"}};
  Json spoiled = sound;
  spoiled["contamination"] = {{"verdict", "contaminated"}};
  for (Json* const document : {&sound, &spoiled}) {
    (*document)["fits"][0]["warnings"] = Json::array({"The model does not fit."});
  }
  const Json found =
      table(request(), {{"rec_a", "static", sound}, {"rec_b", "static", spoiled}, {"rec_c", "drive", sound}});
  EXPECT_EQ(found["rows"][0]["contamination"], "contaminated");
  EXPECT_EQ(found["rows"][0]["warnings"], Json::array({"The model does not fit."}));
  EXPECT_EQ(found["rows"][1]["contamination"], "clean");
  const std::string text = table_to_text(found);
  EXPECT_NE(text.find("! static: gross errors"), std::string::npos);
  EXPECT_NE(text.find("! drive: The model does not fit."), std::string::npos);
  EXPECT_EQ(text.find("! drive: gross errors"), std::string::npos);
}

TEST(ParameterTable, MarksChangesAgainstTheFirstRow) {
  const auto row = [](const char* condition, double value) {
    return TableSource{"rec", condition, channel(cell(value, value / 1.05, value * 1.05), 1, 2)};
  };
  const Json found =
      table(request(TableMethod::Av), {row("static", 1.0), row("constant_rate:z:1:deg/s", 1.06),
                                       row("constant_rate:z:2:deg/s", 1.08), row("constant_rate:z:3:deg/s", 0.9)});
  // Two half-widths ln 1.05 make sqrt(2) ln 1.05 = ln 1.0714: 1.06 is within, 1.08 and 0.9 are beyond.
  const char* const wanted[] = {"none", "up", "down"};
  EXPECT_EQ(found["rows"][0]["values"]["N"]["change"], nullptr);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found["rows"][i + 1]["values"]["N"]["change"], wanted[i]);
  }
}

TEST(ParameterTable, GivesTheReasonForWhatIsNotIdentified) {
  const Json found = table(request(TableMethod::Gmwm, "WN+GM"),
                           {{"rec_a", "static", channel(nullptr, 1, 2, cell(1.0, 0.5, nullptr))}});
  const Json& row = found["rows"][0];
  EXPECT_EQ(row["values"]["white_noise.N"], nullptr);
  EXPECT_EQ(row["reasons"]["white_noise.N"], "No white noise.");
  EXPECT_EQ(row["values"]["gauss_markov_1.sigma"], nullptr);
  EXPECT_EQ(row["values"]["gauss_markov_1.beta"]["ci95"], Json::array({0.5, nullptr}));
  EXPECT_FALSE(row["reasons"].contains("gauss_markov_1.beta"));
}

TEST(ParameterTable, GivesTheUnitOfAColumnThatNoRowIdentifies) {
  const auto units = [](TableMethod method) {
    const Json found = table(request(method, method == TableMethod::Gmwm ? "WN+GM" : ""),
                             {{"rec_a", "static", channel(nullptr, 1, 2)}});
    std::map<std::string, std::string> of_key;
    for (const Json& column : found["columns"]) {
      of_key[column["key"].get<std::string>()] = column["unit"].get<std::string>();
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
  const Json found = table(request(TableMethod::Av), {{"rec_a", "static", channel(cell(1, 0.9, 1.1), 1, 2)}});
  std::vector<std::string> keys;
  for (const Json& column : found["columns"]) {
    keys.push_back(column["key"].get<std::string>());
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

TEST(TableCsv, QuotesWhatNeedsItAndLeavesUnknownCellsEmpty) {
  Json found = table(request(TableMethod::Av), {{"rec_a", "static", channel(cell(0.1, nullptr, 0.3), 1, 2)},
                                                {"rec_b", "static", channel(nullptr, 1, 2)}});
  found["rows"][0]["label"] = "9 deg/s, \"about\" z";
  EXPECT_EQ(table_to_csv(found),
            "condition,recordings,N [deg/sqrt(h)],N low [deg/sqrt(h)],N high [deg/sqrt(h)],B [deg/h],B low [deg/h],"
            "B high [deg/h],K [deg/h/sqrt(h)],K low [deg/h/sqrt(h)],K high [deg/h/sqrt(h)]\r\n"
            "\"9 deg/s, \"\"about\"\" z\",rec_a rec_b,0.1,,0.3,,,,,,\r\n");
}

TEST(TableText, AlignsColumnsWhateverCharactersTheyHold) {
  const Json found = table(request(TableMethod::Av),
                           {{"rec_a", "static", channel(cell(1.0, 0.95, 1.05), 1, 2)},
                            {"rec_b", "constant_rate:z:9:deg/s", channel(cell(1234.6, 1200.0, nullptr), 1, 2)},
                            {"rec_c", "constant_rate:z:40:deg/s", channel(cell(2.0, 1.9, 2.1), 1, 2)}});
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

}  // namespace
}  // namespace driftlab
