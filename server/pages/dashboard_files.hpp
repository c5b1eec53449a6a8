#pragma once
/// The dashboard inside the binary: what clients/dashboard builds, made into a source by clients/dashboard/embed.mjs.
#include <string_view>
#include <vector>

namespace driftlab::server {

struct DashboardFile {
  std::string_view path;  ///< as it is asked for: `/assets/main-3F2A.css`; the page itself is `/index.html`
  std::string_view content_type;
  std::string_view content;
};

/// Empty in a daemon that was built without (-DDRIFTLAB_DASHBOARD=OFF).
[[nodiscard]] const std::vector<DashboardFile>& dashboard_files();

}  // namespace driftlab::server
