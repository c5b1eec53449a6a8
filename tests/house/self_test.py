#!/usr/bin/env python3
"""Every house check finds what it is there for: a small tree with one fault planted in it must be refused."""
from __future__ import annotations

import os
import tempfile
import unittest
import unittest.mock
from pathlib import Path

import accounting
import causes
import computing
import documents
import floors
import hiding
import leaks
import licence
import measured
import running
import strict


class Planted(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name).resolve() / "tree"
        self.root.mkdir()

    def plant(self, name: str, text: str) -> Path:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def refused(self, faults: list[str], *parts: str) -> None:
        self.assertTrue(any(all(part in fault for part in parts) for fault in faults), faults)


class Floors(Planted):
    def setUp(self) -> None:
        super().setUp()
        self.plant("core/signal/unit.hpp", "#pragma once\n#include <string>\n")
        self.plant("server/main.cpp", '#include "server/api/routes.hpp"\n#include <iostream>\n')

    def test_an_upright_house_is_clean(self) -> None:
        self.plant("core/fit/gmwm.cpp", '#include "core/fit/gmwm.hpp"\n#include "core/signal/unit.hpp"\n// printf(getenv)\n'
                                        'auto s = "std::cout << abort()"; auto t = pool.exit(1); x_time(0);\n')
        self.assertEqual(floors.check(self.root), [])

    def test_each_climbing_include_is_refused(self) -> None:
        climbing = [("core/signal/a.hpp", "core/process/process.hpp"), ("core/process/a.hpp", "core/variance/allan.hpp"),
                    ("core/variance/a.hpp", "core/fit/fit.hpp"), ("core/fit/a.hpp", "core/navigate/filter.hpp"),
                    ("core/calibrate/a.hpp", "core/navigate/filter.hpp"), ("core/navigate/a.hpp", "core/calibrate/six.hpp"),
                    ("core/fit/a.hpp", "core/investigate/causes/bias.hpp"), ("core/read/csv.hpp", "core/process/process.hpp"),
                    ("core/fit/a.hpp", "core/read/csv.hpp"), ("core/investigate/a.hpp", "schema/json/table.hpp"),
                    ("core/investigate/study/a.hpp", "core/investigate/slow/slow_model.hpp"),
                    ("core/investigate/slow/a.hpp", "core/investigate/fullrate/spectrum.hpp"),
                    ("core/investigate/fullrate/a.hpp", "core/investigate/causes/cause.hpp"),
                    ("core/investigate/causes/a.cpp", "core/investigate/search/candidates.hpp"),
                    ("core/investigate/search/a.cpp", "core/investigate/report/report.hpp"),
                    ("core/investigate/report/a.cpp", "core/investigate/investigate.hpp"),
                    ("core/campaign/a.hpp", "core/navigate/model_schedule.hpp"), ("schema/text/a.hpp", "schema/json/json.hpp"),
                    ("schema/json/a.hpp", "server/store/rows.hpp"), ("clients/cli/a.cpp", "server/api/problems.hpp"),
                    ("server/store/sqlite/a.cpp", "server/jobs/job_kind.hpp"), ("server/http/a.hpp", "server/jobs/job_kind.hpp"),
                    ("server/jobs/a.hpp", "server/http/request.hpp"), ("server/http/a.hpp", "server/api/routes.hpp"),
                    ("server/api/a.hpp", "clients/cli/client.hpp"),
                    ("server/jobs/a.cpp", "core/fit/gmwm.hpp"), ("server/jobs/a.cpp", "core/investigate/search/search.hpp"),
                    ("schema/json/a.cpp", "core/export/target.hpp"), ("schema/json/a.cpp", "core/investigate/slow/slow_model.hpp"),
                    ("schema/json/a.cpp", "core/fit/gmwm.hpp"), ("schema/json/a.cpp", "core/variance/allan_variance.hpp"),
                    ("schema/json/a.cpp", "core/signal/channel_survey.hpp"), ("schema/json/a.cpp", "core/process/decimation.hpp"),
                    ("schema/json/a.cpp", "core/campaign/population_verdict.hpp"), ("schema/json/a.cpp", "core/campaign/glance.hpp"),
                    ("schema/json/a.cpp", "core/navigate/outage_runs.hpp"),
                    ("schema/json/a.cpp", "core/calibrate/triad.hpp"),
                    ("server/api/a.cpp", "core/signal/channel_survey.hpp"),
                    ("server/jobs/a.cpp", "core/campaign/replicates.hpp"), ("clients/cli/a.cpp", "core/campaign/structure.hpp"),
                    ("server/jobs/a.cpp", "core/read/format.hpp"), ("server/api/a.cpp", "core/calibrate/triad.hpp"),
                    ("clients/cli/a.cpp", "core/navigate/outage_runs.hpp"), ("clients/cli/a.cpp", "core/variance/allan.hpp"),
                    ("clients/cli/a.cpp", "core/process/model.hpp"), ("core/analysis/a.cpp", "schema/json/json.hpp")]
        for source, included in climbing:
            with self.subTest(source=source, included=included):
                path = self.plant(source, f'#pragma once\n#include "{included}"\n')
                self.refused(floors.check(self.root), f"{source}:2:", "may not include", included)
                path.unlink()

    def test_what_core_may_not_say_is_refused(self) -> None:
        for line in ("std::cout << 1;", 'printf("x");', 'auto v = getenv("X");', "std::chrono::system_clock::now();",
                     "std::chrono::steady_clock::now();", "std::random_device d;", "std::abort();", "exit(1);", "time(nullptr);"):
            with self.subTest(line=line):
                self.plant("core/signal/a.cpp", "int before;\n" + line + "\n")
                self.refused(floors.check(self.root), "core/signal/a.cpp:2: core")

    def test_a_document_that_computes_is_refused(self) -> None:
        # Figures were interpolated and averaged on JSON values, and nothing said so.
        for line in ("double y = std::exp(std::log(a) * share);", "auto d = std::sqrt(v);", "auto s = std::accumulate(a, b, 0.0);", "auto m = axes.transpose() * place;",
                     "auto e = to_euler(attitude);",
                     "auto n = std::lround(100.0 * share);", "auto h = std::hypot(x, y);", "#include <cmath>", "#include <numeric>",
                     # A map was framed, a table's axis ended, the smaller p told and a step of a thinned path chosen there.
                     "worst = std::max(worst, error);", "auto p = std::min(test.p_fit, test.p_contrast);", "auto m = std::clamp(tenths, 60, 110);",
                     "const double far = *std::max_element(x.begin(), x.end());", "auto a = std::abs(ratio);", "auto [l, h] = std::ranges::minmax(x);",
                     "plot.y.domain = {least / 1.5, top};", "const double margin = 0.04 * wide;", "auto w = ends[1] - ends[0];",
                     "place = {truth[0] + error[0], north};", "auto d = number(static_cast<double>(window.count) * window.time.dt_s);",
                     "plan.duration_s = poses.back().time_s - poses.front().time_s;", "auto t = start_s + trim.start_s;",
                     "const std::size_t step = points.size() / kMost + 1;", "const double share = inside / all;", "sum *= weight;",
                     "facts.missing = known.missing + known.implausible;", "d.push_back(number(deviation_of(variance)));",
                     # Sums over members, a median and a trace passed where no operator of two operands stood between measured names.
                     'total += row.at("rms_m").get<double>();', "double sum = 0.0; sum += one.value;", "way.length_m += step;",
                     'auto both = a.get<double>() + b.get<double>();', "auto d = sqrt(v);", "auto l = -log10(level);", "auto f = (pow(x, y));",
                     "auto f = floor(x);", "auto s = posterior.rowwise().sum();", "auto m = scatter->mean();", "if (!(sd.minCoeff() > 0.0)) {",
                     "auto m = values.maxCoeff();", "std::sort(v.begin(), v.end()); auto m = number(v[v.size() / 2]);",
                     "std::ranges::sort(v); auto m = number(v[n / 2]);", "auto y = 2 * v * 3;", "auto half = width / 2;",
                     "auto n = std::count_if(v.begin(), v.end(), [](double x) { return x > kMost; });"):
            with self.subTest(line=line):
                path = self.plant("schema/json/report/a.cpp", "int before;\n" + line + "\n")
                self.refused(floors.check(self.root), "schema/json/report/a.cpp:2: schema/json")
                path.unlink()
        self.plant("schema/json/json.cpp", "#include <cmath>\nauto n = std::isfinite(x) ? std::round(x) : 0.0;\n")
        self.plant("schema/json/a.cpp", '#include <algorithm>\nauto v = number(channel.mean * unit.per_si);  // std::sqrt\nauto s = "std::exp - a / b";\n'
                                        'auto a = angles.roll_rad / kDegree;\nauto b = 100.0 * tau0.device;\nauto c = *level * lab.per_si;\n'
                                        'auto d = 1.0 / unit.factor;\nauto e = variance[i] * factor * factor;\nauto f = row[i * columns + k];\n'
                                        'auto g = logs[cell * bands + band];\nauto h = "n " + std::to_string(i + 1) + end;\nauto k = text.size() - 1;\n'
                                        'const Json* const list = &document;\nauto l = std::to_string(found - list.begin()) + name;\n'
                                        'std::string text;\ntext += ", " + name;\ntext += metres(one.at("rms_m").get<double>()) + " m";\nsize_t n = 0;\n'
                                        'n += list.size();\nn += 1;\nn -= 1;\nauto m = 2 * list.size();\nstd::sort(names.begin(), names.end());\n'
                                        'auto o = std::count_if(list.begin(), list.end(), [](const Json& one) { return one.is_null(); });\n'
                                        'auto p = channel.mean;\nauto q = figure::floor(plot);\nauto r = audit.log(line);\nconst double sum = document.sum;\n')
        self.plant("schema/json/b.cpp", "void f() {\n  std::sort(names.begin(), names.end());\n}\nvoid g() {\n  cells.reserve(cells.size() / 2);\n}\n")
        self.plant("schema/json/mat_file.cpp", "bytes.resize((bytes.size() + 7) / eight * eight);\n")
        self.assertEqual(floors.check(self.root), [])

    def test_a_text_that_computes_is_refused(self) -> None:
        # Rests were summed, a share taken, an interval halved, a spread rounded and the worst test picked where they were printed.
        for line in ("double still = 0.0; for (const Rest& rest : rests) { still += rest.to_s - rest.from_s; }",
                     "double still = 0.0; for (double rest : rests) { still += rest; }",
                     "auto p = 100.0 * static_cast<double>(sampling.repeated) / static_cast<double>(sampling.rows);",
                     "auto h = 0.5 * (estimate.ci95.high - estimate.ci95.low);", "auto p = std::round(1000.0 * std::expm1(spread)) / 10.0;",
                     "auto e = std::expm1(spread);", "if (test.outcome.lower - test.test.margin > worst) {", "auto d = std::log10(v);",
                     "auto z = std::round(10.0 * place.z) / 10.0;", "auto a = std::abs(error);", "worst = std::max(worst, test.p);",
                     "auto m = *std::max_element(x.begin(), x.end());", "std::sort(values.begin(), values.end());", "auto s = v.sum();",
                     "auto e = to_euler(attitude);", "auto half = width / 2.0 * spread;", "#include <numeric>"):
            with self.subTest(line=line):
                path = self.plant("schema/text/a.cpp", "int before;\n" + line + "\n")
                self.refused(floors.check(self.root), "schema/text/a.cpp:2: schema/text")
                path.unlink()
        self.plant("schema/text/a.cpp", "#include <cmath>\nauto w = std::max(width, target.name.size());\nauto gap = std::string(widths[i] - width(line[i]) + 2, blank);\n"
                                        "text += std::string(2 * depth, blank);\nauto g = key.substr(from, at - from);\nauto c = std::isfinite(v);\n"
                                        "auto k = 1e-3 * facts.length_m;\nauto d = angles.roll_rad / kDegree;\nauto m = with_count(all - shown, noun);\n"
                                        "auto e = std::min(kWorst, tests.size());\nauto p = 100.0 * share;\ntext += name + end;\n")
        self.plant("schema/text/printed.cpp", "auto d = std::floor(std::log10(v));\n")
        self.assertEqual(floors.check(self.root), [])

    def test_a_document_that_runs_an_analysis_is_refused(self) -> None:
        # Every header of a use case is open to documents, and one of them could have called it.
        self.plant("core/analysis/characterise.hpp", """#pragma once
/// The use case "characterise": recordings in, models out.
#include "core/signal/result.hpp"
[[nodiscard]] Result<std::vector<CharacterisedRecording>> characterise(RecordingSource& recordings,
                                                                       const CharacteriseOptions& options);
[[nodiscard]] std::vector<Remark> remarks_of(const std::vector<CharacterisedRecording>& recordings);
RecordingPreview preview_recording(const PreviewRequest& request, const DecodeLimits& limits = {});
[[nodiscard]] Result<ChannelSimulation> simulate_model(const Baseline& model);
[[nodiscard]] Status check_options(const Options& options);
class ChannelLook {
 public:
  static Result<ChannelLook> open(RecordingSource& source, std::string_view column);
  [[nodiscard]] Result<BinnedSpectrum> spectrum(FrequencyScale scale, std::size_t bins) const;
  [[nodiscard]] const Unit& unit() const { return unit_; }
};
""")
        self.plant("core/fit/characterise.hpp", "#pragma once\nResult<int> characterise_channel(const Series& series, const RunControl& control);\n")
        self.plant("core/analysis/compare_devices.hpp", '#pragma once\n/// The use case "compare": devices in.\nReport compare_devices(const Devices& devices);\n')
        for module in ("schema/json", "schema/text"):
            for line in ("const auto found = characterise(recordings, options);", "return driftlab::characterise(recordings, {});",
                         "auto p = preview_recording(request);", "auto t = simulate_model(model);", "auto s = look.spectrum(scale, 8);",
                         "auto l = look->spectrum(scale, 8);", "auto r = compare_devices(devices);", "auto c = characterise_channel(series, {});",
                         "Json list_json(RecordingSource& recordings);", "Json run_json(const RunControl& control);"):
                with self.subTest(module=module, line=line):
                    path = self.plant(f"{module}/a.cpp", '#include "core/analysis/characterise.hpp"\n' + line + "\n")
                    self.refused(floors.check(self.root), f"{module}/a.cpp:2: {module} runs an analysis")
                    path.unlink()
            self.plant(f"{module}/a.cpp", '#include "core/analysis/characterise.hpp"\nauto r = remarks_of(recordings);\nauto s = look.unit();\n'
                                          "void characterise(const Row& row);\nauto t = characterise(row);\nauto c = check_options(options);\n"
                                          "const CharacterisedRecording& one = recordings.front();\nauto v = look.spectrum;\n")
        self.assertEqual(floors.check(self.root), [])
        self.plant("core/analysis/quiet.hpp", '#pragma once\n/// The use case "quiet": numbers in, numbers out.\nNumbers calm(const Numbers& numbers);\n')
        self.refused(floors.check(self.root), "core/analysis/quiet.hpp", "no function of the use case is known")

    def test_the_entries_of_the_use_cases_are_found(self) -> None:
        functions, members, _ = running.runners(Path(__file__).parents[2])
        self.assertLessEqual({"answer_drive", "calibrate", "characterise", "characterise_campaign", "compare_devices", "draft_drive", "draw_trace",
                              "evaluate_outages", "investigate_study", "plan_study", "preview_recording", "regress", "report_outages",
                              "simulate_drive", "simulate_model", "simulate_preset", "survey_recording"}, functions)
        self.assertLessEqual({"open", "spectrum", "ratio"}, members)

    def test_an_analysis_in_a_job_kind_an_endpoint_or_a_command_is_refused(self) -> None:
        for folder in ("server/jobs", "server/api", "server", "clients/cli"):
            for line in ("auto s = std::sqrt(sum / n);", "auto r = std::log(a / b);", "std::nth_element(v.begin(), middle, v.end());",
                         "auto s = std::accumulate(v.begin(), v.end(), 0.0);", "auto s = sqrt(sum / n);", "auto m = v.mean();", "auto m = v.maxCoeff();",
                         "std::sort(v.begin(), v.end()); auto m = v[v.size() / 2];", "std::ranges::sort(v); return v.at((v.size() - 1) / 2);"):
                with self.subTest(folder=folder, line=line):
                    path = self.plant(f"{folder}/a.cpp", "int before;\n" + line + "\n")
                    self.refused(floors.check(self.root), f"{folder}/a.cpp:2: {folder} analyses")
                    path.unlink()

    def test_a_hand_written_statistic_outside_core_is_refused(self) -> None:
        # A mean summed by hand, a sort of measured values and their greatest passed: plain arithmetic was let through.
        for folder in ("server/jobs", "server", "clients/cli"):
            for line in ("double sum = 0.0; for (double v : values) { sum += v; }", "double sum = 0.0; for (double v : values) { sum = sum + v; }",
                         "auto sum = 0.0; for (auto v : values) { sum += v; }", "for (double v : values) { found.sum += v; }",
                         "auto mean = sum / n;", "auto mean = sum / values.size();", "auto mean = sum / static_cast<double>(values.size());",
                         "double s = (v - mean) * (v - mean);", "auto d = values[i] - values[i - 1];", "total += row.at(m).get<double>();",
                         "std::sort(values.begin(), values.end());", "std::ranges::sort(values);", "std::stable_sort(axis.values.begin(), axis.values.end());",
                         "auto m = *std::max_element(values.begin(), values.end());", "auto [l, h] = std::ranges::minmax(values);",
                         "worst = std::max(worst, error);", "auto c = std::clamp(share, low, high);", "auto a = std::abs(error);",
                         "auto k = kBytesPerRow * mean;", "auto r = std::round(error);",
                         "auto n = std::count_if(v.begin(), v.end(), [](double x) { return x > kMost; });"):
                with self.subTest(folder=folder, line=line):
                    path = self.plant(f"{folder}/a.cpp", "int before;\n" + line + "\n")
                    self.refused(floors.check(self.root), f"{folder}/a.cpp:2: {folder} analyses")
                    path.unlink()
            self.plant(f"{folder}/b.cpp",
                       "auto cost = kBytesPerSample * size.rows;\ncost.memory_bytes += kBytes * std::max(size.rows, kFew);  // std::sqrt\n"
                       "std::sort(ids.begin(), ids.end());\nauto left = std::max(1, options.threads);\nauto path = folder / file;\n"
                       "auto late = now - job.created_at > budgets.job_seconds * kMicros;\nauto e = std::min(text.find(mark), text.size());\n"
                       "auto share = static_cast<double>(done) / static_cast<double>(files.size());\nauto n = text.substr(at + 1, stop - at);\n"
                       "list[axis] = one.bias / (place.gyro ? kDegree : 1.0);\nauto percent = 100.0 * share;\nbar += i < full ? full_block : empty;\n"
                       "int i = 0;\ntext += name;\nauto s = backup + 1;\n")
        self.assertEqual(floors.check(self.root), [])
        # What a place may say beside, no other may.
        for folder, name in (("server/jobs", "outage_evaluation.cpp"), ("clients/cli", "outages.cpp")):
            self.plant(f"{folder}/{name}", "auto cost = epochs * runs;\n")
        faults = floors.check(self.root)
        self.refused(faults, "clients/cli/outages.cpp:1: clients/cli analyses (epochs * runs)")
        self.assertEqual(len(faults), 1, faults)

    def test_every_place_of_an_account_is_needed(self) -> None:
        tree = Path(__file__).parents[2]
        for name in accounting.PLACES:
            with self.subTest(name=name), unittest.mock.patch.dict(accounting.PLACES, clear=True):
                self.assertTrue(accounting.unaccounted_in(name, computing.code_of((tree / name).read_text())))

    def test_a_thread_of_core_outside_its_executor_is_refused(self) -> None:
        for line in ("std::thread helper(work);", "std::jthread helper(work);", "auto f = std::async(work);"):
            with self.subTest(line=line):
                self.plant("core/navigate/a.cpp", "int before;\n" + line + "\n")
                self.refused(floors.check(self.root), "core/navigate/a.cpp:2: core starts threads")
        self.plant("core/navigate/a.cpp", "const auto n = std::thread::hardware_concurrency();\n")
        self.plant("core/signal/executor.cpp", "std::thread helper(work);\n")
        self.assertEqual(floors.check(self.root), [])

    def test_reserved_headers_are_refused(self) -> None:
        for source, header in (("core/read/a.cpp", "iostream"), ("core/fit/a.cpp", "spdlog/spdlog.h"), ("core/read/b.cpp", "sqlite3.h"),
                               ("core/signal/b.cpp", "nlohmann/json.hpp"), ("core/signal/c.cpp", "boost/beast/http.hpp"),
                               ("core/signal/d.cpp", "boost/asio.hpp"), ("server/api/a.cpp", "sqlite3.h")):
            with self.subTest(source=source, header=header):
                path = self.plant(source, f"#include <{header}>\n")
                self.refused(floors.check(self.root), source, header)
                path.unlink()

    def test_a_relative_include_is_refused(self) -> None:
        self.plant("core/signal/unit.cpp", '#include "unit.hpp"\n')
        self.refused(floors.check(self.root), "core/signal/unit.cpp:1:", "by its path from the top")

    def test_a_folder_without_a_floor_is_refused(self) -> None:
        self.plant("core/attic/a.hpp", "#pragma once\n")
        self.refused(floors.check(self.root), "core/attic/a.hpp", "no floor")

    def test_an_empty_tree_proves_nothing(self) -> None:
        with tempfile.TemporaryDirectory() as empty:
            self.refused(floors.check(Path(empty)), "no sources")


