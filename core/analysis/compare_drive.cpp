#include "core/analysis/drive.hpp"
#include "core/navigate/paper_scenario.hpp"

#include <algorithm>

namespace driftlab {
namespace {

constexpr std::string_view kOfDocument = "document";
constexpr std::string_view kWhiteOfDocument = "document-white";

/// The document's white noise and constant biases, without any slow error.
ImuModel white_part(ImuModel imu) {
  for (AxisModel& axis : imu.axes) {
    axis.processes =
        axis.processes.without([](const Process& process) { return process.kind->white_square == nullptr; });
  }
  return imu;
}

Result<drive::BelievedModel> believed_model(const DriveModel& asked, const drive::Document& document) {
  if (asked.imu) {
    return drive::BelievedModel{asked.name, "as given", *asked.imu};
  }
  if (asked.name == kOfDocument) {
    return drive::BelievedModel{asked.name, "as the document says", document.model};
  }
  if (asked.name == kWhiteOfDocument) {
    return drive::BelievedModel{asked.name, "the document's white noise and constant biases, no slow errors",
                                white_part(document.model)};
  }
  const auto gyroscope = paper_gyroscope(asked.name, document.model.axes[2].bias_sd, true);
  if (!gyroscope) {
    std::string known(kOfDocument);
    for (const std::string& name : known_drive_models()) {
      known += name == kOfDocument ? "" : ", " + name;
    }
    return fail(ErrorCode::InvalidArgument,
                "'" + asked.name + "' is no model of a comparison: it is one of " + known + ", or a model of your own.",
                {{"parameter", "models"}});
  }
  drive::BelievedModel model{asked.name, "the gyroscope of the paper's filter, the document's accelerometer",
                             document.model};
  std::copy(gyroscope->begin(), gyroscope->end(), model.imu.axes.begin());
  return model;
}

}  // namespace

const std::vector<std::string>& known_drive_models() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list{std::string(kOfDocument), std::string(kWhiteOfDocument)};
    const auto paper = paper_scenario("paper");
    for (const FilterCandidate& filter : paper->filters) {
      list.push_back(filter.name);
    }
    return list;
  }();
  return names;
}

Result<DriveComparisonReport> compare_drive_models(drive::Drive drive, const DriveRequest& request,
                                                   const RunControl& control) {
  std::vector<drive::BelievedModel> models;
  for (const DriveModel& asked : request.models) {
    auto model = believed_model(asked, drive.document);
    if (!model) {
      return fail(model.error());
    }
    models.push_back(std::move(*model));
  }
  const drive::FilterOptions options = options_of(request, drive.document);
  if (auto status = check_options(drive, options); !status) {
    return fail(status.error());
  }
  auto comparison =
      drive::compare_filters(drive, models, options, {.seed = request.seed, .fit_noise = request.fit_noise}, control);
  if (!comparison) {
    return fail(comparison.error());
  }
  return DriveComparisonReport{std::move(drive), options, request.fit_noise, std::move(*comparison)};
}

std::string sentence_of(const DriveComparisonReport& report) {
  std::string all;
  for (const std::string& sentence : drive::verdicts_of(report.comparison)) {
    all += (all.empty() ? "" : " ") + sentence;
  }
  return all;
}

}  // namespace driftlab
