#include "schema/json/toy.hpp"

namespace driftlab {

Json to_json(const ToyReport& report) {
  Json means = Json::array();
  for (const ToyMean& one : report.means) {
    means.push_back(Json{{"recording", one.recording}, {"channel", one.channel}, {"mean", number(one.mean)}});
  }
  return Json{{"means", std::move(means)}};
}

}  // namespace driftlab
