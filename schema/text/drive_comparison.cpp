#include "schema/text/drive.hpp"
#include "schema/text/printed.hpp"

namespace driftlab {

std::string drive_comparison_to_text(const DriveComparisonReport& report) {
  const drive::FilterComparison& comparison = report.comparison;
  std::string text;
  for (const std::string& sentence : drive::verdicts_of(comparison)) {
    text += sentence + "\n";
  }
  text += "\n" + header_of_drive(report.drive) + "\nFilters (horizontal errors at the end of each outage):\n";
  text +=
      "filter             noise x gyro, acc.  outage    n  mean m   rms m [95 %]            NEES  in 50 %  in 95 %\n";
  for (const drive::ComparedFilter& filter : comparison.filters) {
    for (const drive::DurationSummary& d : filter.durations) {
      text +=
          printed("%-18s %8.3g %9.3g %6.0f s %4zu %7.2f %7.2f [%6.2f, %6.2f] %8.2f %8.2f %8.2f\n", filter.name.c_str(),
                  filter.gyro_noise, filter.force_noise, d.duration_s, d.outages.size(), d.mean_m, d.rms_m.value,
                  d.rms_m.ci95.low, d.rms_m.ci95.high, d.nees.value, d.coverage50.value, d.coverage95.value);
    }
  }
  text += "\nPaired over outages (mean error, less the other's):\n";
  text += "filter              against             outage  difference m [95 %]          relative % [95 %]\n";
  for (const drive::FilterDifference& pair : comparison.differences) {
    text += printed("%-19s %-19s %4.0f s %+8.3f [%+7.3f, %+7.3f] %+7.2f [%+6.2f, %+6.2f]%s\n", pair.filter.c_str(),
                    pair.against.c_str(), pair.duration_s, pair.difference_m.value, pair.difference_m.ci95.low,
                    pair.difference_m.ci95.high, 100.0 * pair.relative.value, 100.0 * pair.relative.ci95.low,
                    100.0 * pair.relative.ci95.high, pair.shown() ? "" : "  not shown");
  }
  std::vector<std::string> notes = report.drive.facts.notes;
  notes.insert(notes.end(), comparison.notes.begin(), comparison.notes.end());
  return text + notes_of_drive(notes);
}

}  // namespace driftlab
