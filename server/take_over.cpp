#include "server/take_over.hpp"

#include "server/http/problem.hpp"
#include "server/jobs/fault_recorder.hpp"
#include "server/jobs/told_glance.hpp"
#include "server/observe/log.hpp"
#include "server/store/files.hpp"

namespace driftlab::server {
namespace {

/// Attempts during which an earlier daemon died of a fault count against their jobs.
Status charge_faults(Store& store, const std::filesystem::path& file) {
  auto faults = take_recorded_faults(file);
  if (!faults) {
    return fail(faults.error());
  }
  for (const Lease& lease : *faults) {
    AttemptFailure failure;
    failure.problem_json =
        problem_document({ErrorCode::Internal, "The daemon died of a fault while it ran this job.", {}});
    failure.retryable = true;
    failure.fault_signal = true;
    log_warning("a job brought an earlier daemon down", Json{{"job", lease.job_id}, {"attempt", lease.attempt}});
    if (auto failed = store.fail_attempt(lease, failure); !failed) {
      return fail(failed.error());
    }
  }
  return install_fault_recorder(file);
}

/// Whoever comes first to a store knows that nobody works with it; later ones let leases expire.
Status end_leases_of_the_dead(Store& store, Coordination* others) {
  if (others == nullptr || others->came_first()) {
    const auto ended = store.end_all_leases();
    if (!ended) {
      return fail(ended.error());
    }
    if (*ended > 0) {
      log_info("leases of an earlier daemon ended", Json{{"jobs", *ended}});
    }
  }
  return others != nullptr ? others->admit_others() : Status{};
}

/// The first admin token, for whoever can read the file.
Status write_first_token(Gate& gate, const std::filesystem::path& path) {
  const Caller command{Principal{"", "daemon", Scope::Admin, {}, ""}, "", ""};
  const ActingFor acting(command);
  auto issued = gate.create({"first admin", Scope::Admin, std::nullopt, std::nullopt});
  if (!issued) {
    return fail(issued.error());
  }
  if (Status written = write_secret_file(path, issued->secret + "\n"); !written) {
    (void)gate.revoke(issued->token.id, true);
    return written;
  }
  log_warning("authentication is on; the first admin token lies in a file that only its owner can read",
              Json{{"file", path.string()}, {"token", issued->token.id}});
  return {};
}

/// Of a document that cannot be read there is nothing to show.
Glance glance_of_document(const std::string& document_json) {
  const Json channel = Json::parse(document_json, nullptr, false);
  return channel.is_object() ? told_glance(channel).value_or(Glance{}) : Glance{};
}

}  // namespace

Status take_over(SqlStore& store, Coordination* others, const Settings& settings) {
  if (auto charged = charge_faults(store, settings.data / "faults"); !charged) {
    return charged;
  }
  if (auto ended = end_leases_of_the_dead(store, others); !ended) {
    return ended;
  }
  const auto seen = store.keep_missing_glances(glance_of_document);
  if (!seen) {
    return fail(seen.error());
  }
  if (*seen > 0) {
    log_info("results of an earlier release are shown in lists of devices", Json{{"results", *seen}});
  }
  const auto sealed = store.seal_unsealed_rows();
  if (!sealed) {
    return fail(sealed.error());
  }
  if (*sealed > 0) {
    log_info("rows of an earlier release have checksums now", Json{{"rows", *sealed}});
  }
  const auto queued = store.queue_missing_pools();
  if (!queued) {
    return fail(queued.error());
  }
  if (*queued > 0) {
    log_info("results of an earlier release are pooled again", Json{{"jobs", *queued}});
  }
  return {};
}

Status open_gate(Gate& gate, const Settings& settings) {
  if (Status loaded = gate.load(); !loaded) {
    return loaded;
  }
  if (settings.require_tokens && settings.serves_api && !gate.has_any()) {
    return write_first_token(gate, settings.data / "first-admin-token");
  }
  return {};
}

}  // namespace driftlab::server
