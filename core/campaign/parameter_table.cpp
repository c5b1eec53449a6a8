#include "core/campaign/parameter_table.hpp"

#include "core/process/distributions.hpp"
#include "core/signal/with_count.hpp"

#include <algorithm>
#include <cmath>

namespace driftlab {
namespace {

/// The model with the smallest sum of the criterion among those fitted to every source.
std::string common_best_model(const std::vector<TableSource>& sources) {
  std::string best;
  double best_sum = 0.0;
  for (const ReportedFit& candidate : sources.front().channel.fits) {
    double sum = 0.0;
    bool everywhere = true;
    for (const TableSource& source : sources) {
      const ReportedFit* const fit = find_fit(source.channel.fits, candidate.model);
      everywhere = everywhere && fit != nullptr && std::isfinite(fit->wic);
      sum += everywhere ? fit->wic : 0.0;
    }
    if (everywhere && (best.empty() || sum < best_sum)) {
      best = candidate.model;
      best_sum = sum;
    }
  }
  return best;
}

/// A row on its way into the table.
struct OpenRow {
  TableRow shown;
  std::string key;  ///< the condition in one word
  std::string channel_unit;
  std::vector<ReportedValues> replicates;
  std::vector<ReportedValue> densities;   ///< N of each recording
  std::vector<std::string> descriptions;  ///< of recordings whose fit is rejected
  std::vector<std::string> members;
};

void note(TableRow& row, const std::string& text) {
  if (!text.empty() && std::find(row.warnings.begin(), row.warnings.end(), text) == row.warnings.end()) {
    row.warnings.push_back(text);
  }
}

/// Where the white noise of a model is not the density that the curve has.
void note_disagreement(TableRow& row, const std::vector<ReportedValues>& replicates) {
  const ReportedValue& density = row.density.estimate;
  for (const ReportedValues& cells : replicates) {
    for (const auto& [name, cell] : cells) {
      if (name == "white_noise.N" && density.low && density.high && cell.low && cell.high &&
          (*cell.low > *density.high || *cell.high < *density.low)) {
        note(row,
             "The white noise of the model is not the low-frequency density N of the curve: the model lacks the "
             "process that makes the difference.");
      }
    }
  }
}

std::optional<double> p_of(const ReportedFit& fit) { return fit.j_test ? std::optional(fit.j_test->p) : std::nullopt; }

void note_warnings(TableRow& row, const ReportedFit& fit) {
  for (const std::string& warning : fit.warnings) {
    note(row, warning);
  }
}

std::vector<OpenRow> group_rows(const std::vector<TableSource>& sources, TableMethod method, const std::string& model) {
  std::vector<OpenRow> rows;
  for (const TableSource& source : sources) {
    auto row =
        std::find_if(rows.begin(), rows.end(), [&](const OpenRow& open) { return open.key == source.condition; });
    if (row == rows.end()) {
      OpenRow made;
      made.key = source.condition;
      made.shown.condition = parse_condition(source.condition).value_or(Condition{});
      made.shown.label = label(made.shown.condition);
      made.channel_unit = source.channel.unit;
      rows.push_back(std::move(made));
      row = rows.end() - 1;
    }
    TableRow& shown = row->shown;
    shown.recordings.push_back(source.recording_id);
    shown.duration_s += static_cast<double>(source.channel.samples) * source.channel.dt_s;
    shown.frozen += source.frozen;
    row->members.push_back(source.member_id());
    shown.contamination = worse_verdict(shown.contamination, source.channel.contamination);
    row->densities.push_back(allan_cells(source.channel).front().second);
    if (method == TableMethod::Av) {
      row->replicates.push_back(allan_cells(source.channel));
    } else if (const ReportedFit* const fit = find_fit(source.channel.fits, model)) {
      row->replicates.push_back(model_cells(*fit, row->channel_unit));
      shown.j_test_p = p_of(*fit);
      shown.robust = shown.robust || fit->robust;
      note_warnings(shown, *fit);
      if (!fit->fits()) {
        row->descriptions.push_back(source.channel.description);
      }
    }
  }
  for (OpenRow& row : rows) {
    if (row.shown.frozen > 0) {
      note(row.shown, "The sensor is frozen for " + with_count(row.shown.frozen, "sample, which is not analysed.",
                                                               "samples, which are not analysed."));
    }
  }
  // No two rows have the same text, so the order is complete.
  std::sort(rows.begin(), rows.end(),
            [](const OpenRow& a, const OpenRow& b) { return comes_before(a.shown.condition, b.shown.condition); });
  return rows;
}

bool is_identified(const std::vector<OpenRow>& rows, const std::string& key) {
  return std::any_of(rows.begin(), rows.end(), [&](const OpenRow& row) {
    return std::any_of(row.replicates.begin(), row.replicates.end(), [&](const ReportedValues& cells) {
      return std::any_of(cells.begin(), cells.end(),
                         [&](const auto& cell) { return cell.first == key && cell.second.value.has_value(); });
    });
  });
}

/// Columns in order, each with its unit: those of any row; Q and R of the Allan method only where identified.
std::vector<TableColumn> columns_of(const std::vector<OpenRow>& rows, TableMethod method) {
  std::vector<TableColumn> columns;
  for (const OpenRow& row : rows) {
    for (const ReportedValues& cells : row.replicates) {
      for (const auto& [name, cell] : cells) {
        const std::string& key = name;
        auto known =
            std::find_if(columns.begin(), columns.end(), [&](const auto& column) { return column.key == key; });
        if (known == columns.end()) {
          columns.push_back({key, cell.unit});
        } else if (known->unit.empty()) {
          known->unit = cell.unit;
        }
      }
    }
  }
  if (method == TableMethod::Av) {
    std::erase_if(columns, [&](const auto& column) {
      return (column.key == "Q" || column.key == "R") && !is_identified(rows, column.key);
    });
  }
  return columns;
}

/// The joint fit of a row's recordings in place of their own, where there is one.
void take_joint_fit(OpenRow& row, const PooledSensor* pooled, const std::string& model) {
  const PooledCondition* const entry = find_pooled(pooled, row.key, row.members);
  if (entry == nullptr) {
    return;
  }
  TableRow& shown = row.shown;
  const ReportedFit* const fit = find_fit(entry->fits, model);
  if (fit == nullptr) {
    if (!entry->reason.empty()) {
      shown.warnings.push_back("The recordings could not be fitted together. " + entry->reason);
    }
    return;
  }
  row.replicates = {model_cells(*fit, row.channel_unit)};
  shown.robust = fit->robust;
  shown.j_test_p = p_of(*fit);
  shown.warnings.clear();
  note_warnings(shown, *fit);
  if (shown.recordings.size() > 1) {
    shown.pooling = Pooling::Joint;
    if (entry->agreement && entry->agreement->model == model) {
      shown.agreement = entry->agreement;
    }
  }
}

/// One cell per column from the replicates of the row.
void fill_cells(OpenRow& row, const std::vector<TableColumn>& columns) {
  Scatter scatter;
  for (const TableColumn& column : columns) {
    std::vector<ReportedValue> replicates;
    for (const ReportedValues& cells : row.replicates) {
      for (const auto& [name, cell] : cells) {
        if (name == column.key) {
          replicates.push_back(cell);
        }
      }
    }
    TableCell filled;
    if (replicates.empty()) {
      filled.estimate.reason = "This model was not fitted to a recording of this condition.";
    } else {
      filled.estimate = averaged(replicates);
      const Scatter one = scatter_of(replicates);
      scatter.statistic += one.statistic;
      scatter.dof += one.dof;
    }
    row.shown.cells.push_back(std::move(filled));
  }
  if (row.replicates.size() > 1) {
    row.shown.pooling = Pooling::Average;
    row.shown.j_test_p.reset();
    row.shown.agreement.reset();
    if (scatter.dof > 0) {
      row.shown.agreement = RecordingAgreement{"", scatter.statistic, static_cast<double>(scatter.dof),
                                               chi_squared_tail(scatter.statistic, scatter.dof)};
    }
  }
}

/// Whether the pooled result is of exactly these sources.
bool is_current(const PooledSensor* pooled, const std::vector<TableSource>& sources) {
  if (pooled == nullptr || pooled->model.empty()) {
    return false;
  }
  const std::vector<OpenRow> rows = group_rows(sources, TableMethod::Av, "");
  return std::all_of(rows.begin(), rows.end(),
                     [&](const OpenRow& row) { return find_pooled(pooled, row.key, row.members) != nullptr; });
}

/// The model that the caller asked for, that was pooled over all rows, or that is best over them.
std::string model_of(const TableRequest& request, const std::vector<TableSource>& sources, const PooledSensor* pooled) {
  if (request.method == TableMethod::Av || !request.model.empty()) {
    return request.method == TableMethod::Av ? "" : request.model;
  }
  return is_current(pooled, sources) ? pooled->model : common_best_model(sources);
}

/// Two questions have two answers: which structure is best over all rows, and which serves each of them.
std::string note_on_model(const TableRequest& request, const std::string& model, const PooledStructure& structure) {
  if (structure.common.empty() || structure.common == model) {
    return "";
  }
  return "The table shows " + model +
         (request.model.empty() ? ", whose criterion summed over the conditions is the least; " : ", as was asked; ") +
         structure.common +
         " is the smallest structure that, whole or in part, comes close to the best in each condition by itself.";
}

/// The row that the others are compared with. Error: InvalidArgument naming the conditions that there are.
Result<std::size_t> reference_row(const TableRequest& request, const std::vector<TableRow>& rows) {
  if (!request.reference) {
    return std::size_t{0};
  }
  const std::string wanted = to_text(*request.reference);
  std::string known;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string condition = to_text(rows[i].condition);
    if (condition == wanted) {
      return i;
    }
    known += (known.empty() ? "" : ", ") + condition;
  }
  return fail(ErrorCode::InvalidArgument,
              "No recording of the table has the condition " + wanted + "; its conditions are " + known + ".",
              {{"parameter", "reference"}});
}

/// Changes and ratios of every row against that of the reference.
void compare_rows(ParameterTable& table) {
  const TableRow& reference = table.rows[table.reference];
  const auto compare = [](const TableCell& with, TableCell& cell) {
    cell.change = change_between(with.estimate, cell.estimate);
    cell.ratio = ratio_of(cell.estimate, with.estimate);
  };
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    if (r == table.reference) {
      continue;
    }
    TableRow& row = table.rows[r];
    compare(reference.density, row.density);
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      compare(reference.cells[c], row.cells[c]);
    }
  }
}

