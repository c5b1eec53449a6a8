#include "schema/text/population.hpp"

#include "core/campaign/population_verdict.hpp"
#include "core/campaign/words.hpp"
#include "core/signal/number.hpp"
#include "core/signal/significant.hpp"
#include "core/signal/with_count.hpp"
#include "schema/text/fields.hpp"
#include "schema/text/printed.hpp"

namespace driftlab {
namespace {

std::string full_digits(const std::optional<double>& value) { return value ? to_text(*value) : ""; }

std::string percent(const Population& population) { return short_text(population.differ_percent()) + " %"; }

std::string axis_text(const PopulationRow& row) {
  return std::string(sensor_of(row.quantity)) + (row.axis.empty() ? "" : " " + row.axis) + ", " + row.label;
}

std::string interval_text(const std::optional<double>& low, const std::optional<double>& high) {
  return low && high ? "[" + significant(*low) + ", " + significant(*high) + "]" : "";
}

std::string names_of(const std::vector<LeftOut>& left_out) {
  std::string text;
  for (const LeftOut& one : left_out) {
    text += (text.empty() ? "" : ", ") + one.device;
  }
  return text;
}

std::string row_text(const PopulationRow& row) {
  const Population& population = row.population;
  std::string text = "  " + row.parameter + "  ";
  if (!row.reason.empty()) {
    return text + row.reason + "\n";
  }
  const ReportedValue& mean = population.mean;
  text += (mean.value ? significant(*mean.value, mean.low, mean.high) : "-") + " " +
          interval_text(mean.low, mean.high) + " " + population.unit + ", " +
          with_count(population.places.size(), "device") + "; devices differ by " + percent(population);
  if (population.predicted_low) {
    text += "; a further one lies in " + interval_text(population.predicted_low, population.predicted_high);
  }
  text += "\n";
  for (const DevicePlace& place : population.places) {
    if (place.outlying && place.estimate.value) {
      text += "     ! " + place.device + ": " +
              significant(*place.estimate.value, place.estimate.low, place.estimate.high) +
              " is outlying (z = " + in_tenths(place.z) + ", p = " + significant(place.p_holm.value_or(1.0)) +
              " corrected for " + with_count(population.places.size(), "device") + ")\n";
    }
  }
  if (!population.left_out.empty()) {
    text += "     without " + with_count(population.left_out.size(), "device that does", "devices that do") +
            " not identify it: " + names_of(population.left_out) + "\n";
  }
  return text;
}

}  // namespace

std::string populations_to_text(const PopulationReport& report) {
  std::string text = verdict_of(report).sentence + "\n" + report.model + ", " +
                     with_count(report.devices.size(), "device") +
                     ": mean [95 % interval], spread between devices (one standard deviation), 95 % prediction\n";
  std::string heading;
  for (const PopulationRow& row : report.rows) {
    if (axis_text(row) != heading) {
      heading = axis_text(row);
      text += "\n" + heading + "\n";
    }
    text += row_text(row);
  }
  return report.rows.empty() ? text + "\nNo device identifies a parameter.\n" : text;
}

std::string populations_to_markdown(const PopulationReport& report) {
  const Verdict verdict = verdict_of(report);
  std::string text = "**" + markdown_field(verdict.sentence) + "**\n\n" + markdown_field(report.model) + ", " +
                     with_count(report.devices.size(), "device") + ".\n";
  if (!report.rows.empty()) {
    text +=
        "\n| sensor | condition | parameter | unit | mean [95 %] | devices differ by | a further one lies in | devices "
        "| "
        "not of the line | left out |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  }
  for (const PopulationRow& row : report.rows) {
    const Population& population = row.population;
    const ReportedValue& mean = population.mean;
    std::vector<std::string> outlying;
    for (const DevicePlace& place : population.places) {
      if (place.outlying) {
        outlying.push_back(place.device);
      }
    }
    const bool described = row.reason.empty();
    text += "|";
    for (const std::string& cell :
         {std::string(sensor_of(row.quantity)) + (row.axis.empty() ? "" : " " + row.axis), row.label, row.parameter,
          population.unit,
          described && mean.value
              ? significant(*mean.value, mean.low, mean.high) + " " + interval_text(mean.low, mean.high)
              : row.reason,
          described ? percent(population) : std::string(),
          interval_text(population.predicted_low, population.predicted_high), std::to_string(population.places.size()),
          joined(outlying), names_of(population.left_out)}) {
      text += " " + markdown_field(cell) + " |";
    }
    text += "\n";
  }
  for (const std::string& detail : verdict.details) {
    text += (&detail == &verdict.details.front() ? "\n- " : "- ") + markdown_field(detail) + "\n";
  }
  return text;
}

std::string populations_to_csv(const PopulationReport& report) {
  std::string text =
      "sensor,axis,condition,parameter,unit,mean,mean low,mean high,spread,predicted low,predicted high,"
      "device,value,low,high,z,quantile,p,p holm,outlying\r\n";
  for (const PopulationRow& row : report.rows) {
    const Population& population = row.population;
    for (const DevicePlace& place : population.places) {
      const ReportedValue& mean = population.mean;
      for (const std::string& cell :
           {std::string(sensor_of(row.quantity)), row.axis, csv_field(row.label), row.parameter, population.unit,
            full_digits(mean.value), full_digits(mean.low), full_digits(mean.high),
            row.reason.empty() ? to_text(population.spread) : std::string(), full_digits(population.predicted_low),
            full_digits(population.predicted_high), csv_field(place.device), full_digits(place.estimate.value),
            full_digits(place.estimate.low), full_digits(place.estimate.high),
            row.reason.empty() ? to_text(place.z) : std::string(), full_digits(place.quantile), full_digits(place.p),
            full_digits(place.p_holm)}) {
        text += cell + ",";
      }
      text += place.outlying ? "yes\r\n" : "no\r\n";
    }
  }
  return text;
}

}  // namespace driftlab
