#include "schema/json/recording_spec.hpp"

#include <gtest/gtest.h>

namespace driftlab {
namespace {

constexpr const char* kFull = R"({"id": "rate-9-run-1", "rate_hz": 50.0,
  "columns": {"gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s"}, "temp": {"quantity": "temperature"}},
  "condition": {"kind": "constant_rate", "axis": "z", "value": 9.0, "unit": "deg/s"}, "trim": {"start_s": 30.0, "end_s": 0.5}})";

RecordingSpec read(std::string_view text, Faults& faults) {
  return recording_spec_from_json(parse_json(text).value(), "", faults);
}

std::vector<std::string> pointers(const Faults& faults) {
  std::vector<std::string> found;
  for (const ErrorField& field : faults.error().fields) {
    found.push_back(field.name);
  }
  return found;
}

TEST(RecordingSpec, GoesThroughJsonAndBack) {
  Faults faults;
  const RecordingSpec spec = read(kFull, faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  EXPECT_EQ(spec.rate_hz, 50.0);
  EXPECT_EQ(spec.columns.at("gz").axis, "z");
  EXPECT_FALSE(spec.columns.at("temp").unit);
  EXPECT_EQ(canonical_text(to_json(spec)), canonical_text(parse_json(kFull).value()));
  EXPECT_EQ(recording_spec_from_json(to_json(spec), "", faults), spec);
}

TEST(RecordingSpec, LeavesOutWhatNobodyGave) {
  Faults faults;
  const RecordingSpec spec = read(R"({"condition": {"kind": "static"}, "file": "ignored.csv", "trim": {}})", faults);
  ASSERT_TRUE(faults.none());
  EXPECT_EQ(to_text(to_json(spec)), R"({"condition":{"kind":"static"}})");
}

TEST(RecordingSpec, EveryFaultIsNamed) {
  Faults faults;
  (void)read(R"({"id": 1, "rate_hz": 0, "colour": 1, "trim": {"start_s": -1, "stop_s": 1},
                 "columns": {"a": {"quantity": "spin"}, "b": {"quantity": "angular_rate", "unit": "furlong"},
                             "c/d": {"quantity": "specific_force", "axis": "x", "unit": "deg/s"}, "e": 7, "f": {"axis": "x"}}})",
             faults);
  EXPECT_EQ(pointers(faults), (std::vector<std::string>{"/id", "/rate_hz", "/columns/a/quantity", "/columns/b/unit",
                                                        "/columns/c~1d", "/columns/e", "/columns/f/quantity",
                                                        "/condition", "/trim/stop_s", "/trim", "/colour"}));
}

TEST(RecordingSpec, AScaleAndAnOffsetStandWithTheUnit) {
  Faults faults;
  const RecordingSpec spec = read(R"({"condition": {"kind": "static"}, "columns": {
      "gz": {"quantity": "angular_rate", "axis": "z", "unit": "deg/s/131"},
      "temp": {"quantity": "temperature", "unit": "raw/340+36.53 degC"}}})",
                                  faults);
  ASSERT_TRUE(faults.none()) << faults.error().message;
  EXPECT_DOUBLE_EQ(spec.columns.at("temp").unit->to_si(0.0), 36.53 + 273.15);
  const RecordingSpec again = recording_spec_from_json(to_json(spec), "", faults);
  EXPECT_EQ(again.columns.at("temp").unit->to_si(340.0), spec.columns.at("temp").unit->to_si(340.0));
  EXPECT_EQ(again.columns.at("gz").unit->factor, spec.columns.at("gz").unit->factor);
  (void)read(R"({"condition": {"kind": "static"}, "columns": {
      "a": {"quantity": "temperature", "unit": "degC", "scale": 0.003, "offset": 36.53},
      "b": {"quantity": "temperature", "unit": "degC/0+36.53"}}})",
             faults);
  EXPECT_EQ(pointers(faults), (std::vector<std::string>{"/columns/a/scale", "/columns/a/offset", "/columns/b/unit"}));
}

TEST(Condition, IsReadStrictly) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"kind": "asleep"})", "/kind"},
      {R"({})", "/kind"},
      {R"({"kind": "static", "axis": "z"})", "/axis"},
      {R"({"kind": "constant_rate", "axis": "z", "value": 9})", "/unit"},
      {R"({"kind": "constant_rate", "axis": "z", "unit": "deg/s"})", "/value"},
      {R"({"kind": "constant_rate", "axis": "q", "value": 9, "unit": "deg/s"})", "/axis"},
      {R"({"kind": "constant_rate", "axis": "z", "value": 9, "unit": "deg/s^2"})", "/unit"},
      {R"({"kind": "six_position", "axis": "x", "direction": "sideways"})", "/direction"},
      {R"({"kind": "static", "extra": 1})", "/extra"},
  };
  for (const auto& [text, pointer] : cases) {
    Faults faults;
    (void)condition_from_json(parse_json(text).value(), "", faults);
    EXPECT_EQ(pointers(faults), std::vector<std::string>{pointer}) << text;
  }
}

TEST(Condition, AWordInADocumentIsAnsweredWithTheObject) {
  Faults faults;
  (void)condition_from_json("static", "/recordings/0/condition", faults);
  ASSERT_EQ(pointers(faults), std::vector<std::string>{"/recordings/0/condition"});
  EXPECT_NE(faults.error().message.find(R"({"kind": "static"})"), std::string::npos) << faults.error().message;
}

