#include "schema/json/recording_trace.hpp"

namespace driftlab {

Json to_json(const RecordingTrace& trace) {
  Json low = Json::array();
  Json high = Json::array();
  Json mean = Json::array();
  for (const TraceBucket& bucket : trace.buckets) {
    low.push_back(bucket.present > 0 ? number(bucket.low) : Json(nullptr));
    high.push_back(bucket.present > 0 ? number(bucket.high) : Json(nullptr));
    mean.push_back(bucket.present > 0 ? number(bucket.mean) : Json(nullptr));
  }
  Json missing = Json::array();
  for (const TimeSpan& span : trace.missing) {
    missing.push_back(Json::array({number(span.t0_s), number(span.t1_s)}));
  }
  Json flags = Json::array();
  for (const MarkedTime& marked : trace.marks) {
    flags.push_back(Json{{"kind", name_of(marked.mark)}, {"t0", number(marked.t0_s)}, {"t1", number(marked.t1_s)}});
    if (marked.mark == TraceMark::Gap) {
      flags.back()["missing"] = marked.missing;
    }
  }
  return Json{{"samples_per_bucket", trace.samples_per_bucket},
              {"time_s", numbers(trace.time_s)},
              {"min", std::move(low)},
              {"max", std::move(high)},
              {"mean", std::move(mean)},
              {"missing", std::move(missing)},
              {"flags", std::move(flags)},
              {"duration_s", number(trace.duration_s)},
              {"rate_hz", number(trace.rate_hz)}};
}

}  // namespace driftlab
