#include "core/campaign/verdict.hpp"

#include "core/campaign/channel_closeness.hpp"
#include "core/campaign/words.hpp"
#include "core/signal/significant.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

namespace driftlab {
namespace {

std::string p_text(double p) {
  if (p < kRejected) {
    return "p < 0.01";
  }
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "p = %.2f", p);
  return buffer.data();
}

std::string written(const ReportedValue& value) {
  return significant(value.value.value_or(0.0), value.low, value.high) + (value.unit.empty() ? "" : " " + value.unit);
}

const ReportedValue* parameter(const ReportedProcess& process, std::string_view name) {
  for (const auto& [key, value] : process.parameters) {
    if (key == name && value.value) {
      return &value;
    }
  }
  return nullptr;
}

/// 1/beta with its interval; empty where beta is zero or unknown.
std::string correlation_time(const ReportedValue& beta) {
  const auto inverse = [](const std::optional<double>& x) {
    return x && *x > 0.0 ? std::optional<double>(1.0 / *x) : std::nullopt;
  };
  const auto time_s = inverse(beta.value);
  return time_s ? significant(*time_s, inverse(beta.high), inverse(beta.low)) + " s" : std::string();
}

/// A process in words, with its figure; empty where the data do not identify its level.
std::string phrase_of(const ReportedProcess& process) {
  const ReportedValue* level = process.parameters.empty() ? nullptr : &process.parameters.front().second;
  if (level == nullptr || !level->value) {
    return {};
  }
  if (process.process == "white_noise") {
    return "white noise of " + written(*level);
  }
  if (process.process == "gauss_markov") {
    const ReportedValue* const beta = parameter(process, "beta");
    const std::string time = beta != nullptr ? correlation_time(*beta) : std::string();
    return "a Gauss-Markov bias of " + written(*level) + (time.empty() ? "" : " with a correlation time of " + time);
  }
  std::string name = process.process;
  std::replace(name.begin(), name.end(), '_', ' ');
  return (name == "random walk"    ? "a random walk of "
          : name == "linear drift" ? "a drift of "
                                   : name + " of ") +
         written(*level);
}

std::string figures_of(const ReportedFit& fit) {
  std::vector<std::string> phrases;
  for (const ReportedProcess& process : fit.processes) {
    if (std::string phrase = phrase_of(process); !phrase.empty()) {
      phrases.push_back(std::move(phrase));
    }
  }
  return joined(phrases);
}

void add_facts(const ReportedFit& best, Verdict& verdict) {
  if (best.j_test) {
    verdict.facts.emplace_back("/fits/0/j_test/p", best.j_test->p);
  }
  for (std::size_t i = 0; i < best.processes.size(); ++i) {
    for (const auto& [name, value] : best.processes[i].parameters) {
      if (value.value) {
        verdict.facts.emplace_back("/fits/0/processes/" + std::to_string(i) + "/params/" + name + "/value",
                                   *value.value);
      }
    }
  }
}

void raise(Verdict& verdict, VerdictLevel level) { verdict.level = std::max(verdict.level, level); }

/// Whether a model describes the recording, and which.
void say_fit(const ReportedChannel& channel, Verdict& verdict) {
  const ReportedFit& best = channel.fits.front();
  const std::string figures = figures_of(best);
  if (!best.j_test) {
    verdict.sentence = best.model + " is ranked first, and leaves too few scales to test whether it fits" +
                       (figures.empty() ? "" : ": " + figures) + ".";
    raise(verdict, VerdictLevel::Look);
    return;
  }
  const std::string p = p_text(best.j_test->p);
  if (best.fits()) {
    verdict.sentence =
        best.model + " describes this recording (J test " + p + ")" + (figures.empty() ? "" : ": " + figures) + ".";
    return;
  }
  raise(verdict, VerdictLevel::Look);
  const auto other = std::ranges::find_if(channel.fits, &ReportedFit::fits);
  const auto accepted = other != channel.fits.end() ? other->j_test : std::nullopt;
  if (accepted) {
    verdict.sentence = best.model + ", ranked first by the criterion, does not fit (J test " + p + "); " +
                       other->model + " does (" + p_text(accepted->p) + ")" +
                       (figures_of(*other).empty() ? "" : ": " + figures_of(*other)) + ".";
    return;
  }
  verdict.sentence = (channel.fits.size() == 1 ? best.model + " does not describe this recording (J test " + p + ")"
                                               : "None of " + counted(channel.fits.size()) +
                                                     " candidates describes this recording (J test " + p +
                                                     " for the best, " + best.model + ")") +
                     ".";
  if (!figures.empty()) {
    verdict.details.push_back("The closest has " + figures + "; its intervals are too short.");
  }
}

void say_shape(const ReportedChannel& channel, const GrossErrorEvidence& evidence, Verdict& verdict) {
  if (channel.contaminated()) {
    verdict.sentence += " Gross errors move its variances: the figures are from robust ones.";
    raise(verdict, VerdictLevel::Look);
  } else if (evidence.not_gaussian) {
    verdict.sentence += " The noise is not Gaussian, so the robust figures do not replace the classical ones.";
    raise(verdict, VerdictLevel::Look);
  }
  if (evidence.disjoint_scales > 0) {
    verdict.details.push_back("Classical and robust variance are disjoint at " +
                              std::to_string(evidence.disjoint_scales) + " of " + std::to_string(evidence.scales) +
                              " scales.");
  }
}

/// The criterion weighs parameters by ln N, closeness to the data by 2: what is ranked first may be implausible.
void say_closest(const ReportedChannel& channel, Verdict& verdict) {
  const ReportedFit& best = channel.fits.front();
  const auto distances = distances_2p(channel);
  const auto closest = std::find(distances.begin(), distances.end(), std::optional<double>(0.0));
  if (const std::optional<double>& behind = distances.front(); behind && closest != distances.end()) {
    verdict.details.push_back(best.model + " is ranked first by the criterion; " +
                              channel.fits[static_cast<std::size_t>(closest - distances.begin())].model +
                              " is closer to the data, by " + significant(*behind) +
                              " in distance + 2p, of which 6 are chance.");
  }
}

void say_rivals(const ReportedChannel& channel, Verdict& verdict) {
  const ReportedFit& best = channel.fits.front();
  const auto plausible = static_cast<std::size_t>(
      std::count_if(channel.fits.begin() + 1, channel.fits.end(), [](const ReportedFit& f) { return f.plausible; }));
  const bool closer = std::any_of(channel.fits.begin(), channel.fits.end(), [](const auto& f) { return f.plausible; });
  if (closer && !best.plausible) {
    say_closest(channel, verdict);
  } else if (channel.fits.size() > 1) {
    verdict.details.push_back(plausible == 0 ? "No other candidate is plausible."
                              : plausible == 1
                                  ? "One more model is plausible: the data cannot tell it from the best."
                                  : capital(counted(plausible)) +
                                        " more models are plausible: the data cannot tell them from the best.");
  }
  for (const ReportedProcess& process : best.processes) {
    for (const auto& [name, value] : process.parameters) {
      if (!value.value && !value.reason.empty()) {
        verdict.details.push_back(name + ": " + value.reason);
      }
    }
  }
  const auto said = [&](const std::string& warning) {
    return warning.find("J-test") != std::string::npos ||
           std::any_of(verdict.details.begin(), verdict.details.end(),
                       [&](const std::string& detail) { return detail.ends_with(warning); });
  };
  for (const std::string& warning : best.warnings) {
    if (!said(warning)) {
      verdict.details.push_back(warning);
    }
  }
}

/// The first column whose parameter is a white noise, or nothing.
std::optional<std::size_t> white_column(const ParameterTable& table) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].key == "N" || table.columns[c].key == "white_noise.N") {
      return c;
    }
  }
  return std::nullopt;
}