TEST(Condition, WritesTheValueAsTheUserDid) {
  for (const char* const text : {"static", "constant_rate:z:9:deg/s", "constant_angular_acceleration:y:-1:deg/s^2",
                                 "profile", "six_position:x:down", "drive"}) {
    const Condition condition = parse_condition(text).value();
    Faults faults;
    EXPECT_EQ(condition_from_json(to_json(condition), "", faults), condition) << text;
    EXPECT_TRUE(faults.none()) << text;
  }
  EXPECT_EQ(to_text(to_json(parse_condition("constant_rate:z:9:deg/s").value())),
            R"({"kind":"constant_rate","axis":"z","value":9.0,"unit":"deg/s"})");
}

TEST(ParseColumns, ReadsNamesQuantitiesAxesAndUnits) {
  const auto columns = parse_columns("t=time::s,gz=angular_rate:z:deg/s,3=specific_force:x,temp=temperature::degC");
  ASSERT_TRUE(columns) << columns.error().message;
  ASSERT_EQ(columns->size(), 4U);
  EXPECT_EQ(columns->at("t").quantity, Quantity::Time);
  EXPECT_EQ(columns->at("gz").axis, "z");
  EXPECT_EQ(columns->at("gz").unit->symbol, "deg/s");
  EXPECT_FALSE(columns->at("3").unit);
}

TEST(ParseColumns, ScaleAndOffsetOfCountsStandWithTheUnit) {
  const auto columns =
      parse_columns("gz=angular_rate:z:deg/s/131,temp=temperature:degC/340+36.53,b=temperature::degC/2 1");
  ASSERT_TRUE(columns) << columns.error().message;
  EXPECT_NEAR(columns->at("gz").unit->to_si(131.0 * 180.0), 3.14159265358979, 1e-13);
  EXPECT_DOUBLE_EQ(columns->at("temp").unit->to_si(-340.0), 273.15 + 35.53);
  EXPECT_EQ(columns->at("b").unit->symbol, "degC/2+1") << "a + in an address is a blank";
}

TEST(ParseColumns, WhatHasNoAxisMayHaveItsUnitAtOnce) {
  const auto columns = parse_columns("0=time:s,temp=temperature:degC,3=specific_force:x");
  ASSERT_TRUE(columns) << columns.error().message;
  EXPECT_EQ(columns->at("0"), parse_columns("0=time::s")->at("0"));
  EXPECT_EQ(columns->at("temp").unit->symbol, "degC");
  EXPECT_EQ(columns->at("3").axis, "x");
  EXPECT_EQ(parse_columns("0=time:furlong").error().code, ErrorCode::UnknownUnit);
}

TEST(ParseColumns, ReadsUnitsByWhatTheColumnMeasures) {
  const auto columns = parse_columns(
      "1=angular_rate:x:LSBs,2=angular_rate:y:131LSB/dps,3=angular_rate:z:8.75mdps/LSB,4=specific_force:x:G,"
      "5=temperature::C");
  ASSERT_TRUE(columns) << columns.error().message;
  EXPECT_EQ(columns->at("1").unit->symbol, "1");
  EXPECT_EQ(columns->at("2").unit->symbol, "131LSB/dps");
  EXPECT_EQ(columns->at("4").unit->symbol, "g");
  EXPECT_EQ(columns->at("5").unit->symbol, "degC");
  EXPECT_EQ(parse_columns("1=magnetic_field:x:G").error().code, ErrorCode::UnknownUnit) << "gauss";
}

TEST(ParseColumns, NamesTheColumnAtFault) {
  const struct {
    const char* text;
    ErrorCode code;
    ErrorField field;
  } cases[] = {
      {"", ErrorCode::InvalidArgument, {"parameter", "columns"}},
      {"gz", ErrorCode::InvalidArgument, {"parameter", "columns"}},
      {"=angular_rate", ErrorCode::InvalidArgument, {"parameter", "columns"}},
      {"gz=angular_rate:z:deg/s,", ErrorCode::InvalidArgument, {"parameter", "columns"}},
      {"gz=spin:z:deg/s", ErrorCode::UnknownQuantity, {"column", "gz"}},
      {"gz=angular_rate:z:furlong", ErrorCode::UnknownUnit, {"column", "gz"}},
      {"gz=angular_rate:z:m/s^2", ErrorCode::UnitMismatch, {"column", "gz"}},
      {"gz=angular_rate:z:deg/s:more", ErrorCode::InvalidArgument, {"column", "gz"}},
      {"gz=angular_rate:w:deg/s", ErrorCode::InvalidArgument, {"column", "gz"}},
      {"gz=angular_rate:z:deg/s,gz=angular_rate:x:deg/s", ErrorCode::DuplicateColumn, {"column", "gz"}},
  };
  for (const auto& each : cases) {
    const auto columns = parse_columns(each.text);
    ASSERT_FALSE(columns) << each.text;
    EXPECT_EQ(columns.error().code, each.code) << each.text << ": " << columns.error().message;
    EXPECT_NE(std::find(columns.error().fields.begin(), columns.error().fields.end(), each.field),
              columns.error().fields.end())
        << each.text;
  }
}

}  // namespace
}  // namespace driftlab
