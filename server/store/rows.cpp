#include "server/store/rows.hpp"

#include <array>
#include <utility>

namespace driftlab::server {
namespace {

constexpr std::array<std::pair<JobState, std::string_view>, 6> kStates = {{{JobState::Queued, "queued"},
                                                                           {JobState::Running, "running"},
                                                                           {JobState::Succeeded, "succeeded"},
                                                                           {JobState::Failed, "failed"},
                                                                           {JobState::Cancelled, "cancelled"},
                                                                           {JobState::Dead, "dead"}}};

}  // namespace

std::string_view name_of(JobState state) {
  for (const auto& [value, name] : kStates) {
    if (value == state) {
      return name;
    }
  }
  return "queued";
}

std::optional<JobState> parse_job_state(std::string_view name) {
  for (const auto& [value, text] : kStates) {
    if (text == name) {
      return value;
    }
  }
  return std::nullopt;
}

bool is_terminal(JobState state) { return state != JobState::Queued && state != JobState::Running; }

}  // namespace driftlab::server
