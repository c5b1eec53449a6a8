/// Backups of the daemon's data directory: made when asked, by the timer, and listed.
#include "server/store/backups.hpp"

#include "server/api/api.hpp"
#include "server/api/documents.hpp"

#include <algorithm>

namespace driftlab::server {
namespace {

Json to_json(const Backup& backup) {
  const bool running = backup.state == BackupState::Running;
  return Json{{"name", backup.name},
              {"state", name_of(backup.state)},
              {"begun_at", rfc3339(backup.begun_at)},
              {"finished_at", backup.finished_at ? Json(rfc3339(*backup.finished_at)) : Json(nullptr)},
              {"recordings", running ? Json(nullptr) : Json(backup.blobs)},
              {"bytes", running ? Json(nullptr) : Json(backup.bytes)},
              {"faults", backup.faults}};
}

Result<Response> create_backup(ApiContext& context) {
  const auto begun = context.backups->begin();
  return begun ? Result<Response>(json_response(202, to_json(*begun))) : fail(begun.error());
}

Result<Response> list_backups(ApiContext& context, const Request& request) {
  const auto page = page_of(request, [](std::string_view cursor) { return is_backup_name(cursor); });
  if (!page) {
    return fail(page.error());
  }
  auto backups = context.backups->list();
  if (!backups) {
    return fail(backups.error());
  }
  const bool newest_first = page->order == PageOrder::NewestFirst;
  if (!newest_first) {
    std::reverse(backups->begin(), backups->end());
  }
  ListPage list(request, *page);
  auto backup = std::find_if(backups->begin(), backups->end(), [&](const Backup& each) {
    return page->after.empty() || (newest_first ? each.name < page->after : each.name > page->after);
  });
  while (backup != backups->end() && list.add(to_json(*backup), backup->name)) {
    ++backup;
  }
  return list.response(backup != backups->end());
}

}  // namespace

void add_backup_routes(Router& router, ApiContext& context) {
  router.add({"GET", "/v1/backups", "listBackups", {"limit", "cursor", "sort"}, Handler([&](const Request& request) {
                return list_backups(context, request);
              })});
  router.add(
      {"POST", "/v1/backups", "createBackup", {}, Handler([&](const Request&) { return create_backup(context); })});
}

}  // namespace driftlab::server
