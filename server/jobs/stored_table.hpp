#pragma once
/// A parameter table (schema/json/parameter_table.hpp) from stored results: what /v1/parameter-tables gives and what
/// jobs over a table read.
#include "schema/json/json.hpp"
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

/// Errors: NotFound (device, or no result); InvalidArgument, field "parameter"; those of the store.
[[nodiscard]] Result<Json> stored_table(Store& store, const StoredTableRequest& request);

}  // namespace driftlab::server