class Causes(Planted):
    def setUp(self) -> None:
        super().setUp()
        self.folder, self.of_drives = causes.FOLDERS
        self.plant(f"{self.of_drives}/late_fix.cpp", 'Cause late_fix() {\n  return {.name = "late_fix", .words = "late fixes"};\n}\n')
        self.plant(f"{self.of_drives}/registry.cpp", "#define DRIFTLAB_DRIVE_CAUSES(CAUSE) \\\n  CAUSE(late_fix)\n")
        for name, rivals in (("bias_jump", '"slow_walk"'), ("slow_walk", '')):
            self.plant(f"{self.folder}/{name}.cpp",
                       f'Cause {name}() {{\n  return {{.name = "{name}", .title = "it",\n          .rivals = {{{rivals}}}}};\n}}\n')
        self.plant(f"{self.folder}/registry.cpp", "#define DRIFTLAB_CAUSES(CAUSE) \\\n  CAUSE(bias_jump) \\\n  CAUSE(slow_walk) \\\n  CAUSE(peak)\n")
        self.plant(f"{self.folder}/peak.cpp", 'Cause peak() {\n  return {.name = "peak", .parameters = {"peak.f_hz"}};\n}\n')
        self.plant("core/process/slow_walk.hpp", 'static constexpr std::string_view kName = "slow_walk";\n')

    def test_names_in_their_places_are_clean(self) -> None:
        self.plant("tests/hidden/a.cpp", 'make_case("bias_jump");\n')
        self.plant("core/investigate/search/a.cpp", '// unlike "bias_jump"\n#include "core/bias_jump.hpp"\nadd("slow_walk", {level});\nsay("A peak. The peak of 2.5 Hz is the peak.");\n')
        self.plant("schema/docs/analysis.md", 'the cause "bias_jump"\n')
        self.assertEqual(causes.check(self.root), [])

    def test_a_name_elsewhere_is_refused(self) -> None:
        for place, line in (("core/investigate/search/a.cpp", 'if (cause.name == "bias_jump") {'),
                            ("core/investigate/a.cpp", 'const auto* line = find_cause("slow_walk");'),
                            ("core/investigate/report/a.cpp", 'bool is = found.cause->name ==\n    "slow_walk";'),
                            ("schema/json/a.cpp", 'const bool powers = name == "bias_jump";'),
                            ("server/jobs/a.cpp", 'Json effect{{"cause", "slow_walk"}};'),
                            ("clients/dashboard/a.ts", 'if (name === "bias_jump") {'),
                            ("schema/text/b.cpp", 'auto at = parameters.find("bias_jump.t0_s");'),
                            # A name of one word passed within a literal, and whatever stood between other quotes than C++ has.
                            ("schema/text/c.cpp", 'auto at = parameters.find("peak.f_hz");'),
                            ("schema/text/d.cpp", 'find("the peak.f_hz of it");'),
                            ("schema/text/e.cpp", 'find("peak." + member);'),
                            ("clients/dashboard/b.ts", "if (name === 'bias_jump') {"),
                            ("clients/dashboard/c.tsx", "const key = `peak.${member}`;"),
                            ("clients/python/a.py", "if name == 'bias_jump':"),
                            ("core/navigate/drive/explain.cpp", 'if (finding.cause == "late_fix") {'),
                            ("schema/text/drive.cpp", 'if (f.cause != "late_fix") {'),
                            (f"{self.of_drives}/draft.cpp", 'return knob_of("late_fix");'),
                            (f"{self.folder}/draft.cpp", 'if (name == "bias_jump") {')):
            with self.subTest(place=place):
                path = self.plant(place, "int before;\n" + line + "\n")
                said = next(name for name in ("slow_walk", "late_fix", "bias_jump", "peak") if name in line)
                self.refused(causes.check(self.root), place, said, "by name")
                path.unlink()

    def test_a_cause_without_its_line_or_its_own_file_is_refused(self) -> None:
        for folder in causes.FOLDERS:
            with self.subTest(folder=folder):
                path = self.plant(f"{folder}/odd.cpp", '  return {.name = "other",\n')
                self.refused(causes.check(self.root), "a file of its own")
                self.refused(causes.check(self.root), f"{folder}/registry.cpp", "other has 0 lines")
                path.unlink()

    def test_a_registry_without_causes_is_refused(self) -> None:
        (self.root / self.of_drives / "late_fix.cpp").unlink()
        self.refused(causes.check(self.root), "no causes", self.of_drives)

    def test_an_empty_tree_proves_nothing(self) -> None:
        with tempfile.TemporaryDirectory() as empty:
            self.refused(causes.check(Path(empty)), "no causes")


