/// Any text as the documents that clients send: parsed strictly, read with every fault located, and written again where
/// there is none. The first byte says which document; the rest is its text.
#include "schema/json/calibration.hpp"
#include "schema/json/characterise.hpp"
#include "schema/json/drive_document.hpp"
#include "schema/json/drive_request.hpp"
#include "schema/json/error_model.hpp"
#include "schema/json/outage_evaluation.hpp"
#include "schema/json/outage_scenario.hpp"
#include "schema/json/recording_spec.hpp"
#include "schema/json/recording_tags.hpp"
#include "schema/json/regression.hpp"
#include "schema/json/simulation_model.hpp"

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

namespace {

using namespace driftlab;

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

/// A document without a fault is written as one without a fault, which says the same.
template <class Read>
void survives_writing(const Json& document, const Read& read) {
  Faults faults;
  const auto value = read(document, faults);
  if (!faults.none()) {
    return;
  }
  Faults again;
  const Json written = to_json(value);
  const Json twice = to_json(read(written, again));
  require(again.none() && canonical_text(written) == canonical_text(twice));
}

void read_document(char kind, const Json& document) {
  Faults faults;
  switch (kind) {
    case 'b':
      (void)baseline_from_json(document, "/baseline", faults);
      break;
    case 'c':
      (void)calibration_from_json(document, "", faults);
      break;
    case 'd':
      (void)drive_from_json(document, faults);
      break;
    case 'e':
      (void)drive_request_from_json(document, "/parameters", faults);
      break;
    case 'm': {
      std::optional<Dimension> channel;
      (void)model_from_json(document, channel, "/processes", faults);
      break;
    }
    case 'o':
      survives_writing(document,
                       [](const Json& from, Faults& into) { return outage_options_from_json(from, "", into); });
      break;
    case 'r':
      (void)regression_from_json(document, faults);
      break;
    case 's':
      survives_writing(document, [](const Json& from, Faults& into) { return scenario_from_json(from, "", into); });
      break;
    case 't':
      survives_writing(document,
                       [](const Json& from, Faults& into) { return recording_tags_from_json(from, "", into); });
      break;
    case 'x':
      survives_writing(document,
                       [](const Json& from, Faults& into) { return characterise_options_from_json(from, "", into); });
      break;
    default:
      (void)recording_spec_from_json(document, "", faults);
  }
  if (!faults.none()) {
    require(!faults.error().message.empty() && !faults.error().fields.empty());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto document = parse_json(text);
  if (!document) {
    return 0;
  }
  const auto again = parse_json(canonical_text(*document));
  require(again && canonical_text(*again) == canonical_text(*document));
  read_document(static_cast<char>(data[0]), *document);
  return 0;
}
