#include "schema/json/characterise_recording.hpp"

#include "schema/json/characterisation.hpp"

namespace driftlab {

Result<Json> characterise_recording(const std::string& id, const RecordingSpec& spec, const RecordingView& view,
                                    const CharacteriseOptions& options, const RunControl& control) {
  std::vector<Json> channels;
  const auto count = static_cast<double>(view.channels.size());
  for (const ChannelView& channel : view.channels) {
    const auto done = static_cast<double>(channels.size());
    RunControl part;
    part.stop = control.stop;
    part.progress = [&](std::string_view stage, double fraction) {
      control.report(channel.column + ": " + std::string(stage), (done + fraction) / count);
    };
    const double factor = channel.role.unit ? channel.role.unit->factor : 1.0;
    auto result = characterise_channel({channel.values, view.window.time.dt_s, factor}, options, part);
    if (!result) {
      return fail(Error(result.error()).with("column", channel.column));
    }
    channels.push_back(to_json(ChannelIdentity{channel.column, channel.role}, *result));
  }
  return recording_document(id, spec, view.window, std::move(channels));
}

Json to_json(const CharacteriseOptions& options) {
  return Json{{"models", options.models},
              {"seed", options.seed},
              {"search", options.search == ModelSearch::Stepwise ? "stepwise" : "listed"},
              {"bootstrap", options.bootstrap}};
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
  reader.reject_unknown();
  if (auto checked = check_options(options); !checked) {
    const auto& fields = checked.error().fields;
    const bool replicates = !fields.empty() && fields.front().value == "bootstrap";
    faults.add(reader.pointer(replicates ? "bootstrap" : "models"), checked.error());
  }
  return options;
}

}  // namespace driftlab
