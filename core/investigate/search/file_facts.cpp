#include "core/investigate/search/file_facts.hpp"

#include "core/investigate/causes/cause.hpp"
#include "core/investigate/search/fact_gain.hpp"
#include "core/investigate/study/lattice.hpp"

#include <algorithm>
#include <utility>

namespace driftlab::investigate {

FileFacts look_at_files(const ChannelGroup& group, const std::stop_token& stop) {
  FileFacts facts;
  for (const auto& member : group.members) {
    facts.mask.emplace_back(member.recording->length, 0);
  }
  for (const Cause& cause : cause_registry()) {
    const FileFact* const fact = cause.as<FileFact>();
    if (fact == nullptr) {
      continue;
    }
    std::vector<Evidence> found = fact->find(group, stop);
    if (stop.stop_requested()) {
      break;
    }
    for (Evidence& evidence : found) {
      evidence.cause = &cause;
      std::vector<std::vector<unsigned char>> spoilt(group.members.size());
      for (const std::size_t r : evidence.members) {
        spoilt[r].assign(group.members[r].recording->length, 0);
        if (fact->spoils != nullptr) {
          fact->spoils(group, evidence, r, spoilt[r]);
          std::transform(facts.mask[r].begin(), facts.mask[r].end(), spoilt[r].begin(), facts.mask[r].begin(),
                         [](unsigned char a, unsigned char b) { return static_cast<unsigned char>(a | b); });
        }
      }
      hold_out_fact(group, spoilt, evidence);
      if (fact->gives_lattice_step && !evidence.parameters.empty()) {
        facts.lattice_step = evidence.parameters[0].estimate.value;
      }
      facts.found.push_back(std::move(evidence));
    }
  }
  if (facts.lattice_step == 0.0) {
    const Channel& channel = *group.members.front().channel;
    const Lattice lattice = find_lattice(channel.rows, stop);
    facts.lattice_step = std::max(lattice.step, lattice.decimals) * channel.unit.factor;
  }
  return facts;
}

}  // namespace driftlab::investigate