/// Errors: those of build_parameter_table.
Status check_sources(const TableRequest& request, const std::vector<TableSource>& sources) {
  if (sources.empty()) {
    return fail(ErrorCode::NotFound, "Device '" + request.device + "' has no characterised " +
                                         std::string(sensor_of(request.quantity)) +
                                         (request.axis.empty() ? "" : " about axis " + request.axis) +
                                         "; characterise a recording of it first.");
  }
  if (const std::string conflict = unit_conflict(sources); !conflict.empty()) {
    return fail(ErrorCode::InvalidArgument, conflict + " Correct the unit of one of them; a table has one per column.");
  }
  return {};
}

Status check_model(const std::string& model, const std::vector<TableSource>& sources) {
  const bool fitted = std::any_of(sources.begin(), sources.end(), [&](const TableSource& source) {
    return find_fit(source.channel.fits, model) != nullptr;
  });
  if (!fitted) {
    return fail(ErrorCode::InvalidArgument,
                model.empty() ? "No model was fitted to every recording; ask for one by name."
                              : "The model '" + model + "' was not fitted to any recording of this channel.",
                {{"parameter", "model"}});
  }
  return {};
}

/// The first row against the sensor's data sheet, where it is known and the row is at rest.
void compare_first_row(const TableRequest& request, ParameterTable& table) {
  const TableRow& first = table.rows.front();
  const auto known = known_sensor(request.hardware, request.quantity);
  if (!known || first.condition.kind != ConditionKind::Static) {
    return;
  }
  const auto flicker = std::find_if(table.columns.begin(), table.columns.end(),
                                    [](const TableColumn& column) { return column.key == "B"; });
  const ReportedValue* const b = flicker == table.columns.end()
                                     ? nullptr
                                     : &first.cells[static_cast<std::size_t>(flicker - table.columns.begin())].estimate;
  table.data_sheet = compare_with_sheet(*known, table.axis, first.label, first.density.estimate, b);
}

}  // namespace

