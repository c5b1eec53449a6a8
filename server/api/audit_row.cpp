#include "server/api/audit_row.hpp"

namespace driftlab::server {

Json to_json(const AuditRow& row) {
  return Json{{"sequence", row.sequence},     {"at", rfc3339(row.at)},  {"at_us", row.at},
              {"actor", row.actor},           {"action", row.action},   {"object", row.object},
              {"request_id", row.request_id}, {"address", row.address}, {"detail", row.detail},
              {"previous", row.previous},     {"digest", row.digest}};
}

Result<AuditRow> audit_row_from_text(const std::string& line) {
  const auto document = parse_json(line);
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  ObjectReader reader(*document, "", faults);
  AuditRow row;
  row.sequence = reader.integer("sequence").value_or(0);
  row.at = reader.integer("at_us").value_or(0);
  row.actor = reader.text("actor").value_or("");
  row.action = reader.text("action").value_or("");
  row.object = reader.text("object").value_or("");
  row.request_id = reader.text("request_id").value_or("");
  row.address = reader.text("address").value_or("");
  row.detail = reader.text("detail").value_or("");
  row.previous = reader.text("previous").value_or("");
  row.digest = reader.text("digest").value_or("");
  if (!faults.none()) {
    return fail(faults.error());
  }
  return row;
}

}  // namespace driftlab::server
