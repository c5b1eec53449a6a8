#include "schema/json/parameter_table.hpp"

#include "schema/json/recording_spec.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace driftlab {
namespace {

/// One parameter of one recording, in lab units.
struct Cell {
  std::optional<double> value;
  std::optional<double> low;
  std::optional<double> high;
  std::string unit;
  std::string reason;
};

using Cells = std::vector<std::pair<std::string, Cell>>;  // key -> cell, in document order

std::optional<double> optional_number(const Json& value) {
  return value.is_number() ? std::optional<double>(value.get<double>()) : std::nullopt;
}

Cell cell_of(const Json& parameter, const Json* reasons, const std::string& name) {
  Cell cell;
  if (parameter.is_object()) {
    cell.value = optional_number(parameter.value("value", Json()));
    cell.unit = parameter.value("unit", "");
    cell.low = optional_number(parameter["ci95"][0]);
    cell.high = optional_number(parameter["ci95"][1]);
  } else if (reasons != nullptr && reasons->contains(name)) {
    cell.reason = (*reasons)[name].get<std::string>();
  }
  return cell;
}

Cells allan_cells(const Json& channel) {
  Cells cells;
  const Json& parameters = channel.at("allan_parameters");
  const auto reasons = parameters.find("reasons");
  for (const char* const name : {"N", "B", "K", "Q", "R"}) {
    cells.emplace_back(
        name, cell_of(parameters.value(name, Json()), reasons == parameters.end() ? nullptr : &*reasons, name));
  }
  return cells;
}

const Json* find_fit(const Json& channel, const std::string& model) {
  for (const Json& fit : channel.at("fits")) {
    if (fit.value("model", "") == model) {
      return &fit;
    }
  }
  return nullptr;
}

Cells model_cells(const Json& fit) {
  Cells cells;
  std::map<std::string, int> seen;
  for (const Json& process : fit.at("processes")) {
    const std::string kind = process.value("process", "");
    const int index = ++seen[kind];
    // Gauss-Markov processes and sinusoids may occur any number of times, so they always carry a number.
    const bool numbered = kind == "gauss_markov" || kind == "sinusoid";
    const std::string prefix = kind + (numbered ? "_" + std::to_string(index) : "") + ".";
    const auto reasons = process.find("reasons");
    for (const auto& [name, parameter] : process.at("params").items()) {
      cells.emplace_back(prefix + name, cell_of(parameter, reasons == process.end() ? nullptr : &*reasons, name));
    }
  }
  return cells;
}

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

/// Half-width of the interval on the log scale; the wider side where they differ. Nothing where an end is open.
std::optional<double> log_half_width(const Cell& cell) {
  if (!cell.value || !cell.low || !cell.high || !(*cell.low > 0.0) || !(*cell.value > 0.0)) {
    return std::nullopt;
  }
  return std::max(std::log(*cell.high / *cell.value), std::log(*cell.value / *cell.low));
}

/// Replicates of one condition: weighted mean of logs, weights 1/half-width^2. One identified replicate stands alone.
Cell pooled(const std::vector<Cell>& replicates) {
  double weight_sum = 0.0;
  double log_sum = 0.0;
  const Cell* any = nullptr;
  int used = 0;
  for (const Cell& cell : replicates) {
    if (!cell.value) {
      continue;
    }
    any = &cell;
    if (const auto half = log_half_width(cell); half && *half > 0.0) {
      const double weight = 1.0 / (*half * *half);
      weight_sum += weight;
      log_sum += weight * std::log(*cell.value);
      ++used;
    }
  }
  if (used < 2) {
    return any != nullptr ? *any : replicates.front();
  }
  Cell result = *any;
  const double mean = log_sum / weight_sum;
  const double half = 1.0 / std::sqrt(weight_sum);
  result.value = std::exp(mean);
  result.low = std::exp(mean - half);
  result.high = std::exp(mean + half);
  return result;
}

Json change_between(const Cell& first, const Cell& now) {
  const auto a = log_half_width(first);
  const auto b = log_half_width(now);
  if (!a || !b || !first.value || !now.value) {
    return nullptr;
  }
  const double difference = std::log(*now.value / *first.value);
  if (std::fabs(difference) <= std::hypot(*a, *b)) {
    return "none";
  }
  return difference > 0.0 ? "up" : "down";
}

struct Row {
  Condition condition;
  std::string text;
  std::vector<std::string> recordings;
  std::vector<Cells> replicates;
  std::map<std::string, Cell> cells;
  std::string contamination;          ///< worst verdict of the replicates; empty where none has one
  std::vector<std::string> warnings;  ///< of the fits shown, each once
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
      rows.push_back(std::move(made));
      row = rows.end() - 1;
    }
    row->recordings.push_back(source.recording_id);
    note_contamination(*row, source.channel);
    if (method == TableMethod::Av) {
      row->replicates.push_back(allan_cells(source.channel));
    } else if (const Json* const fit = find_fit(source.channel, model)) {
      row->replicates.push_back(model_cells(*fit));
      note_warnings(*row, *fit);
    }
  }
  // No two rows have the same text, so the order is complete.
  std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
    const auto key = [](const Row& row) {
      return std::tuple(row.condition.kind, row.condition.axis, row.condition.value.value_or(0.0));
    };
    return key(a) != key(b) ? key(a) < key(b) : a.text < b.text;
  });
  return rows;
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
    std::erase_if(columns, [](const auto& column) {
      return (column.first == "Q" || column.first == "R") && column.second.empty();
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
              {"warnings", row.warnings},
              {"values", std::move(values)},
              {"reasons", std::move(reasons)}};
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

Result<Json> build_parameter_table(const TableRequest& request, const std::vector<TableSource>& sources) {
  if (sources.empty()) {
    return fail(ErrorCode::NotFound, "No characterised channel of device '" + request.device + "' is a " +
                                         std::string(sensor_of(request.quantity)) +
                                         (request.axis.empty() ? "" : " about axis " + request.axis) +
                                         "; characterise a recording of it first.");
  }
  std::string model = request.model;
  if (request.method == TableMethod::Gmwm) {
    if (model.empty()) {
      model = common_best_model(sources);
    }
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
  const auto columns = columns_of(rows, request.method);
  for (Row& row : rows) {
    for (const auto& [key, unit] : columns) {
      std::vector<Cell> replicates;
      for (const Cells& cells : row.replicates) {
        for (const auto& [name, cell] : cells) {
          if (name == key) {
            replicates.push_back(cell);
          }
        }
      }
      if (!replicates.empty()) {
        row.cells[key] = pooled(replicates);
      }
    }
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
