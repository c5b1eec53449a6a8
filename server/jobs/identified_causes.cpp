#include "server/jobs/identified_causes.hpp"

#include "schema/json/json.hpp"
#include "server/jobs/every_row.hpp"

#include <utility>

namespace driftlab::server {
namespace {

/// The identified causes of one recording of an investigation. Channels are written `recording/column`.
std::set<std::string> causes_of(const Json& findings, const std::string& name) {
  std::set<std::string> causes;
  for (const Json& finding : findings) {
    if (finding.value("status", "") != "identified") {
      continue;
    }
    for (const Json& channel : finding.value("channels", Json::array())) {
      if (channel.is_string() && channel.get<std::string>().starts_with(name + "/")) {
        causes.insert(finding.value("cause", ""));
      }
    }
  }
  return causes;
}

}  // namespace

Result<CausesByRecording> identified_causes(Store& store, const std::string& device_id) {
  CausesByRecording causes;
  Status jobs;
  InvestigationFilter filter;
  filter.device_id = device_id;
  const Status read =
      for_each_row([&](const Page& page) { return store.investigations(filter, page); },
                   [&](const Investigation& row) {
                     const auto job = store.job(row.job_id);
                     if (!job && job.error().code == ErrorCode::NotFound) {
                       return;  // it was removed between two pages
                     }
                     const auto request = job ? parse_json(job->request_json) : fail(job.error());
                     const auto findings = parse_json(row.summary_json);
                     if (!request || !findings) {
                       jobs = jobs && !request ? Status(fail(request.error())) : jobs;
                       return;
                     }
                     for (const Json& recording : (*request)["inputs"].value("recordings", Json::array())) {
                       causes.emplace(recording.value("id", ""),  // the newest comes first and stays
                                      RecordingCauses{recording.value("revision", std::int64_t{1}),
                                                      causes_of(*findings, recording.value("name", ""))});
                     }
                   },
                   PageOrder::NewestFirst);
  if (!read) {
    return fail(read.error());
  }
  return jobs ? Result<CausesByRecording>(std::move(causes)) : fail(jobs.error());
}

}  // namespace driftlab::server