class Hiding(Planted):
    HEADER = "namespace driftlab {\n[[nodiscard]] inline std::vector<std::string_view> split(std::string_view text, char separator) {\n}\n}  // namespace driftlab\n"

    def setUp(self) -> None:
        super().setUp()
        self.plant("core/signal/text.hpp", self.HEADER)

    def test_other_types_names_and_places_are_clean(self) -> None:
        self.plant("server/a.cpp", "namespace driftlab::server {\nnamespace {\nint split(std::string_view text) {\n}\n"
                                   "int split(std::string_view text, Kind kind) {\n}\nint parts(std::string_view text, char at) {\n}\n"
                                   "}  // namespace\n}  // namespace driftlab::server\n")
        self.plant("core/b.cpp", "namespace driftlab {\nnamespace {\nint split(const std::string_view words, char at) {\n}\n"
                                 "}  // namespace\n}  // namespace driftlab\n")
        self.assertEqual(hiding.check(self.root), [])

    def test_a_function_that_hides_an_outer_one_is_refused(self) -> None:
        self.plant("server/a.cpp", "namespace driftlab::server {\nnamespace {\nParts split(const std::string_view words, char at = ',') {\n}\n"
                                   "}  // namespace\n}  // namespace driftlab::server\n")
        self.refused(hiding.check(self.root), "server/a.cpp", "driftlab::split", "core/signal/text.hpp")


