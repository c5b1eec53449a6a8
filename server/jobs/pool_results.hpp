#pragma once
/// What a job's recordings say together, and together with all that is stored of their device.
#include "schema/json/json.hpp"
#include "server/jobs/job_kind.hpp"

namespace driftlab::server {

/// Adds `replicates` and `trends` of the job's own recordings to its document, and to `results` the pooled document of
/// every sensor axis the job touched, over the latest results of the device with the job's own in place of older ones.
/// Conditions that the job did not touch are taken over from the stored document. Recordings of several devices in one
/// job are pooled for each device in `results`, and not in the document. What cannot be put
/// together is said in the document (core/campaign/pooled_sensor.hpp). Errors: those of the store and of pool_sensor.
[[nodiscard]] Status pool_results(Json& document, JobContext& context, const RunControl& control, JobResults& results);

}  // namespace driftlab::server
