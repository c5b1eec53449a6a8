#include "core/read/variables.hpp"

#include "core/signal/infer_role.hpp"
#include "core/signal/recording.hpp"
#include "core/signal/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <map>
#include <optional>
#include <utility>

namespace driftlab {
namespace {

constexpr std::size_t kMostChannelsAcross = 16;

std::size_t rows_of(const Variable& variable) { return variable.columns.empty() ? 0 : variable.columns.front().size(); }

/// Samples down, channels across.
void stand_up(Variable& variable) {
  const std::size_t rows = rows_of(variable);
  const std::size_t columns = variable.columns.size();
  if (rows == 0 || rows > kMostChannelsAcross || columns <= rows) {
    return;
  }
  std::vector<std::vector<double>> turned(rows, std::vector<double>(columns));
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::size_t r = 0; r < rows; ++r) {
      turned[r][c] = variable.columns[c][r];
    }
  }
  variable.columns = std::move(turned);
}

bool is_rate_name(const std::string& name) {
  const std::string last = lower_case(name.substr(name.rfind('.') + 1));
  constexpr std::array<std::string_view, 8> kNames{"rate",       "rate_hz",       "fs",          "freq",
                                                   "samplerate", "sampling_rate", "sample_rate", "frequency"};
  return std::find(kNames.begin(), kNames.end(), last) != kNames.end();
}

/// Levels of groups that `rate` shares with an array `name` where it says something of it: a rate speaks for the arrays
/// beside and below it. 0 where it lies elsewhere.
std::size_t nearness(const std::string& rate, const std::string& name) {
  const std::size_t point = rate.rfind('.');
  const std::string group = point == std::string::npos ? "" : rate.substr(0, point + 1);
  return name.starts_with(group) ? 1 + group.size() : 0;
}

/// The rate that is stated nearest to the first array; nothing where two as near differ.
std::optional<double> nearest_rate(const std::vector<std::pair<std::string, double>>& rates, const std::string& name,
                                   ColumnSink& sink) {
  std::size_t nearest = 0;
  for (const auto& [rate, value] : rates) {
    nearest = std::max(nearest, nearness(rate, name));
  }
  std::optional<double> found;
  for (const auto& [rate, value] : rates) {
    if (nearness(rate, name) != nearest) {
      continue;
    }
    if (found && *found != value) {
      sink.note("The file states several rates (" + rates.front().first + ", ...); none is used.");
      return std::nullopt;
    }
    found = value;
  }
  return found;
}

std::string column_name(const Variable& variable, std::size_t column) {
  if (variable.columns.size() == 1) {
    return variable.name;
  }
  constexpr std::string_view kAxes = "xyz";
  return variable.name + "_" + (variable.columns.size() == 3 ? std::string(1, kAxes[column]) : std::to_string(column));
}

bool is_sensor(const ColumnRole& role) {
  return role.quantity == Quantity::AngularRate || role.quantity == Quantity::SpecificForce;
}

/// The names of all columns, arrays one after the other.
ColumnNames column_names(const std::vector<Variable>& variables) {
  ColumnNames names;
  for (const Variable& variable : variables) {
    for (std::size_t c = 0; c < variable.columns.size(); ++c) {
      names.push_back(column_name(variable, c));
    }
  }
  return names;
}

/// The length of the arrays that make the recording: that of the most columns whose names are those of a sensor, of
/// equals that of the most numbers; 0 where no array has two samples.
std::size_t common_length(const std::vector<Variable>& variables) {
  struct Weight {
    std::size_t sensors = 0;
    std::size_t numbers = 0;
    auto operator<=>(const Weight&) const = default;
  };
  std::map<std::size_t, Weight> weights;
  const std::vector<ColumnRole> roles = infer_roles(column_names(variables));
  auto role = roles.begin();
  for (const Variable& variable : variables) {
    const std::size_t length = rows_of(variable);
    for (std::size_t c = 0; c < variable.columns.size(); ++c, ++role) {
      if (length >= 2) {
        weights[length].numbers += length;
        weights[length].sensors += is_sensor(*role) ? 1 : 0;
      }
    }
  }
  std::size_t best = 0;
  Weight most;
  for (const auto& [length, weight] : weights) {
    if (weight >= most) {
      most = weight;
      best = length;
    }
  }
  return best;
}

}  // namespace

Status deliver_variables(std::vector<Variable> variables, const DecodeLimits& limits, ColumnSink& sink) {
  for (Variable& variable : variables) {
    stand_up(variable);
  }
  const std::size_t length = common_length(variables);
  if (length == 0) {
    return fail(ErrorCode::NoSamples, "The file holds no array of two samples or more.");
  }
  Recorded recorded;
  std::vector<std::pair<std::string, double>> rates;
  std::string left_out;
  for (const Variable& variable : variables) {
    if (rows_of(variable) == length) {
      for (std::size_t c = 0; c < variable.columns.size(); ++c) {
        recorded.names.push_back(column_name(variable, c));
        recorded.columns.emplace_back(variable.columns[c]);
      }
      continue;
    }
    const double value = rows_of(variable) == 1 && variable.columns.size() == 1 ? variable.columns[0][0] : 0.0;
    if (is_sampling_rate(value) && is_rate_name(variable.name)) {
      rates.emplace_back(variable.name, value);
      continue;
    }
    left_out += (left_out.empty() ? "'" : ", '") + variable.name + "' (" + std::to_string(rows_of(variable)) + " x " +
                std::to_string(variable.columns.size()) + ")";
  }
  recorded.rate_hz = nearest_rate(rates, recorded.names.front(), sink);
  if (!left_out.empty()) {
    sink.note("Arrays of another length than " + std::to_string(length) + " are left out: " + left_out + ".");
  }
  for (const std::string& name : inertial_structs(recorded.names)) {
    sink.note("'" + name + "' is a struct of NaveGo by its members t, wb and fb: in s, rad/s and m/s^2.");
  }
  return deliver(recorded, limits, sink);
}

}  // namespace driftlab
