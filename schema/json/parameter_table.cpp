#include "schema/json/parameter_table.hpp"

#include "core/process/distributions.hpp"
#include "schema/json/pooled_sensor.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/table_cells.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

namespace driftlab {
namespace {

/// The model with the smallest sum of the criterion among those fitted to every source.
std::string common_best_model(const std::vector<TableSource>& sources) {
  std::string best;
  double best_sum = 0.0;
  for (const Json& candidate : sources.front().channel.at("fits")) {
    const std::string model = candidate.value("model", "");
    double sum = 0.0;
    bool everywhere = true;
    for (const TableSource& source : sources) {
      const Json* const fit = find_fit(source.channel, model);
      everywhere = everywhere && fit != nullptr && (*fit)["wic"].is_number();
      sum += everywhere ? (*fit)["wic"].get<double>() : 0.0;
    }
    if (everywhere && (best.empty() || sum < best_sum)) {
      best = model;
      best_sum = sum;
    }
  }
  return best;
}

struct Row {
  Condition condition;
  std::string text;
  std::string channel_unit;
  std::vector<std::string> recordings;
  std::vector<Cells> replicates;
  std::map<std::string, Cell> cells;
  std::string contamination;          ///< worst verdict of the replicates; empty where none has one
  std::vector<std::string> warnings;  ///< of the fits shown, each once
  std::vector<std::string> members;   ///< result ids
  std::string pooling = "single";     ///< single, average, joint
  bool robust = false;                ///< the values come from robust variances
  Json agreement;                     ///< of replicates
};

/// Keeps the worst verdict: contaminated before undecided before clean.
void note_contamination(Row& row, const Json& channel) {
  const auto found = channel.find("contamination");
  if (found == channel.end()) {
    return;
  }
  const std::string verdict = found->value("verdict", "");
  const auto badness = [](const std::string& v) {
    return v == "contaminated" ? 3 : v == "undecided" ? 2 : v.empty() ? 0 : 1;
  };
  if (badness(verdict) > badness(row.contamination)) {
    row.contamination = verdict;
  }
}

void note_warnings(Row& row, const Json& fit) {
  for (const Json& warning : fit.value("warnings", Json::array())) {
    const std::string text = warning.get<std::string>();
    if (std::find(row.warnings.begin(), row.warnings.end(), text) == row.warnings.end()) {
      row.warnings.push_back(text);
    }
  }
}

std::vector<Row> group_rows(const std::vector<TableSource>& sources, TableMethod method, const std::string& model) {
  std::vector<Row> rows;
  for (const TableSource& source : sources) {
    const auto same = [&](const Row& row) { return row.text == source.condition; };
    auto row = std::find_if(rows.begin(), rows.end(), same);
    if (row == rows.end()) {
      Row made;
      made.condition = parse_condition(source.condition).value_or(Condition{});
      made.text = source.condition;
      made.channel_unit = source.channel.value("unit", "");
      rows.push_back(std::move(made));
      row = rows.end() - 1;
    }
    row->recordings.push_back(source.recording_id);
    row->members.push_back(source.result_id.empty() ? source.recording_id : source.result_id);
    note_contamination(*row, source.channel);
    if (method == TableMethod::Av) {
      row->replicates.push_back(allan_cells(source.channel));
    } else if (const Json* const fit = find_fit(source.channel, model)) {
      row->replicates.push_back(model_cells(*fit, row->channel_unit));
      row->robust = row->robust || fit->value("robust", false);
      note_warnings(*row, *fit);
    }
  }
  // No two rows have the same text, so the order is complete.
  std::sort(rows.begin(), rows.end(),
            [](const Row& a, const Row& b) { return comes_before(a.condition, b.condition); });
  return rows;
}

bool is_identified(const std::vector<Row>& rows, const std::string& key) {
  return std::any_of(rows.begin(), rows.end(), [&](const Row& row) {
    return std::any_of(row.replicates.begin(), row.replicates.end(), [&](const Cells& cells) {
      return std::any_of(cells.begin(), cells.end(),
                         [&](const auto& cell) { return cell.first == key && cell.second.value.has_value(); });
    });
  });
}

/// Column keys in order, each with its unit: those of any row; Q and R of the Allan method only where identified.
std::vector<std::pair<std::string, std::string>> columns_of(const std::vector<Row>& rows, TableMethod method) {
  std::vector<std::pair<std::string, std::string>> columns;
  for (const Row& row : rows) {
    for (const Cells& cells : row.replicates) {
      for (const auto& [key, cell] : cells) {
        auto known =
            std::find_if(columns.begin(), columns.end(), [&](const auto& column) { return column.first == key; });
        if (known == columns.end()) {
          columns.emplace_back(key, cell.unit);
        } else if (known->second.empty()) {
          known->second = cell.unit;
        }
      }
    }
  }
  if (method == TableMethod::Av) {
    std::erase_if(columns, [&](const auto& column) {
      return (column.first == "Q" || column.first == "R") && !is_identified(rows, column.first);
    });
  }
  return columns;
}

Json cell_json(const Cell& cell, const Json& change) {
  if (!cell.value) {
    return nullptr;
  }
  return Json{{"value", number(*cell.value)},
              {"unit", cell.unit},
              {"ci95", Json::array({cell.low ? number(*cell.low) : Json(), cell.high ? number(*cell.high) : Json()})},
              {"change", change}};
}

Json row_json(const Row& row, const Row& first, const std::vector<std::pair<std::string, std::string>>& columns) {
  Json values = Json::object();
  Json reasons = Json::object();
  for (const auto& [key, unit] : columns) {
    const auto found = row.cells.find(key);
    if (found == row.cells.end()) {
      values[key] = nullptr;
      reasons[key] = "This model was not fitted to a recording of this condition.";
      continue;
    }
    const auto reference = first.cells.find(key);
    const bool comparable = &row != &first && reference != first.cells.end();
    values[key] =
        cell_json(found->second, comparable ? change_between(reference->second, found->second) : Json(nullptr));
    if (!found->second.value) {
      reasons[key] = found->second.reason;
    }
  }
  return Json{{"condition", to_json(row.condition)},
              {"label", label(row.condition)},
              {"recordings", row.recordings},
              {"contamination", row.contamination.empty() ? Json(nullptr) : Json(row.contamination)},
              {"pooling", row.pooling},
              {"robust", row.robust},
              {"agreement", row.agreement},
              {"warnings", row.warnings},
              {"values", std::move(values)},
              {"reasons", std::move(reasons)}};
}

/// The joint fit of a row's recordings in place of their own, where the store has it.
void take_joint_fit(Row& row, const Json* pooled, const std::string& model) {
  const Json* const entry = find_pooled(pooled, row.text, row.members);
  const Json* const fit = entry != nullptr ? find_fit(*entry, model) : nullptr;
  if (fit == nullptr) {
    return;
  }
  row.replicates = {model_cells(*fit, row.channel_unit)};
  row.robust = fit->value("robust", false);
  row.warnings.clear();
  note_warnings(row, *fit);
  if (row.recordings.size() > 1) {
    row.pooling = "joint";
    const Json agreement = entry->value("agreement", Json());
    row.agreement = agreement.is_object() && agreement.value("model", "") == model ? agreement : Json();
  }
}

Json agreement_of(const Scatter& scatter) {
  if (scatter.dof == 0) {
    return nullptr;
  }
  const double p = chi_squared_tail(scatter.statistic, scatter.dof);
  return Json{{"model", nullptr},
              {"statistic", number(scatter.statistic)},
              {"dof", scatter.dof},
              {"p", number(p)},
              {"agree", p >= 0.05}};
}

/// One cell per column from the replicates of the row.
void fill_cells(Row& row, const std::vector<std::pair<std::string, std::string>>& columns) {
  Scatter scatter;
  for (const auto& [key, unit] : columns) {
    std::vector<Cell> replicates;
    for (const Cells& cells : row.replicates) {
      for (const auto& [name, cell] : cells) {
        if (name == key) {
          replicates.push_back(cell);
        }
      }
    }
    if (replicates.empty()) {
      continue;
    }
    row.cells[key] = averaged(replicates);
    const Scatter one = scatter_of(replicates);
    scatter.statistic += one.statistic;
    scatter.dof += one.dof;
  }
  if (row.replicates.size() > 1) {
    row.pooling = "average";
    row.agreement = agreement_of(scatter);
  }
}

/// The model that the caller asked for, that was pooled over all rows, or that is best over them.
std::string model_of(const TableRequest& request, const std::vector<TableSource>& sources, const Json* pooled) {
  if (request.method == TableMethod::Av || !request.model.empty()) {
    return request.method == TableMethod::Av ? "" : request.model;
  }
  if (pooled != nullptr && pooled->value("model", Json()).is_string()) {
    const std::vector<Row> rows = group_rows(sources, TableMethod::Av, "");
    const bool current = std::all_of(rows.begin(), rows.end(), [&](const Row& row) {
      return find_pooled(pooled, row.text, row.members) != nullptr;
    });
    if (current) {
      return (*pooled)["model"].get<std::string>();
    }
  }
  return common_best_model(sources);
}

}  // namespace

std::string_view name_of(TableMethod method) { return method == TableMethod::Av ? "av" : "gmwm"; }

Result<TableMethod> parse_table_method(std::string_view name) {
  if (name == "av") {
    return TableMethod::Av;
  }
  if (name == "gmwm") {
    return TableMethod::Gmwm;
  }
  return fail(ErrorCode::InvalidArgument, "The method '" + std::string(name) + "' is not known; known are av and gmwm.",
              {{"parameter", "method"}});
}

Result<Json> build_parameter_table(const TableRequest& request, const std::vector<TableSource>& sources,
                                   const Json* pooled) {
  if (sources.empty()) {
    return fail(ErrorCode::NotFound, "No characterised channel of device '" + request.device + "' is a " +
                                         std::string(sensor_of(request.quantity)) +
                                         (request.axis.empty() ? "" : " about axis " + request.axis) +
                                         "; characterise a recording of it first.");
  }
  const std::string model = model_of(request, sources, pooled);
  if (request.method == TableMethod::Gmwm) {
    const bool fitted = std::any_of(sources.begin(), sources.end(), [&](const TableSource& source) {
      return find_fit(source.channel, model) != nullptr;
    });
    if (!fitted) {
      return fail(ErrorCode::InvalidArgument,
                  model.empty() ? "No model was fitted to every recording; ask for one by name."
                                : "The model '" + model + "' was not fitted to any recording of this channel.",
                  {{"parameter", "model"}});
    }
  }
  std::vector<Row> rows = group_rows(sources, request.method, model);
  if (request.method == TableMethod::Gmwm) {
    for (Row& row : rows) {
      take_joint_fit(row, pooled, model);
    }
  }
  const auto columns = columns_of(rows, request.method);
  for (Row& row : rows) {
    fill_cells(row, columns);
  }
  Json column_list = Json::array();
  for (const auto& [key, unit] : columns) {
    column_list.push_back(Json{{"key", key}, {"unit", unit.empty() ? Json(nullptr) : Json(unit)}});
  }
  Json row_list = Json::array();
  for (const Row& row : rows) {
    row_list.push_back(row_json(row, rows.front(), columns));
  }
  return Json{{"device", request.device},
              {"sensor", sensor_of(request.quantity)},
              {"axis", request.axis.empty() ? Json(nullptr) : Json(request.axis)},
              {"method", name_of(request.method)},
              {"model", model.empty() ? Json(nullptr) : Json(model)},
              {"columns", std::move(column_list)},
              {"rows", std::move(row_list)}};
}

}  // namespace driftlab
