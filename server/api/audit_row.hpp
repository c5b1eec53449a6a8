#pragma once
/// Rows of the audit log as documents: in lists, in the daemon's log, and as lines of an export.
#include "schema/json/json.hpp"
#include "server/store/audit.hpp"

namespace driftlab::server {

[[nodiscard]] Json to_json(const AuditRow& row);
/// The inverse. Error: ParseError, for a line that is no such document.
[[nodiscard]] Result<AuditRow> audit_row_from_text(const std::string& line);

}  // namespace driftlab::server