class Leaks(Planted):
    def setUp(self) -> None:
        super().setUp()
        os.environ["DRIFTLAB_SHARED"] = str(self.root.parent / "shared")
        self.addCleanup(os.environ.pop, "DRIFTLAB_SHARED")
        self.plant("../shared/data/imu.json", '{"rate_hz": 100}')

    def test_an_ordinary_file_is_clean(self) -> None:
        self.plant("README.md", "data are kept in /var/lib/driftlab, password: none, ids like dl_abc, ~/work/x, $HOME/home/x\n")
        self.assertEqual(leaks.check(self.root), [])

    def test_each_leak_is_refused(self) -> None:
        for line in ("-----BEGIN RSA PRIVATE" + " KEY-----", "AKIA" + "A" * 16, "ghp_" + "a" * 36,
                     "dl_" + "a" * 30 + "_" + "b" * 6, "password = " + '"correct-horse"', "see /home" + "/anna/data.csv",
                     "in /ro" + "ot/build"):
            with self.subTest(line=line):
                self.plant("notes.txt", "first\n" + line + "\n")
                self.refused(leaks.check(self.root), "notes.txt:2:")

    def test_a_big_file_is_refused(self) -> None:
        self.plant("tests/data/long.csv", "0" * (leaks.LARGEST + 1))
        self.refused(leaks.check(self.root), "tests/data/long.csv", "nothing larger")

    def test_a_copy_of_a_shared_file_is_refused_whatever_its_name(self) -> None:
        self.plant("tests/data/mine.json", '{"rate_hz": 100}')
        self.refused(leaks.check(self.root), "tests/data/mine.json", "copy of a shared file")


