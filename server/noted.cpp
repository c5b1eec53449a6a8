#include "server/noted.hpp"

#include "server/observe/log.hpp"
#include "server/store/told_error.hpp"

namespace driftlab::server {
namespace {

/// Whether the disk failed, and not a limit that somebody set: such an error names its file.
bool is_of_the_disk(const Error& error) {
  return (error.code == ErrorCode::Io || error.code == ErrorCode::DiskFull) &&
         without_paths(error).message != error.message;
}

}  // namespace

void note_state(const StandingState& state, bool begins) {
  Json fields{{"state", name_of(state.state)}, {"cause", state.cause}, {"detail", state.detail}};
  if (!state.object.empty()) {
    fields[state.state == BadState::RowDamaged ? "row" : "blob"] = state.object;
  }
  begins ? log_error("bad state", fields) : log_info("bad state ended", fields);
}

void note_failure(BadStates& states, const Error& error, const Json& where) {
  Json fields = where;
  fields["code"] = driftlab::name_of(error.code);
  fields["detail"] = error.message;
  log_error("failed", fields);
  if (is_of_the_disk(error)) {
    states.note_failure(error);
  }
}

void note_escape(std::string_view where, std::string_view what) {
  log_error("exception", Json{{"where", where}, {"detail", what}});
}

void note_request(Metrics& metrics, BadStates& states, const AccessRecord& record) {
  if (record.failure) {
    note_failure(states, *record.failure, Json{{"request_id", record.request_id}, {"route", record.route}});
  }
  metrics.count_request(record.method, record.route, record.status, record.seconds - record.client_seconds,
                        record.bytes_in, record.bytes_out);
  log_info("request", LogFields()
                          .text("method", record.method)
                          .text("route", record.route)
                          .text("target", record.target)
                          .count("status", static_cast<std::uint64_t>(record.status))
                          .count("bytes_in", record.bytes_in)
                          .count("bytes_out", record.bytes_out)
                          .number("seconds", record.seconds)
                          .text("request_id", record.request_id)
                          .text("address", record.address)
                          .text_or_null("token", record.token));
}

}  // namespace driftlab::server
