#include "clients/cli/regress_outputs.hpp"

#include "schema/text/regression.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <utility>

namespace driftlab::cli {
namespace {

Status write_file(const std::string& path, const std::string& text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
  stream.close();
  return stream ? Status{} : fail(ErrorCode::Io, "The file " + path + " cannot be written.", {{"path", path}});
}

/// The files that a run writes; empty: that one is not wanted.
struct OutputPaths {
  std::string document, junit, markdown, figure, badge;
};

OutputPaths paths_of(const RegressFlags& flags) {
  OutputPaths paths{"", flags.junit, flags.markdown, flags.figure, flags.badge};
  if (!flags.out.empty()) {
    const std::filesystem::path folder(flags.out);
    const auto within = [&](const std::string& given, const char* name) {
      return given.empty() ? (folder / name).string() : given;
    };
    paths.junit = within(paths.junit, "junit.xml");
    paths.markdown = within(paths.markdown, "summary.md");
    paths.figure = within(paths.figure, "ratio.svg");
    paths.badge = within(paths.badge, "badge.svg");
    paths.document = (folder / "regression.json").string();
  }
  return paths;
}

void make_folder(const RegressFlags& flags) {
  if (!flags.out.empty()) {
    std::error_code error;  // what is written there says it
    std::filesystem::create_directories(flags.out, error);
  }
}

Status write_outputs(const RegressFlags& flags, const RunForms& forms) {
  make_folder(flags);
  const OutputPaths paths = paths_of(flags);
  const std::string shown =
      paths.figure.empty()
          ? ""
          : std::filesystem::path(paths.figure).lexically_relative(std::filesystem::path(paths.markdown).parent_path());
  for (const auto& [path, form] :
       {std::pair<std::string, std::function<Result<std::string>()>>{paths.document, forms.document},
        {paths.junit, forms.junit},
        {paths.markdown, [&] { return forms.markdown(shown); }},
        {paths.figure, forms.figure},
        {paths.badge, forms.badge}}) {
    if (path.empty()) {
      continue;
    }
    const auto text = form();
    if (!text) {
      return fail(text.error());
    }
    if (auto written = write_file(path, *text); !written) {
      return written;
    }
  }
  return {};
}

Exit exit_of(regression::Verdict verdict, Inconclusive inconclusive) {
  if (verdict == regression::Verdict::Inconclusive) {
    return inconclusive == Inconclusive::Pass   ? Exit::Success
           : inconclusive == Inconclusive::Fail ? Exit::Negative
                                                : Exit::Inconclusive;
  }
  return verdict == regression::Verdict::Pass ? Exit::Success : Exit::Negative;
}

}  // namespace

Status remove_outputs(const RegressFlags& flags) {
  const OutputPaths paths = paths_of(flags);
  for (const std::string& path : {paths.document, paths.junit, paths.markdown, paths.figure, paths.badge}) {
    std::error_code error;
    if (path.empty() || std::filesystem::symlink_status(path, error).type() != std::filesystem::file_type::regular) {
      continue;  // a pipe or a terminal keeps nothing
    }
    if (std::filesystem::remove(path, error); error) {
      return fail(ErrorCode::Io, "The file " + path + " of an earlier run cannot be removed.", {{"path", path}});
    }
  }
  return {};
}

void write_no_verdict(const RegressFlags& flags, const std::string& sentence) {
  (void)remove_outputs(flags);
  make_folder(flags);
  const OutputPaths paths = paths_of(flags);
  for (const auto& [path, text] : {std::pair{&paths.junit, no_verdict_to_junit(sentence)},
                                   std::pair{&paths.markdown, no_verdict_to_markdown(sentence)}}) {
    if (!path->empty()) {
      (void)write_file(*path, text);  // the sentence is said on standard error in any case
    }
  }
}

tl::expected<Exit, Failure> finish_run(const RegressFlags& flags, const RunForms& forms, Inconclusive inconclusive) {
  if (auto written = write_outputs(flags, forms); !written) {
    return unable(written.error());
  }
  const auto text = flags.json ? forms.document() : forms.text();
  if (!text) {
    return unable(text.error());
  }
  std::fwrite(text->data(), 1, text->size(), stdout);
  return exit_of(forms.verdict, inconclusive);
}

}  // namespace driftlab::cli