class Strict(Planted):
    GOOD = "target_compile_options(driftlab_options INTERFACE\n  -Wall -Wextra -Wshadow\n  -Werror)\n"

    def test_warnings_that_are_errors_are_clean(self) -> None:
        self.plant("CMakeLists.txt", self.GOOD + "# -Wno-error would be wrong\nadd_compile_options(-Wno-restrict)\n")
        self.assertEqual(strict.check(self.root), [])

    def test_what_makes_them_warnings_again_is_refused(self) -> None:
        for flag in strict.WANTED:
            self.plant("CMakeLists.txt", self.GOOD.replace(flag, ""))
            self.refused(strict.check(self.root), "CMakeLists.txt", flag)
        self.plant("CMakeLists.txt", "# -Werror\n" + self.GOOD.replace("-Werror", "-Werror=shadow"))
        self.refused(strict.check(self.root), "CMakeLists.txt", "-Werror")
        self.plant("CMakeLists.txt", self.GOOD)
        self.plant("core/CMakeLists.txt", "add_compile_options(-Wno-error)\n")
        self.refused(strict.check(self.root), "core/CMakeLists.txt:1:")


class Licence(Planted):
    def test_missing_and_shortened_texts_are_refused(self) -> None:
        self.refused(licence.check(self.root), "LICENSE: is missing")
        self.refused(licence.check(self.root), "NOTICE: is missing")
        self.plant("LICENSE", "Apache License\nVersion 2.0, January 2004\n")
        self.refused(licence.check(self.root), "LICENSE: is not the whole text")

    def test_an_uncredited_library_is_refused(self) -> None:
        self.plant("NOTICE", "driftlab links zlib.\n")
        self.plant("CMakeLists.txt", "find_package(ZLIB REQUIRED)\nfind_package(SQLite3 3.40 REQUIRED)\n")
        faults = licence.check(self.root)
        self.refused(faults, "NOTICE", "SQLite3")
        self.assertFalse(any("ZLIB" in fault for fault in faults), faults)


