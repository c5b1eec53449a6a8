#pragma once
/// The table of a sensor axis as it is asked for most, and its trends, made once by the job that pools the axis.
///
/// To make it from the results takes the document of each, 16 kB a recording, from as many places of the disk; kept, it
/// is one row. It is the table of method gmwm with the model and the reference row that a request gets which names
/// none, and it stands for exactly the results that were pooled: newer ones are pooled by another job. What it says of
/// the device is compared with the device when it is read. A program of another version makes its own.
#include "schema/json/json.hpp"
#include "server/jobs/stored_table.hpp"

#include <optional>
#include <vector>

namespace driftlab::server {

/// For the results of a pooling, of these sources and what pools them; nothing where there is no such table.
[[nodiscard]] std::optional<Artefact> keep_table(Store& store, const SensorAxis& axis, std::vector<TableSource> sources,
                                                 const PooledSensor& pooled);

/// A table with its summary, as `/v1/parameter-tables` says it.
struct TableDocument {
  Json document;
  AxisPooling pooling;
};

/// What stored_table makes, as a document. Errors: those of stored_table.
[[nodiscard]] Result<TableDocument> table_document(Store& store, const StoredTableRequest& request);

/// The trends over that table (core/campaign/trend_table.hpp). Errors: those of stored_table.
[[nodiscard]] Result<TableDocument> trends_document(Store& store, const StoredTableRequest& request);

/// What stored_tables makes. Errors: those of stored_tables.
[[nodiscard]] Result<std::vector<TableDocument>> table_documents(Store& store, const StoredTableRequest& request);

}  // namespace driftlab::server
