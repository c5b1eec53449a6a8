#include "server/store/pool_job.hpp"

#include "server/store/digest.hpp"

#include <algorithm>

namespace driftlab::server {

NewJob pool_job(const SensorAxis& axis, std::vector<std::string> members) {
  std::sort(members.begin(), members.end());
  std::string list;
  for (const std::string& member : members) {
    list.append(list.empty() ? "\"" : ",\"").append(member).append("\"");
  }
  NewJob job;
  job.kind = kPoolKind;
  job.request_json.append(R"({"algorithm_version":)").append(std::to_string(kPoolVersion));
  job.request_json.append(R"(,"inputs":{"axis":")").append(axis.axis).append(R"(","device":")").append(axis.device_id);
  job.request_json.append(R"(","members":[)").append(list).append(R"(],"quantity":")").append(axis.quantity);
  job.request_json.append(R"("},"kind":"pool","parameters":{}})");
  job.unique_key = sha256_hex(job.request_json);
  return job;
}

}  // namespace driftlab::server
