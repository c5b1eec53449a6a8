#include "server/pages/pages.hpp"

#include "server/http/compression.hpp"
#include "server/store/digest.hpp"

#include <algorithm>
#include <array>

namespace driftlab::server {
namespace {

constexpr std::string_view kShell = "/index.html";
constexpr std::string_view kAssets = "/assets/";

/// First parts of the addresses that are pages; `/` is one too.
constexpr std::array<std::string_view, 19> kPages{
    "devices", "recordings",   "compare",  "investigations", "outages", "jobs",        "upload",
    "record",  "regressions",  "studies",  "models",         "drives",  "populations", "drive-evaluations",
    "docs",    "calibrations", "webhooks", "data-sheets",    "problems"};

/// Nothing may run, load or frame but what this daemon serves; no style and no script in the document itself.
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; font-src 'self'; img-src 'self' data:; connect-src "
    "'self'; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

bool is_page(std::string_view path) {
  const std::string_view first = path.substr(1, path.find('/', 1) - 1);
  return first.empty() ? path == "/" : std::find(kPages.begin(), kPages.end(), first) != kPages.end();
}

bool prefers_html(const Request& request) {
  return negotiate(request.header("accept"), {"application/json", "text/html"}) == "text/html";
}

}  // namespace

Pages::Pages(const std::vector<DashboardFile>& files) {
  for (const DashboardFile& file : files) {
    const bool packs = !file.content_type.starts_with("font/") && file.content.size() >= kSmallestCompressed;
    files_.push_back(
        {file, '"' + sha256_hex(file.content).substr(0, 32) + '"', packs ? gzip(file.content, kThorough) : ""});
  }
}

const Pages::Kept* Pages::find(std::string_view path) const {
  const auto found =
      std::find_if(files_.begin(), files_.end(), [&](const Kept& kept) { return kept.file.path == path; });
  return found == files_.end() ? nullptr : &*found;
}

std::optional<Response> Pages::answer(const Request& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    return std::nullopt;
  }
  if (request.path.starts_with(kAssets)) {
    const Kept* const asset = find(request.path);
    return asset == nullptr ? std::nullopt : std::optional(response_of(*asset, request));
  }
  if (!is_page(request.path) || !prefers_html(request)) {
    return std::nullopt;
  }
  const Kept* const shell = find(kShell);
  return shell == nullptr ? std::nullopt : std::optional(response_of(*shell, request));
}

Response Pages::response_of(const Kept& kept, const Request& request) {
  Response response;
  const bool packed = !kept.packed.empty() && takes_gzip(request);
  std::string tag = kept.tag;
  if (packed) {
    tag.replace(tag.size() - 1, 1, "-gzip\"");
  }
  response.content_type = kept.file.content_type;
  const bool shell = kept.file.path == kShell;
  response.headers.emplace_back("Cache-Control", shell ? "no-cache" : "public, max-age=31536000, immutable");
  response.headers.emplace_back("Vary", shell ? "Accept, Accept-Encoding" : "Accept-Encoding");
  response.headers.emplace_back("ETag", tag);
  response.headers.emplace_back("Content-Security-Policy", kPolicy);
  if (const auto known = request.header("if-none-match");
      known && plain_tag(*known).find(kept.tag) != std::string::npos) {
    response.status = 304;
    return response;
  }
  if (packed) {
    response.headers.emplace_back("Content-Encoding", "gzip");
  }
  response.body = packed ? kept.packed : std::string(kept.file.content);
  return response;
}

}  // namespace driftlab::server
