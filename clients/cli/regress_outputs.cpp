#include "clients/cli/regress_outputs.hpp"

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

Status write_outputs(const RegressFlags& flags, const RunForms& forms) {
  std::string junit = flags.junit;
  std::string markdown = flags.markdown;
  std::string figure = flags.figure;
  std::string badge = flags.badge;
  std::string document;
  if (!flags.out.empty()) {
    const std::filesystem::path folder(flags.out);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    const auto within = [&](const std::string& given, const char* name) {
      return given.empty() ? (folder / name).string() : given;
    };
    junit = within(junit, "junit.xml");
    markdown = within(markdown, "summary.md");
    figure = within(figure, "ratio.svg");
    badge = within(badge, "badge.svg");
    document = (folder / "regression.json").string();
  }
  const std::string shown =
      figure.empty() ? ""
                     : std::filesystem::path(figure).lexically_relative(std::filesystem::path(markdown).parent_path());
  for (const auto& [path, form] :
       {std::pair<std::string, std::function<Result<std::string>()>>{document, forms.document},
        {junit, forms.junit},
        {markdown, [&] { return forms.markdown(shown); }},
        {figure, forms.figure},
        {badge, forms.badge}}) {
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

Exit finish_run(const RegressFlags& flags, const RunForms& forms, Inconclusive inconclusive) {
  if (auto written = write_outputs(flags, forms); !written) {
    return complain(written.error());
  }
  const auto text = flags.json ? forms.document() : forms.text();
  if (!text) {
    return complain(text.error());
  }
  std::fwrite(text->data(), 1, text->size(), stdout);
  return exit_of(forms.verdict, inconclusive);
}

}  // namespace driftlab::cli
