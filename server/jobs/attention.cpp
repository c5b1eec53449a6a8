#include "server/jobs/attention.hpp"

#include "core/analysis/told_characterisation.hpp"

#include <utility>

namespace driftlab::server {

void note_attention(Attention about, std::string_view level, const std::string& verdict, JobResults& results) {
  if (level == name_of(VerdictLevel::Fine)) {
    return;
  }
  about.level = level;
  about.verdict = verdict;
  results.attention.push_back(std::move(about));
}

}  // namespace driftlab::server
