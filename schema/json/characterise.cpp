#include "schema/json/characterise.hpp"

#include "schema/json/characterisation.hpp"
#include "schema/json/measured_temperature.hpp"

#include <algorithm>
#include <array>

namespace driftlab {
namespace {

struct FurtherName {
  const char* name;
  bool FurtherRequest::* member;
};

constexpr std::array<FurtherName, 3> kFurther{
    {{"total", &FurtherRequest::total}, {"theo1", &FurtherRequest::theo1}, {"psd", &FurtherRequest::psd}}};

/// The curves that `also` names.
FurtherRequest further_from_json(const Json& names, const std::string& pointer, Faults& faults) {
  FurtherRequest request;
  for (const Json& name : names.is_array() ? names : Json::array({names})) {
    const auto known = std::find_if(kFurther.begin(), kFurther.end(),
                                    [&](const FurtherName& one) { return name.is_string() && name == one.name; });
    if (known == kFurther.end()) {
      faults.add(pointer, ErrorCode::InvalidArgument, "Beside the variances there are 'total', 'theo1' and 'psd'.");
    } else {
      request.*(known->member) = true;
    }
  }
  return request;
}

Json to_json(const ReferenceAlignment& alignment) {
  Json document{{"column", alignment.reference}, {"applied", alignment.applied}, {"delay", nullptr}};
  if (const auto& found = alignment.estimate) {
    document["delay"] = quantity(found->delay_s, 1.0, "s");
    document["gain"] = number(found->gain);
    document["correlation"] = number(found->correlation);
    document["warnings"] = found->warnings;
  }
  if (!alignment.reason.empty()) {
    document["reason"] = alignment.reason;
  }
  return document;
}

}  // namespace

Json to_json(const CharacterisedRecording& recording) {
  std::vector<Json> channels;
  for (const CharacterisedChannel& channel : recording.channels) {
    channels.push_back(to_json(ChannelIdentity{channel.column, channel.role}, channel.result));
    if (channel.reference) {
      channels.back()["reference"] = to_json(*channel.reference);
    }
  }
  Json document = recording_document(recording.spec.id, recording.spec, recording.window, std::move(channels));
  if (recording.temperature) {
    document["quality"]["temperature"] = to_json(*recording.temperature);
  }
  if (!recording.spec.calibration.empty()) {
    document["calibration"] = recording.spec.calibration;
  }
  return document;
}

Json to_json(const CharacteriseOptions& options) {
  Json settings{{"models", options.models},
                {"seed", options.seed},
                {"search", options.search == ModelSearch::Stepwise ? "stepwise" : "listed"},
                {"bootstrap", options.bootstrap}};
  for (const auto& [name, member] : kFurther) {
    if (options.also.*member) {
      settings["also"].push_back(name);
    }
  }
  if (options.also.taus > 0) {
    settings["taus"] = options.also.taus;
  }
  if (options.dynamic > 0) {
    settings["dynamic"] = options.dynamic;
  }
  if (options.from_tau_s > 0.0) {
    settings["from_tau_s"] = number(options.from_tau_s);
  }
  return settings;
}

CharacteriseOptions characterise_options_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  CharacteriseOptions options;
  ObjectReader reader(document, pointer, faults);
  if (const Json* const models = reader.member("models")) {
    options.models.clear();
    if (models->is_array()) {
      for (const Json& model : *models) {
        options.models.push_back(model.is_string() ? model.get<std::string>() : "");
      }
    } else {
      faults.add(reader.pointer("models"), ErrorCode::ParseError, "The models must be an array of model names.");
    }
  }
  if (const auto seed = reader.integer("seed")) {
    if (*seed < 0) {
      faults.add(reader.pointer("seed"), ErrorCode::InvalidArgument, "The seed must not be negative.");
    }
    options.seed = static_cast<std::uint64_t>(*seed);
  }
  if (const auto search = reader.text("search")) {
    if (*search != "listed" && *search != "stepwise") {
      faults.add(reader.pointer("search"), ErrorCode::InvalidArgument, "The search is 'listed' or 'stepwise'.");
    }
    options.search = *search == "stepwise" ? ModelSearch::Stepwise : ModelSearch::Listed;
  }
  if (const auto replicates = reader.integer("bootstrap")) {
    options.bootstrap = *replicates < 0 ? 1 : static_cast<std::size_t>(*replicates);  // 1 is refused below
  }
  if (const auto windows = reader.integer("dynamic")) {
    options.dynamic = *windows < 0 ? 1 : static_cast<std::size_t>(*windows);  // 1 is refused below
  }
  if (const Json* const also = reader.member("also")) {
    options.also = further_from_json(*also, reader.pointer("also"), faults);
  }
  if (const auto taus = reader.integer("taus")) {
    options.also.taus = *taus < 0 ? 1 : static_cast<std::size_t>(*taus);  // 1 is refused below
  }
  options.from_tau_s = reader.real("from_tau_s").value_or(0.0);
  reader.reject_unknown();
  if (auto checked = check_options(options); !checked) {
    const auto& fields = checked.error().fields;
    const std::string member = fields.empty() ? "models" : fields.front().value;
    faults.add(reader.pointer(member), checked.error());
  }
  return options;
}

}  // namespace driftlab