class Documents(Planted):
    def setUp(self) -> None:
        super().setUp()
        for name in ("deploy/quickstart.sh", "tests/run.sh"):
            self.plant(name, "#!/bin/sh\necho 'usage: --once --port N'\n").chmod(0o755)
        self.readme("")

    def readme(self, more: str) -> None:
        self.plant("README.md", "# driftlab\n\n```sh\n./deploy/quickstart.sh\n./tests/run.sh\n```\n" + more)

    def test_a_true_readme_is_clean(self) -> None:
        self.readme("```sh\n./deploy/quickstart.sh --once \\\n  --port 1 | cat  # --not-a-flag\n```\n`tests/<name>.sh` [x](deploy)\n")
        self.assertEqual(documents.check(self.root), [])

    def test_a_readme_that_opens_otherwise_is_refused(self) -> None:
        self.plant("README.md", "```sh\n./tests/run.sh\n```\n")
        self.refused(documents.check(self.root), "two commands")

    def test_false_statements_are_refused(self) -> None:
        for text, part in (("```sh\n./deploy/install.sh\n```\n", "./deploy/install.sh does not exist"),
                           ("```sh\n./deploy/quickstart.sh --onc\n```\n", "has no --onc in its --help"),
                           ("add a file to `core/attic/`\n", "`core/attic/` does not exist"),
                           ("[there](schema/docs/none.md)\n", "leads nowhere")):
            with self.subTest(text=text):
                self.readme(text)
                self.refused(documents.check(self.root), part)

    def test_a_script_that_cannot_be_executed_is_refused(self) -> None:
        (self.root / "tests/run.sh").chmod(0o644)
        self.refused(documents.check(self.root), "not executable")

    def test_a_list_of_job_kinds_that_is_not_the_registry_s_is_refused(self) -> None:
        # The page of jobs offered a kind `calibrate` that no server had.
        self.plant("server/jobs/job_kinds.cpp", "#define KINDS(KIND) \\\n  KIND(make_pool_kind) \\\n  KIND(make_regress_kind)\n")
        pages, places = (name for name, _, _ in documents.LISTS_OF_KINDS)
        self.plant(pages, "const KINDS = ['pool', 'regress'];\nconst OTHER = ['a'];\n")
        self.plant(places, 'constexpr auto kResultPlaces = std::to_array<ResultPlace>({\n    {"pool", ""},\n    {"regress", "/v1/x/"},\n});\n')
        self.assertEqual(documents.check(self.root), [])
        self.plant(pages, "const KINDS = ['pool', 'regress',\n  'calibrate'];\n")
        self.plant(places, 'constexpr auto kResultPlaces = std::to_array<ResultPlace>({\n    {"pool", ""},\n});\n')
        faults = documents.check(self.root)
        self.refused(faults, pages, "calibrate")
        self.refused(faults, places, "regress")
        self.assertEqual(len(faults), 2, faults)
        self.plant(pages, "const KINDS = kinds();\n")
        self.refused(documents.check(self.root), pages, "does not know the job kind pool")

    def test_flags_of_a_program_are_asked_of_the_subcommand(self) -> None:
        self.plant("bin/driftlab", '#!/bin/sh\n[ "$1" = table ] && echo "--axis A" || printf "Subcommands:\\n  table  x\\n"\n').chmod(0o755)
        os.environ["DRIFTLAB_BIN"] = str(self.root / "bin")
        self.addCleanup(os.environ.pop, "DRIFTLAB_BIN")
        self.readme("```sh\nbuild/release/bin/driftlab table --axis z --color\n```\n")
        faults = documents.check(self.root)
        self.refused(faults, "driftlab table has no --color")
        self.assertEqual(len(faults), 1, faults)

    def test_a_flag_that_the_manual_leaves_out_is_refused(self) -> None:
        self.plant("bin/driftlabd", "#!/bin/sh\necho '  --data TEXT  --data-sync'\n").chmod(0o755)
        self.plant("bin/driftlab", "#!/bin/sh\n[ \"$1\" = table ] && echo '  --axis' || printf 'Subcommands:\\n  table  x\\n'\n").chmod(0o755)
        self.plant("schema/docs/operations.md", "`--data`\n")
        self.plant("schema/docs/cli.md", "nothing\n")
        os.environ["DRIFTLAB_BIN"] = str(self.root / "bin")
        self.addCleanup(os.environ.pop, "DRIFTLAB_BIN")
        faults = documents.check(self.root)
        for part in ("tell of --data-sync (driftlabd)", "tell of --axis (driftlab table)", "tell of driftlab table"):
            self.refused(faults, part)
        self.assertEqual(len(faults), 3, faults)


class Measured(Planted):
    HEADER = "core/fit/measured_constants.hpp"

    def setUp(self) -> None:
        super().setUp()
        self.plant(self.HEADER, "/// Read off recordings:\n///     python3 tests/again.py SHARED\ninline constexpr double kLoud = 2.0;\n"
                                "inline constexpr Tau0 kPrior{1.0, 2.0};\n")
        self.plant("tests/again.py", f'"Measures {self.HEADER}: kLoud, kPrior"\n')

    def test_constants_that_are_measured_again_are_clean(self) -> None:
        self.assertEqual(measured.check(self.root), [])

    def test_one_that_no_program_names_is_refused(self) -> None:
        self.plant("tests/again.py", f'"Measures {self.HEADER}: kLouder, kPrior"\n')
        self.assertEqual(measured.check(self.root), [f"{self.HEADER}: tests/again.py does not measure kLoud"])

    def test_a_command_without_a_program_is_refused(self) -> None:
        (self.root / "tests/again.py").unlink()
        faults = measured.check(self.root)
        self.refused(faults, "there is no tests/again.py")
        self.refused(faults, "no command in it runs a program that names it")


if __name__ == "__main__":
    unittest.main()