/// Where a table holds its white-noise density: N at low frequencies, whatever the model, and where no recording has
/// one the parameter of the model's white noise (or the Allan deviation's N).
struct DensityOf {
  std::optional<std::size_t> column;  ///< nothing: the density of the row
  const TableCell& operator()(const TableRow& row) const { return column ? row.cells[*column] : row.density; }
};

std::optional<DensityOf> density_of(const ParameterTable& table) {
  if (table.method == TableMethod::Gmwm && table.rows[table.reference].density.estimate.value) {
    return DensityOf{std::nullopt};
  }
  const auto column = white_column(table);
  return column ? std::optional(DensityOf{column}) : std::nullopt;
}

/// The white-noise densities of all rows: at the reference, and how many of the others moved.
void say_levels(const ParameterTable& table, const DensityOf& density, Verdict& verdict) {
  const TableRow& reference = table.rows[table.reference];
  const ReportedValue& first = density(reference).estimate;
  if (!first.value) {
    verdict.sentence = "The white-noise density N is not identified under the condition " + reference.label + ".";
    return;
  }
  verdict.sentence = "The white-noise density N is " + written(first) + " (" + reference.label + ")";
  std::size_t moved = 0;
  std::size_t compared = 0;
  const TableRow* highest = nullptr;
  double most = 0.0;
  for (const TableRow& row : table.rows) {
    const TableCell& cell = density(row);
    if (&row == &reference || !cell.estimate.value) {
      continue;
    }
    ++compared;
    moved += cell.change && *cell.change != Change::None ? 1U : 0U;
    if (highest == nullptr || *cell.estimate.value > most) {
      highest = &row;
      most = *cell.estimate.value;
    }
  }
  if (highest == nullptr) {
    verdict.sentence += ".";
    return;
  }
  verdict.sentence += " and " + written(density(*highest).estimate) + " at " + highest->label +
                      (compared > 1 ? ", the highest" : "") + ".";
  if (moved == 0) {
    verdict.sentence += " No change against " + reference.label + " is shown.";
  } else {
    verdict.sentence += " It moves";
    if (compared > 1) {
      verdict.sentence += moved == compared
                              ? " under every other condition"
                              : " under " + counted(moved) + " of " + counted(compared) + " other conditions";
    }
    verdict.sentence += ": a model of " + reference.label + " alone is wrong for this device in motion.";
    raise(verdict, VerdictLevel::Look);
  }
}

