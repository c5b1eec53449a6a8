#include "schema/text/outages.hpp"

#include "core/signal/angle.hpp"
#include "core/signal/with_count.hpp"
#include "schema/text/printed.hpp"

#include <algorithm>
#include <vector>

namespace driftlab {
namespace {

std::string decimal(double value, int decimals) { return printed("%.*f", decimals, value); }

/// value [low, high]
std::string with_interval(const Estimate& estimate, double factor, int decimals) {
  std::string text = decimal(estimate.value * factor, decimals);
  text.append(" [").append(decimal(estimate.ci95.low * factor, decimals)).append(", ");
  return text.append(decimal(estimate.ci95.high * factor, decimals)).append("]");
}

using Rows = std::vector<std::vector<std::string>>;

/// Columns as wide as their widest cell; the first is flush left, the others right.
std::string in_columns(const Rows& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()), 0);
    for (std::size_t c = 0; c < row.size(); ++c) {
      width[c] = std::max(width[c], row[c].size());
    }
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string gap(width[c] - row[c].size(), ' ');
      text.append(c == 0 ? "  " + row[c] + gap : "  " + gap + row[c]);
    }
    text.append("\n");
  }
  return text;
}

std::string filters_text(const OutageEvaluation& evaluation) {
  Rows rows{{"filter", "states", "mean error [m]"}};
  for (const OutageSummary& outage : evaluation.filters.front().outages) {
    rows.front().push_back("outage " + std::to_string(outage.index));
  }
  for (const char* const title : {"NEES (2)", "in 50 %", "in 95 %", "heading [deg]", "tilt [deg]"}) {
    rows.front().emplace_back(title);
  }
  for (const FilterEvaluation& filter : evaluation.filters) {
    std::vector<std::string> row{filter.name, std::to_string(filter.states),
                                 with_interval(filter.mean_error_m, 1.0, 2)};
    for (const OutageSummary& outage : filter.outages) {
      row.push_back(decimal(outage.error_m.value, 2));
    }
    row.push_back(with_interval(filter.nees, 1.0, 2));
    row.push_back(decimal(filter.coverage50, 2));
    row.push_back(decimal(filter.coverage95, 2));
    row.push_back(decimal(filter.heading_rms_rad / kDegree, 2));
    row.push_back(decimal(filter.tilt_rms_rad / kDegree, 3));
    rows.push_back(std::move(row));
  }
  return in_columns(rows);
}

void add_pair(Rows& rows, std::string title, const PairedDifference& pair) {
  rows.push_back({std::move(title), with_interval(pair.difference_m, 1.0, 3), with_interval(pair.relative, 100.0, 1)});
}

}  // namespace

std::string outage_text(const OutageReport& report) {
  const OutageEvaluation& evaluation = report.evaluation;
  std::string text = report.summary.sentence + "\n";
  for (const std::string& detail : report.summary.details) {
    text.append(detail).append("\n");
  }
  text.append("\nScenario ")
      .append(evaluation.scenario)
      .append(", ")
      .append(with_count(evaluation.runs, "run"))
      .append(", seed ");
  text.append(std::to_string(evaluation.seed)).append(evaluation.stopped_early ? " (precise enough)" : "");
  text.append(". Horizontal error at the end of each outage; 95 % intervals.\n\n").append(filters_text(evaluation));

  text.append("\nPaired differences (same data for every filter)\n");
  Rows rows{{"filter", "difference [m]", "relative [%]"}};
  for (const PairedDifference& pair : evaluation.paired) {
    if (pair.against == evaluation.filters.front().name) {
      add_pair(rows, pair.filter + " - " + pair.against, pair);
    }
  }
  if (const auto pair = evaluation.difference("M_dyn(GMWM)", "M_dyn(AV)")) {
    add_pair(rows, "M_dyn(GMWM) - M_dyn(AV)", *pair);
  }
  text.append(in_columns(rows));

  if (const auto& parts = report.attribution) {
    text.append("\nWhere the gain of M_dyn(GMWM) over M_stat(AV) comes from\n");
    Rows split{{"part", "difference [m]", "relative [%]"}};
    add_pair(split, "low-frequency process noise (M_stat(Neq)+RW - M_stat(AV))", parts->low_frequency_noise);
    add_pair(split, "Gauss-Markov states (M_stat(GMWM) - M_stat(Neq)+RW)", parts->gauss_markov_states);
    add_pair(split, "switching (M_dyn(GMWM) - M_stat(GMWM))", parts->switching);
    add_pair(split, "all together", parts->total);
    add_pair(split, "switching of Allan-variance noise alone (M_dyn(AV) - M_stat(AV))", parts->switching_av);
    text.append(in_columns(split));
  }
  if (!report.claims.empty()) {
    text.append("\nThe paper's claims in this simulation\n");
  }
  for (const Claim& claim : report.claims) {
    text.append(claim.supported ? "  supported:     " : "  not supported: ").append(claim.claim).append("\n");
    text.append("                 ").append(claim.because).append("\n");
  }
  return text;
}

}  // namespace driftlab
