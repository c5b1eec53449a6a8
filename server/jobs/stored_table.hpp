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
  std::string model;           ///< empty: the best over all rows
  std::string reference = {};  ///< compact text of the condition that rows are compared with; empty: the first row
};

enum class PoolingState {
  Done,     ///< also where there is nothing to pool
  Pending,  ///< a job of kind `pool` is queued or runs: the table will change
  Failed,
};

/// `done`, `pending`, `failed`.
[[nodiscard]] std::string_view name_of(PoolingState state);

/// How far the recordings of a sensor axis are put together.
struct AxisPooling {
  PoolingState state = PoolingState::Done;
  std::string job;     ///< id of the job; empty where there is nothing to pool
  std::string reason;  ///< why it failed
};

struct StoredTable {
  ParameterTable table;
  AxisPooling pooling;  ///< method av takes nothing from joint fits: always done
};

/// Sets the samples of each source that the quality of its recording calls frozen. Errors: those of the store.
[[nodiscard]] Status tell_frozen(Store& store, std::vector<TableSource>& sources);

/// The field of an error that names the pool job to wait for.
inline constexpr std::string_view kPendingPool = "pool_job";

/// Errors: NotFound (device, or no result); InvalidArgument (a parameter, which the field "parameter" names; results in
/// units that do not convert into each other); those of the store.
[[nodiscard]] Result<StoredTable> stored_table(Store& store, const StoredTableRequest& request);

/// The request for the table of each axis of the sensor that has results, in order; the `axis` of this one is passed
/// over. Errors: those of stored_table; NotFound where no axis has any.
[[nodiscard]] Result<std::vector<StoredTableRequest>> requests_of_axes(Store& store, const StoredTableRequest& request);

/// The tables of these. Errors: theirs and those of stored_table.
[[nodiscard]] Result<std::vector<StoredTable>> stored_tables(Store& store, const StoredTableRequest& request);

}  // namespace driftlab::server