/// Whether one structure serves every condition, and how the model of the table is right beside it.
void say_structure(const ParameterTable& table, Verdict& verdict) {
  if (table.structure && !table.structure->statement.empty()) {
    verdict.details.push_back(table.structure->statement);
  }
  if (!table.model_note.empty()) {
    verdict.details.push_back(table.model_note);
  }
}

}  // namespace

std::string_view name_of(VerdictLevel level) {
  return level == VerdictLevel::Fine ? "fine" : level == VerdictLevel::Look ? "look" : "wrong";
}

GrossErrorEvidence evidence_of(const Contamination& contamination, std::size_t scales) {
  return {contamination.not_gaussian, contamination.disjoint_scales.size(), scales};
}

std::optional<std::size_t> gravest_of(std::span<const Verdict> verdicts) {
  const auto gravest = std::max_element(verdicts.begin(), verdicts.end(),
                                        [](const Verdict& a, const Verdict& b) { return a.level < b.level; });
  return gravest == verdicts.end() ? std::nullopt : std::optional(static_cast<std::size_t>(gravest - verdicts.begin()));
}

Verdict verdict_of(const ReportedChannel& channel, const GrossErrorEvidence& evidence) {
  Verdict verdict;
  if (channel.fits.empty()) {
    verdict.sentence = "No model could be fitted to this channel.";
    verdict.level = VerdictLevel::Wrong;
    return verdict;
  }
  say_fit(channel, verdict);
  say_shape(channel, evidence, verdict);
  say_rivals(channel, verdict);
  add_facts(channel.fits.front(), verdict);
  return verdict;
}

Verdict verdict_of(const ParameterTable& table) {
  Verdict verdict;
  const auto density = table.rows.empty() ? std::nullopt : density_of(table);
  if (!density) {
    verdict.sentence =
        "No recording of this table gives a white-noise density N, and the model " + table.model + " holds none.";
    say_structure(table, verdict);
    return verdict;
  }
  say_levels(table, *density, verdict);
  std::vector<std::string> misfits;
  for (const TableRow& row : table.rows) {
    const bool misfit = std::any_of(row.warnings.begin(), row.warnings.end(), [](const std::string& warning) {
      return warning.find("does not fit") != std::string::npos;
    });
    if (misfit) {
      misfits.push_back(row.label);
    }
    if (row.agreement && !row.agreement->agree()) {
      verdict.details.push_back("The recordings of " + row.label + " disagree (" + p_text(row.agreement->p) +
                                "); the pooled values stand for none of them.");
      raise(verdict, VerdictLevel::Look);
    }
    if (row.contamination == "contaminated") {
      verdict.details.push_back("Gross errors move the variances under " + row.label + ".");
      raise(verdict, VerdictLevel::Look);
    }
  }
  say_structure(table, verdict);
  if (table.data_sheet) {
    for (const SheetFigure& figure : table.data_sheet->figures) {
      verdict.details.push_back(sentence_of(figure) + " (" + table.data_sheet->sensor + ").");
    }
  }
  if (!misfits.empty()) {
    verdict.details.push_back("The model does not fit under " + joined(misfits) +
                              "; the intervals there are too short.");
    raise(verdict, VerdictLevel::Look);
  }
  return verdict;
}

}  // namespace driftlab