std::string_view name_of(TableMethod method) { return method == TableMethod::Av ? "av" : "gmwm"; }

std::string_view name_of(Pooling pooling) {
  switch (pooling) {
    case Pooling::Single:
      return "single";
    case Pooling::Average:
      return "average";
    case Pooling::Joint:
      break;
  }
  return "joint";
}

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

Result<ParameterTable> build_parameter_table(const TableRequest& request, const std::vector<TableSource>& sources,
                                             const PooledSensor* pooled) {
  if (auto checked = check_sources(request, sources); !checked) {
    return fail(checked.error());
  }
  const std::string model = model_of(request, sources, pooled);
  if (request.method == TableMethod::Gmwm) {
    if (auto checked = check_model(model, sources); !checked) {
      return fail(checked.error());
    }
  }
  std::vector<OpenRow> rows = group_rows(sources, request.method, model);
  if (request.method == TableMethod::Gmwm) {
    for (OpenRow& row : rows) {
      take_joint_fit(row, pooled, model);
    }
  }
  ParameterTable table{request.device, request.quantity, request.axis, request.method, model, {}, {}};
  table.columns = columns_of(rows, request.method);
  for (OpenRow& row : rows) {
    row.shown.density.estimate = averaged(row.densities);
    note_disagreement(row.shown, row.replicates);
    for (const std::string& description : row.descriptions) {
      note(row.shown, description);
    }
    fill_cells(row, table.columns);
    table.rows.push_back(std::move(row.shown));
  }
  const auto reference = reference_row(request, table.rows);
  if (!reference) {
    return fail(reference.error());
  }
  table.reference = *reference;
  compare_rows(table);
  if (request.method == TableMethod::Gmwm && is_current(pooled, sources)) {
    table.structure = pooled->structure;
    table.model_note = table.structure ? note_on_model(request, model, *table.structure) : "";
  }
  compare_first_row(request, table);
  return table;
}

}  // namespace driftlab
