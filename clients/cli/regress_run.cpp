#include "clients/cli/regress_run.hpp"

#include "clients/cli/left_out_lines.hpp"
#include "clients/cli/regress_input.hpp"
#include "clients/cli/regress_outputs.hpp"
#include "clients/cli/regress_state.hpp"
#include "core/campaign/regression/kept_settings.hpp"
#include "schema/json/compared_recording.hpp"
#include "schema/text/regression.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>

namespace driftlab::cli {
namespace {

Result<regression::Recordings> compared(const std::string& label, const std::vector<StoredRecording>& stored,
                                        const std::vector<regression::Exclusion>& excluded) {
  regression::Recordings arm{label, {}};
  for (const StoredRecording& one : stored) {
    auto recording = one.compared ? Result<regression::ComparedRecording>(*one.compared)
                                  : compared_recording_from_json(one.document);
    if (!recording) {
      return fail(recording.error());
    }
    const bool left_out = std::any_of(excluded.begin(), excluded.end(), [&](const regression::Exclusion& exclusion) {
      return exclusion.recording == recording->id;
    });
    if (left_out) {
      continue;
    }
    recording->session = one.session;
    one.stated.tell(*recording);
    if (!one.recorded_at.empty()) {
      const auto began = seconds_of(one.recorded_at);
      if (!began) {
        return fail(began.error());
      }
      recording->began_s = *began;
    }
    arm.recordings.push_back(std::move(*recording));
  }
  return arm;
}

std::vector<std::string> ids_of(const std::vector<StoredRecording>& stored) {
  std::vector<std::string> ids;
  for (const StoredRecording& one : stored) {
    ids.push_back(one.id);
  }
  return ids;
}

/// The run with everything that the state adds to it.
struct Prepared {
  RegressRequest request;
  std::vector<std::string> candidate;  ///< ids of its recordings
};

Result<std::vector<StoredRecording>> baseline_of(WrittenRegression& run, RegressState& state, ResultReader& reader) {
  if (run.baseline.special.empty()) {
    auto stored = reader.read(run.baseline);
    if (stored && state.kept() && !run.baseline.label.empty()) {
      state.add(run.baseline.label, *stored);
      if (state.anchor().empty()) {
        state.set_anchor(run.baseline.label, "the first baseline", run.settings);
      }
      return state.recordings(run.baseline.label);
    }
    return stored;
  }
  run.baseline.label = run.baseline.special == "anchor" ? state.anchor() : state.last_pass();
  if (run.baseline.label.empty() || !state.has(run.baseline.label)) {
    return fail(ErrorCode::InvalidArgument,
                run.baseline.special == "anchor"
                    ? "There is no baseline: name one with --baseline, or keep an anchor in --state FILE."
                    : "No run has passed yet: name a baseline with --baseline.");
  }
  return state.recordings(run.baseline.label);
}

Result<Prepared> prepare(WrittenRegression& run, RegressState& state, ResultReader& reader) {
  Prepared prepared;
  auto baseline = baseline_of(run, state, reader);
  if (!baseline) {
    return fail(baseline.error());
  }
  auto candidate = reader.read(run.candidate);
  if (!candidate) {
    return fail(candidate.error());
  }
  if (state.kept() && !run.baseline.label.empty() && run.baseline.label == state.anchor()) {
    if (const auto kept = state.kept_settings()) {
      run.settings = regression::with_kept(*kept, run.settings, run.stated);
      prepared.request.kept = kept;
    }
  }
  prepared.request.stated = run.stated;
  const bool counted = state.kept() && !run.candidate.label.empty();
  std::vector<std::string> earlier;
  if (counted) {
    if (Status differ = check_arms_differ(run.baseline.label, run.candidate.label); !differ) {
      return fail(differ.error());
    }
    earlier = state.history().releases(run.baseline.label, run.candidate.label);
    state.add(run.candidate.label, *candidate);
    *candidate = state.recordings(run.candidate.label);
    prepared.candidate = ids_of(*candidate);
    prepared.request.look.number = state.look(run.candidate.label, prepared.candidate);
  }
  prepared.request.look.of = run.looks;
  prepared.request.look.counted = counted;
  regression::Request& request = prepared.request.comparison;
  request.device = run.device;
  request.settings = run.settings;
  request.excluded = run.excluded;
  for (const auto& [label, stored, into] : {std::tuple{&run.baseline.label, &*baseline, &request.baseline},
                                            std::tuple{&run.candidate.label, &*candidate, &request.candidate}}) {
    auto arm = compared(*label, *stored, run.excluded);
    if (!arm) {
      return fail(arm.error());
    }
    *into = std::move(*arm);
  }
  const auto add_release = [&](const std::string& label, const std::vector<StoredRecording>& stored) -> Status {
    auto arm = compared(label, stored, run.excluded);
    if (!arm) {
      return fail(arm.error());
    }
    request.history.push_back(std::move(*arm));
    return {};
  };
  for (const std::string& label : earlier) {
    if (auto added = add_release(label, state.recordings(label)); !added) {
      return fail(added.error());
    }
  }
  if (!earlier.empty()) {
    request.before_baseline = state.history().before(earlier, run.baseline.label);
    prepared.request.previous = request.history.back();
  }
  for (const WrittenArm& release : run.history) {
    auto stored = reader.read(release);
    if (!stored) {
      return fail(stored.error());
    }
    if (auto added = add_release(release.label, *stored); !added) {
      return fail(added.error());
    }
  }
  return prepared;
}

/// `report` must outlive the forms.
RunForms forms_of(const RegressReport& report, Inconclusive inconclusive) {
  RunForms forms;
  forms.verdict = report.report.verdict;
  forms.document = [&report] { return to_json(report).dump(2) + "\n"; };
  forms.text = [&report] { return regression_to_text(report); };
  forms.junit = [&report, inconclusive] { return regression_to_junit(report, inconclusive == Inconclusive::Pass); };
  forms.markdown = [&report](const std::string& figure) { return regression_to_markdown(report, figure); };
  forms.figure = [&report] { return regression_to_svg(report); };
  forms.badge = [&report] { return regression_to_badge(report); };
  return forms;
}

/// What ends the work of this process: the user's input, or an interrupt.
tl::unexpected<Failure> unable_to_work(const Error& error) {
  return unable(error, error.code == ErrorCode::Cancelled ? Exit::Interrupted : Exit::BadInput);
}

tl::expected<Exit, Failure> accept(const RegressFlags& flags) {
  if (flags.state.empty() || flags.reason.empty()) {
    return unable({ErrorCode::InvalidArgument,
                   "--accept moves the anchor: it needs --reason TEXT, and --state FILE or --server URL.",
                   {}});
  }
  auto state = RegressState::open(flags.state);
  if (!state) {
    return unable(state.error());
  }
  if (!state->has(flags.accept)) {
    std::string known;
    const RegressionHistory history = state->history();
    for (const std::string& label : history.labels()) {
      known += (known.empty() ? "" : ", ") + label;
    }
    return unable({ErrorCode::NotFound,
                   "No recording has the label " + flags.accept +
                       "; labels of this state: " + (known.empty() ? "none" : known) + ".",
                   {}});
  }
  WrittenRegression run;
  run.settings = state->kept_settings().value_or(run.settings);
  if (auto read = read_settings(flags, run); !read) {
    return unable(read.error());
  }
  state->set_anchor(flags.accept, flags.reason, run.settings);
  if (auto saved = state->save(); !saved) {
    return unable(saved.error());
  }
  std::printf("The baseline is %s from now on: %s\n", flags.accept.c_str(), flags.reason.c_str());
  return Exit::Success;
}

tl::expected<Exit, Failure> regress_here(const RegressFlags& flags) {
  if (!flags.accept.empty()) {
    return accept(flags);
  }
  auto run = written_run(flags);
  if (!run) {
    return unable(run.error());
  }
  if (run->candidate.recordings.empty()) {
    return unable(
        {ErrorCode::InvalidArgument, "A run needs a candidate: --candidate FILE... or a run.json that names one.", {}});
  }
  auto state = RegressState::open(flags.state);
  if (!state) {
    return unable(state.error());
  }
  ResultReader reader(flags.models, flags.file, run->device, state->kept());
  auto prepared = prepare(*run, *state, reader);
  if (!prepared) {
    return unable_to_work(prepared.error());
  }
  const auto report = regress(prepared->request, {interrupt_token(), {}});
  if (!report) {
    return unable_to_work(report.error());
  }
  if (prepared->request.look.counted) {
    state->add_run(run->candidate.label, prepared->candidate, *report);
  }
  if (state->kept()) {
    if (auto saved = state->save(); !saved) {
      return unable(saved.error());
    }
  }
  return finish_run(flags, forms_of(*report, run->inconclusive), run->inconclusive);
}

}  // namespace

void add_regress_flags(CLI::App& command, RegressFlags& flags) {
  command.add_option("--baseline", flags.baseline, "Recordings before the change, or what `characterise --json` wrote");
  command.add_option("--candidate", flags.candidate, "Recordings after the change");
  command.add_option("--history", flags.history, "Recordings of an earlier release of the same device");
  command.add_option("--baseline-label", flags.baseline_label, "Label of the baseline, e.g. firmware=1.4.2");
  command.add_option("--candidate-label", flags.candidate_label, "Label of the candidate, e.g. firmware=1.5.0");
  command.add_option("--device", flags.file.device, "Name of the device");
  command.add_option("--rate-hz", flags.file.rate_hz, "Sampling rate; needed without a time column");
  command.add_option("--columns", flags.file.columns, "NAME=QUANTITY:AXIS:UNIT,… e.g. gz=angular_rate:z:deg/s");
  command.add_option("--stream", flags.file.stream,
                     "Of the units of a log or table the one that is meant, as its columns begin, e.g. imu2");
  command.add_option("--condition", flags.file.condition, "static, constant_rate:z:9:deg/s, …")->capture_default_str();
  add_left_out_lines(command, flags.file);
  command.add_option("--calibration", flags.file.calibration,
                     "Calibration that the recordings are corrected with first");
  command.add_option("--models", flags.models, "Candidate models, e.g. WN,WN+GM")
      ->delimiter(',')
      ->allow_extra_args(false);
  command.add_option("--settings", flags.settings, "JSON file with margins and other settings");
  command.add_option("--state", flags.state, "JSON file that keeps anchor, looks and earlier releases");
  command.add_option("--accept", flags.accept, "Make this label of the state the baseline from now on");
  command.add_option("--reason", flags.reason, "Why the anchor moves");
  command.add_option("--inconclusive", flags.inconclusive, "Exit code of an inconclusive run: pass (0) or fail (1)")
      ->check(CLI::IsMember({"pass", "fail"}));
  command.add_option("--junit", flags.junit, "Write a JUnit report to this file");
  command.add_option("--markdown", flags.markdown, "Write the summary as Markdown to this file");
  command.add_option("--figure", flags.figure, "Write the figure as SVG to this file");
  command.add_option("--badge", flags.badge, "Write a badge as SVG to this file");
  command.add_flag("--json", flags.json, "Print the document instead of text");
  command.add_option("--server", flags.server,
                     "Run in the daemon at this address, which keeps recordings, anchor, looks and history");
}

Exit run_regress(const RegressFlags& flags) {
  const bool compares = flags.accept.empty();  // else the anchor moves, and no file is written
  if (const Status removed = compares ? remove_outputs(flags) : Status{}; !removed) {
    return complain(removed.error());
  }
  const auto ended = flags.server.empty() ? regress_here(flags) : regress_there(flags);
  if (ended) {
    return *ended;
  }
  const Failure& failure = ended.error();
  if (compares && failure.exit != Exit::Interrupted) {
    write_no_verdict(flags, sentence_of(failure.error));
  }
  return complain(failure.error, failure.exit);
}

}  // namespace driftlab::cli
