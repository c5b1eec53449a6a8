#include "server/jobs/recording_calibration.hpp"

#include "schema/json/calibration.hpp"

namespace driftlab::server {

Result<Calibration> calibration_of(Store& store, const RecordingSpec& spec, std::string_view device_id) {
  if (spec.calibration.empty()) {
    return Calibration{};
  }
  auto stored = store.calibration(spec.calibration);
  if (!stored && stored.error().code != ErrorCode::NotFound) {
    return fail(stored.error());
  }
  if (!stored || stored->device_id != device_id) {
    return fail(ErrorCode::InvalidArgument, "The device has no calibration " + spec.calibration + ".",
                {{"parameter", "calibration"}});
  }
  auto document = parse_json(stored->document_json);
  if (!document) {
    return fail(document.error());
  }
  Faults faults;
  Calibration calibration = calibration_from_json((*document)["calibration"], "/calibration", faults);
  return faults.none() ? Result<Calibration>(std::move(calibration)) : fail(faults.error());
}

}  // namespace driftlab::server
