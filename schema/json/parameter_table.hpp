#pragma once
/// The parameter table (spec/results.md): one sensor axis of one device, a row per dynamic condition, a column per
/// parameter with unit and 95 % interval; the form of Tables 1, 2 and 4 of the seed paper (Radi, Nassar and El-Sheimy
/// 2017).
///
/// Method `av` takes the IEEE 952 coefficients of each channel, method `gmwm` the parameters of one model. Without a
/// model of the caller's choice it is the one with the smallest sum of the criterion over all rows, so that one
/// structure is shown for all conditions. Recordings of one condition are replicates: method gmwm shows their joint fit
/// (`pooling` is `joint`) where a pooled document of exactly these results exists (schema/json/pooled_sensor.hpp);
/// otherwise, and for method av, their values are averaged on the log scale with weights from their intervals
/// (`average`). `agreement` says whether they agree: the likelihood-ratio test of the joint fit, else Cochran's Q over
/// the parameters shown. A parameter that no replicate identifies is null, and its reason is given. `change` compares a
/// row with the first (the static one where there is one): `up` or `down` where the two 95 % intervals say so at 5 %
/// (difference of logs against the root of the summed squared half-widths), `none` where not, null where either is not
/// identified.
#include "core/signal/quantity.hpp"
#include "schema/json/json.hpp"

namespace driftlab {

enum class TableMethod { Av, Gmwm };

[[nodiscard]] std::string_view name_of(TableMethod method);
/// Error: InvalidArgument, field "parameter" = "method".
[[nodiscard]] Result<TableMethod> parse_table_method(std::string_view name);

/// One channel of one recording that takes part.
struct TableSource {
  std::string recording_id;
  std::string condition;       ///< compact text form (core/signal/condition.hpp)
  Json channel;                ///< one member of `channels` of a characterisation document
  std::string result_id = {};  ///< of the stored result; empty outside a store
};

struct TableRequest {
  std::string device;
  Quantity quantity = Quantity::AngularRate;
  std::string axis;
  TableMethod method = TableMethod::Gmwm;
  std::string model;  ///< empty: chosen by the criterion
};

/// The table as the JSON document of spec/results.md. Rows: static first, then by kind and value.
/// Errors: NotFound (no source); InvalidArgument (a model that no source was fitted with; sources of different units).
/// `pooled`: the pooled document of this sensor axis, or nullptr; entries that are not of these sources are passed
/// over.
[[nodiscard]] Result<Json> build_parameter_table(const TableRequest& request, const std::vector<TableSource>& sources,
                                                 const Json* pooled = nullptr);

/// Three columns per parameter (value, low, high) with units in the header; RFC 4180. Not identifiable: empty cells.
[[nodiscard]] std::string table_to_csv(const Json& table);

/// Aligned plain text for a terminal of any width: value with interval, `…` where not identifiable, ↑ ↓ for changes,
/// `*` at rows whose recordings hold gross errors or disagree; notes below say which.
[[nodiscard]] std::string table_to_text(const Json& table);

/// A pipe table for papers and issues, with the same notes below.
[[nodiscard]] std::string table_to_markdown(const Json& table);

}  // namespace driftlab
