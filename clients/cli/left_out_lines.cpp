#include "clients/cli/left_out_lines.hpp"

#include "core/read/byte_source.hpp"
#include "core/signal/with_count.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <fstream>

namespace driftlab::cli {
namespace {

struct LeftOut {
  std::size_t skipped = 0;
  std::size_t comments = 0;
};

bool begins_with(const std::string& line, const std::string& sign) {
  const std::size_t start = line.find_first_not_of(" \t");
  return !sign.empty() && start != std::string::npos && line.compare(start, sign.size(), sign) == 0;
}

Result<LeftOut> copy_without(const FileFlags& flags, const std::filesystem::path& from,
                             const std::filesystem::path& to) {
  std::ifstream in(from, std::ios::binary);
  if (!in) {
    return fail(ErrorCode::NotFound, "The file " + from.string() + " cannot be opened.");
  }
  std::ofstream out(to, std::ios::binary);
  LeftOut left;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    if (++number == 1 && sniff_compression(line) != Compression::None) {
      return fail(ErrorCode::InvalidArgument,
                  "--skip-lines and --comment are for plain text; unpack " + from.string() + " first.");
    }
    const bool skipped = number <= flags.skip_lines;
    const bool comment = !skipped && begins_with(line, flags.comment);
    left.skipped += skipped ? 1 : 0;
    left.comments += comment ? 1 : 0;
    out << (skipped || comment ? "#" : line) << (in.eof() ? "" : "\n");
  }
  out.close();
  if (!out) {
    return fail(ErrorCode::Io, "The copy of " + from.string() + " without the lines left out cannot be written.");
  }
  if (left.skipped < flags.skip_lines || left.skipped == number) {
    return fail(ErrorCode::InvalidArgument, from.string() + " has " + with_count(number, "line") + "; --skip-lines " +
                                                std::to_string(flags.skip_lines) + " leaves nothing.");
  }
  return left;
}

}  // namespace

void add_left_out_lines(CLI::App& command, FileFlags& flags) {
  command.add_option("--skip-lines", flags.skip_lines, "Lines at the front of a text that are no table");
  command.add_option("--comment", flags.comment, "What begins a line that is no row, e.g. ';'");
}

Status leave_out_lines(const FileFlags& flags, Inputs& inputs) {
  if (flags.skip_lines == 0 && flags.comment.empty()) {
    return {};
  }
  auto workspace = Workspace::make();
  if (!workspace) {
    return fail(workspace.error());
  }
  inputs.workspace = std::make_shared<Workspace>(std::move(*workspace));
  std::size_t index = 0;
  for (InputFile& file : inputs.files) {
    file.filtered = inputs.workspace->file();
    file.filtered += std::to_string(index++);
    const auto left = copy_without(flags, file.path, file.filtered);
    if (!left) {
      return fail(left.error());
    }
    std::fprintf(stderr, "driftlab: %s: %s left out by --skip-lines, %zu by --comment.\n", file.path.c_str(),
                 with_count(left->skipped, "line").c_str(), left->comments);
  }
  return {};
}

}  // namespace driftlab::cli
