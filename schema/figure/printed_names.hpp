#pragma once
/// Names and units of the field in print. What the names of documents are called stands in schema/names.json, which the
/// pages read as well; a name that is not listed there is printed with blanks for its underscores.
#include <span>
#include <string>
#include <string_view>

namespace driftlab {

/// A process: `gauss_markov` is Gauss-Markov, `white_noise` white noise.
[[nodiscard]] std::string process_name(std::string_view process);

/// A parameter: `sigma` is σ, `frequency_hz` frequency; its unit stands beside its values.
[[nodiscard]] std::string parameter_name(std::string_view parameter);

/// A column of a table: `gauss_markov_2.beta` is Gauss-Markov 2 β, `N` is N.
[[nodiscard]] std::string column_name(std::string_view key);

/// As in print: deg/√h, m/s².
[[nodiscard]] std::string printed_unit(std::string unit);

/// `text` with every `what` replaced.
[[nodiscard]] std::string replaced(std::string text, const std::string& what, const std::string& by);

struct PrintedName {
  std::string_view name;
  std::string_view printed;
};

/// The members of schema/names.json: a source that is made of it at configuration.
[[nodiscard]] std::span<const PrintedName> listed_processes();
[[nodiscard]] std::span<const PrintedName> listed_parameters();

}  // namespace driftlab
