#include "core/campaign/population_verdict.hpp"

#include "core/campaign/words.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>

namespace driftlab {
namespace {

constexpr std::size_t kMostNamed = 6;
constexpr std::size_t kFewestForFlags = 4;

/// A device that is not of the line, and by what.
struct Odd {
  std::string device;
  std::vector<std::string> by;
  std::string pointer;  ///< to its smallest p_holm
  double p_holm = 1.0;
};

std::string axis_of(const PopulationRow& row) {
  return std::string(sensor_of(row.quantity)) + (row.axis.empty() ? "" : " " + row.axis);
}

std::vector<Odd> odd_devices(const PopulationReport& report) {
  std::vector<Odd> odd;
  for (std::size_t r = 0; r < report.rows.size(); ++r) {
    const PopulationRow& row = report.rows[r];
    for (std::size_t d = 0; d < row.population.places.size(); ++d) {
      const DevicePlace& place = row.population.places[d];
      if (!place.outlying || !place.p_holm) {
        continue;
      }
      auto found = std::find_if(odd.begin(), odd.end(), [&](const Odd& one) { return one.device == place.device; });
      if (found == odd.end()) {
        odd.push_back({place.device, {}, "", 1.0});
        found = odd.end() - 1;
      }
      found->by.push_back(row.parameter + " of " + axis_of(row) + ", " + row.label);
      if (found->pointer.empty() || *place.p_holm < found->p_holm) {
        found->p_holm = *place.p_holm;
        found->pointer = "/rows/" + std::to_string(r) + "/places/" + std::to_string(d) + "/p_holm";
      }
    }
  }
  return odd;
}

std::string names_of(const std::vector<Odd>& odd) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < std::min(odd.size(), kMostNamed); ++i) {
    names.push_back(odd[i].device);
  }
  if (odd.size() > kMostNamed) {
    names.push_back(std::to_string(odd.size() - kMostNamed) + " more");
  }
  return joined(names);
}

void say_levels(const PopulationReport& report, Verdict& verdict) {
  for (const PopulationRow& row : report.rows) {
    const ReportedValue& mean = row.population.mean;
    if (row.parameter != "N" || !mean.value) {
      continue;
    }
    const double differ = row.population.differ_percent();
    verdict.details.push_back(
        "N of " + axis_of(row) + ", " + row.label + ": " + significant(*mean.value, mean.low, mean.high) + " " +
        mean.unit + ", " +
        (differ > 0.0 ? "devices differ by " + significant(differ) + " %" : "no difference between devices shows") +
        ".");
  }
}

}  // namespace

Verdict verdict_of(const PopulationReport& report) {
  Verdict verdict;
  const std::vector<Odd> odd = odd_devices(report);
  const std::size_t devices = report.devices.size();
  if (report.rows.empty()) {
    verdict.sentence = "No device has a parameter that could be compared.";
    verdict.details.emplace_back("Characterise a recording of each device at rest.");
    verdict.level = VerdictLevel::Look;
    return verdict;
  }
  if (odd.empty()) {
    verdict.sentence = "No device of " + std::to_string(devices) + " stands out.";
    verdict.details.emplace_back(devices < kFewestForFlags
                                     ? "Flags need four devices with results."
                                     : "Each lies where the others say that a further device of the model would.");
  } else {
    verdict.sentence = capital(counted(odd.size())) + " of " + std::to_string(devices) + " devices " +
                       (odd.size() == 1 ? "is" : "are") + " not of the line: " + names_of(odd) + ".";
    for (const Odd& one : odd) {
      verdict.details.push_back(one.device + " by " + joined(one.by) + ".");
      verdict.facts.emplace_back(one.pointer, one.p_holm);
    }
    verdict.details.emplace_back(
        "A line without an outlier shows one in some 5 % of cases, per parameter, axis and condition.");
    verdict.level = VerdictLevel::Look;
  }
  say_levels(report, verdict);
  return verdict;
}

std::optional<std::string> standing_out(const PopulationReport& report, const std::string& device) {
  for (const Odd& one : odd_devices(report)) {
    if (one.device == device) {
      return one.device + " is not of the line of the " + std::to_string(report.devices.size()) + " devices of " +
             report.model + ", by " + joined(one.by) + ".";
    }
  }
  return std::nullopt;
}

}  // namespace driftlab
