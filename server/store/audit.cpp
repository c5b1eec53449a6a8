#include "server/store/audit.hpp"

#include "server/store/digest.hpp"

namespace driftlab::server {

std::string digest_of(const AuditRow& row) {
  std::string text;
  for (const std::string& part : {row.previous, std::to_string(row.sequence), std::to_string(row.at), row.actor,
                                  row.action, row.object, row.request_id, row.address, row.detail}) {
    text += std::to_string(part.size()) + ':' + part + ',';
  }
  return sha256_hex(text);
}

AuditWalk::AuditWalk() { verdict_.head = std::string(64, '0'); }

bool AuditWalk::take(const AuditRow& row) {
  if (!verdict_.fault.empty()) {
    return false;
  }
  const std::int64_t expected = verdict_.rows + 1;
  if (row.sequence != expected) {
    verdict_.fault = "Row " + std::to_string(expected) + " is missing; row " + std::to_string(row.sequence) +
                     " stands where it belongs.";
  } else if (row.previous != verdict_.head) {
    verdict_.fault = "Row " + std::to_string(row.sequence) + " does not follow the row before it.";
  } else if (row.digest != digest_of(row)) {
    verdict_.fault = "Row " + std::to_string(row.sequence) + " was altered: it does not have the digest it states.";
  } else {
    verdict_.rows = row.sequence;
    verdict_.head = row.digest;
  }
  return verdict_.fault.empty();
}

}  // namespace driftlab::server
