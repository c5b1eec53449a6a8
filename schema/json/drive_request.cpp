#include "schema/json/drive_request.hpp"

#include "schema/json/drive.hpp"
#include "schema/json/drive_comparison.hpp"
#include "schema/json/drive_document.hpp"
#include "schema/json/imu_model.hpp"

namespace driftlab {
namespace {

constexpr int kMostSimulatedDrives = 1000;
constexpr std::size_t kMostModels = 16;

bool simulates(DriveQuestion question) {
  return question == DriveQuestion::Simulate || question == DriveQuestion::Explain;
}

Json models_to_json(const std::vector<DriveModel>& models) {
  Json list = Json::array();
  for (const DriveModel& model : models) {
    Json one{{"name", model.name}};
    if (model.imu) {
      one["model"] =
          Json{{"gyroscope", sensor_to_json(*model.imu, 0)}, {"accelerometer", sensor_to_json(*model.imu, 3)}};
    }
    list.push_back(std::move(one));
  }
  return list;
}

std::vector<DriveModel> models_from_json(const Json* list, const std::string& pointer, Faults& faults) {
  std::vector<DriveModel> models;
  if (list == nullptr || !list->is_array() || list->size() < 2 || list->size() > kMostModels) {
    faults.add(pointer, ErrorCode::InvalidArgument,
               "A comparison takes a list of 2 to " + std::to_string(kMostModels) + " models.");
    return models;
  }
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string where = pointer + "/" + std::to_string(i);
    ObjectReader reader((*list)[i], where, faults);
    DriveModel model{reader.required_text("name"), std::nullopt};
    if (const Json* const own = reader.member("model")) {
      model.imu = drive_model_from_json(*own, where + "/model", faults);
    } else if (const auto& known = known_drive_models();
               std::find(known.begin(), known.end(), model.name) == known.end()) {
      faults.add(where + "/name", ErrorCode::InvalidArgument,
                 "driftlab knows no model '" + model.name + "'; give it beside the name.");
    }
    reader.reject_unknown();
    models.push_back(std::move(model));
  }
  return models;
}

}  // namespace

Json to_json(const DriveRequest& request) {
  Json document{{"question", name_of(request.question)},
                {"velocity_constraint", request.velocity_constraint},
                {"seed", request.seed}};
  if (request.question != DriveQuestion::Explain) {
    document["zero_velocity"] = request.zero_velocity;
    document["odometer"] = request.odometer;
    document["estimate"] = request.estimate;
  }
  if (simulates(request.question)) {
    document["runs"] = request.runs;
  } else {
    document["gate"] = number(request.gate);
    document["as_stamped"] = request.as_stamped;
  }
  if (request.question == DriveQuestion::Compare) {
    document["models"] = models_to_json(request.models);
    document["fit_noise"] = request.fit_noise;
  }
  return document;
}

DriveRequest drive_request_from_json(const Json& document, const std::string& pointer, Faults& faults) {
  DriveRequest request;
  ObjectReader reader(document, pointer, faults);
  const auto refuse = [&](std::string_view name, std::string sentence) {
    faults.add(reader.pointer(name), ErrorCode::InvalidArgument, std::move(sentence));
  };
  if (const auto question = reader.text("question")) {
    const auto parsed = parse_drive_question(*question);
    request.question = parsed.value_or(DriveQuestion::Run);
    if (!parsed) {
      refuse("question", "What is asked of a drive is run, simulate, explain or compare.");
    }
  }
  /// A member that only some questions take; absent, the default.
  const auto taken = [&](std::string_view name, bool takes) -> const Json* {
    const Json* const value = reader.member(name);
    if (value != nullptr && !takes) {
      refuse(name, "The question " + std::string(name_of(request.question)) + " takes no `" + std::string(name) + "`.");
    }
    return takes ? value : nullptr;
  };
  const auto flag = [&](std::string_view name, bool takes, bool& into) {
    if (const Json* const value = taken(name, takes)) {
      into = value->is_boolean() && value->get<bool>();
      if (!value->is_boolean()) {
        refuse(name, "True or false belongs here.");
      }
    }
  };
  const bool explains = request.question == DriveQuestion::Explain;
  const bool compares = request.question == DriveQuestion::Compare;
  const bool runs = !simulates(request.question);
  flag("velocity_constraint", true, request.velocity_constraint);
  flag("zero_velocity", !explains, request.zero_velocity);
  flag("odometer", !explains, request.odometer);
  flag("estimate", !explains, request.estimate);
  flag("as_stamped", runs, request.as_stamped);
  flag("fit_noise", compares, request.fit_noise);
  if (const Json* const models = taken("models", compares); compares) {
    request.models = models_from_json(models, reader.pointer("models"), faults);
  }
  if (taken("gate", runs) != nullptr) {
    request.gate = reader.real("gate").value_or(0.0);
    if (!(request.gate >= 0.0)) {
      refuse("gate", "A number of at least 0 belongs here; 0: every fix is taken.");
    }
  }
  const std::int64_t seed = reader.integer("seed").value_or(1);
  if (seed < 0) {
    refuse("seed", "A seed is a whole number of at least 0.");
  } else {
    request.seed = static_cast<std::uint64_t>(seed);
  }
  if (taken("runs", !runs) != nullptr) {
    const std::int64_t count = reader.integer("runs").value_or(request.runs);
    if (count < 1 || count > kMostSimulatedDrives) {
      refuse("runs", "The simulated drives are 1 to " + std::to_string(kMostSimulatedDrives) + ".");
    } else {
      request.runs = static_cast<int>(count);
    }
  }
  reader.reject_unknown();
  return request;
}

Json to_json(const DriveAnswer& answer) {
  return std::visit([](const auto& report) { return driftlab::to_json(report); }, answer);
}

}  // namespace driftlab
