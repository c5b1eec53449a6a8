#include "schema/json/drive_request.hpp"

#include "schema/json/drive.hpp"

namespace driftlab {
namespace {

constexpr int kMostSimulatedDrives = 1000;

}  // namespace

Json to_json(const DriveRequest& request) {
  Json document{{"question", name_of(request.question)},
                {"velocity_constraint", request.velocity_constraint},
                {"seed", request.seed}};
  if (request.question != DriveQuestion::Explain) {
    document["zero_velocity"] = request.zero_velocity;
    document["odometer"] = request.odometer;
  }
  if (request.question == DriveQuestion::Run) {
    document["gate"] = number(request.gate);
    document["as_stamped"] = request.as_stamped;
  } else {
    document["runs"] = request.runs;
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
      refuse("question", "What is asked of a drive is run, simulate or explain.");
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
  const bool runs = request.question == DriveQuestion::Run;
  flag("velocity_constraint", true, request.velocity_constraint);
  flag("zero_velocity", !explains, request.zero_velocity);
  flag("odometer", !explains, request.odometer);
  flag("as_stamped", runs, request.as_stamped);
  if (taken("gate", runs) != nullptr) {
    request.gate = reader.real("gate").value_or(0.0);
    if (!(request.gate >= 0.0)) {
      refuse("gate", "A number of at least 0 belongs here; 0: every fix is taken.");
    }
  }
  const std::int64_t seed = reader.integer("seed").value_or(1);
  if (seed < 0) {
    refuse("seed", "A seed is a whole number of at least 0.");
  }
  request.seed = static_cast<std::uint64_t>(std::max<std::int64_t>(seed, 0));
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
