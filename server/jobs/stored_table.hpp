#pragma once
/// A parameter table (core/campaign/parameter_table.hpp) from stored results: what /v1/parameter-tables gives and what
/// jobs over a table read.
#include "core/campaign/parameter_table.hpp"
#include "server/store/store.hpp"

namespace driftlab::server {

/// The table's query parameters, as people write them.
struct StoredTableRequest {
  std::string device;  ///< id or name
  std::string sensor = "gyroscope";
  std::string axis;  ///< empty: channels that have none
  std::string method = "gmwm";
  std::string model;  ///< empty: the best over all rows
};

/// Errors: NotFound (device, or no result); InvalidArgument (a parameter, which the field "parameter" names; results in
/// units that do not convert into each other); those of the store.
[[nodiscard]] Result<ParameterTable> stored_table(Store& store, const StoredTableRequest& request);

}  // namespace driftlab::server
