#include "schema/text/outages.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace driftlab {
namespace {

using ::testing::HasSubstr;

TEST(OutageText, TellsFiltersDifferencesAndClaimsInColumns) {
  OutageScenario scenario = *paper_scenario("paper");
  scenario.drive.duration_s = 102.0;
  std::erase_if(scenario.drive.segments, [](const Segment& s) { return s.start_s > 100.0; });
  scenario.outages.resize(1);
  scenario.imu_rate_hz = 20.0;
  OutageOptions options;
  options.runs = 3;
  const OutageReport report = *report_outages(scenario, options);
  const std::string text = outage_text(report);
  for (const char* const word : {"M_stat(Neq)+RW", "switching", "NEES", "supported:", "3 runs, seed"}) {
    EXPECT_THAT(text, HasSubstr(word));
  }
  // The table of filters: one line for the heads and one for each filter, all of one length, for figures stand flush
  // right.
  std::istringstream lines(text.substr(text.find("  filter ")));
  std::vector<std::size_t> lengths;
  for (std::string line; std::getline(lines, line) && !line.empty();) {
    lengths.push_back(line.size());
  }
  ASSERT_EQ(lengths.size(), 1 + report.evaluation.filters.size());
  EXPECT_EQ(std::ranges::count(lengths, lengths.front()), static_cast<std::ptrdiff_t>(lengths.size()));
}

}  // namespace
}  // namespace driftlab
