#include "clients/cli/simulate_model.hpp"

#include "clients/cli/table_file.hpp"
#include "core/investigate/search/simulate_channel.hpp"
#include "core/signal/number.hpp"
#include "schema/json/simulation_model.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>

namespace driftlab::cli {
namespace {

using investigate::Baseline;

Result<Baseline> read_model(const std::string& path) {
  const std::ifstream file(path, std::ios::binary);
  if (!file) {
    return fail(ErrorCode::NotFound, "There is no file '" + path + "'.");
  }
  std::ostringstream text;
  text << file.rdbuf();
  auto document = parse_json(text.str());
  if (!document) {
    return fail(document.error());
  }
  if (document->is_array()) {
    document = Json{{"processes", *document}};
  } else if (document->is_object() && document->contains("extended_model")) {
    document = Json((*document)["extended_model"]);
  }
  Faults faults;
  Baseline model = simulation_model_from_json(*document, "", faults);
  if (!faults.none()) {
    return fail(faults.error());
  }
  return model;
}

Result<std::string> column_of(const Baseline& model, const std::string& wanted) {
  if (wanted.empty()) {
    if (!model.by_channel.empty()) {
      return model.by_channel.begin()->first;
    }
    return std::string(model.quantity == Quantity::SpecificForce ? "fz" : "gz");
  }
  if (!model.by_channel.empty() && model.by_channel.count(wanted) == 0) {
    return fail(ErrorCode::NotFound, "The model has no channel '" + wanted + "'.", {{"parameter", "--channel"}});
  }
  return wanted;
}

/// A recording that moves as wanted and has read nothing yet.
Result<investigate::StudyRecording> blank_recording(const ModelSimulation& wanted, const std::string& column,
                                                    const ColumnRole& role) {
  auto condition = parse_condition(wanted.condition);
  if (!condition) {
    return fail(condition.error());
  }
  RecordingSpec spec;
  spec.id = "simulated";
  spec.rate_hz = wanted.rate_hz;
  spec.condition = *condition;
  spec.columns[column] = role;
  const std::vector<double> blank(static_cast<std::size_t>(wanted.duration_s * wanted.rate_hz), 0.0);
  return investigate::make_study_recording(spec, {column}, blank.size(),
                                           [&](std::size_t) { return std::span<const double>(blank); });
}

}  // namespace

Exit simulate_model(const ModelSimulation& wanted) {
  const auto model = read_model(wanted.model);
  if (!model) {
    return complain(model.error());
  }
  const auto column = column_of(*model, wanted.channel);
  if (!column) {
    return complain(column.error());
  }
  const bool gyro = model->quantity != Quantity::SpecificForce;
  const Unit unit = *parse_unit(gyro ? "deg/s" : "m/s^2");
  const std::string last = column->substr(column->size() - 1);
  const ColumnRole role{gyro ? Quantity::AngularRate : Quantity::SpecificForce,
                        investigate::axis_index(last) ? last : "z", unit};
  auto recording = blank_recording(wanted, *column, role);
  if (!recording) {
    return complain(recording.error());
  }
  const auto made = investigate::simulate_channel(*model, *std::move(recording), *column, role, wanted.seed);
  TableFile table;
  table.comment = "Simulated by driftlab " DRIFTLAB_VERSION ", model " + wanted.model + ", condition " +
                  wanted.condition + ", seed " + std::to_string(wanted.seed) + ", " + to_text(wanted.rate_hz) + " Hz";
  for (const std::string& left : made.left_out) {
    table.comment.append("; left out: ").append(left);
    std::fprintf(stderr, "driftlab: left out: %s\n", left.c_str());
  }
  std::vector<std::size_t> kept;
  std::vector<double> stamps;
  for (std::size_t i = 0; i < made.reading.size(); ++i) {
    if (!made.present.empty() && made.present[i] == 0) {
      continue;
    }
    const double error_s = made.stamp_error_s.empty() ? 0.0 : made.stamp_error_s[i];
    const double stamp_s = static_cast<double>(i) / wanted.rate_hz + error_s;
    kept.push_back(i);
    stamps.push_back(stamps.empty() ? stamp_s : std::max(stamps.back(), stamp_s));
  }
  table.columns = {"t [s]", *column + " [" + std::string(unit.symbol) + "]"};
  table.decimals = {6, 9};
  table.rows = kept.size();
  table.cell = [&](std::size_t row, std::size_t cell) {
    return cell == 0 ? stamps[row] : unit.from_si(made.reading[kept[row]]);
  };
  const Status written = write_table(wanted.out, table);
  return written ? Exit::Success : complain(written.error());
}

}  // namespace driftlab::cli
