// Recordings to try driftlab with: simulated on demand from published figures, so that none has to be distributed.
#include "core/analysis/simulate.hpp"
#include "core/signal/number.hpp"
#include "server/api/api.hpp"

#include <array>
#include <charconv>

namespace driftlab::server {
namespace {

std::string csv_of(const SampleTable& table) {
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    text += (c == 0 ? "" : ",") + table.columns[c];
  }
  text += '\n';
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      std::array<char, 64> buffer{};
      const auto [stop, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), table.at(row, c),
                                               std::chars_format::fixed, table.decimals[c]);
      text += c == 0 ? "" : ",";
      text.append(buffer.data(), error == std::errc{} ? static_cast<std::size_t>(stop - buffer.data()) : 0);
    }
    text += '\n';
  }
  return text;
}

Result<Response> get_sample(const Request& request) {
  auto condition = parse_condition(request.parameter("condition").value_or("static"));
  if (!condition) {
    return fail(Error(condition.error()).with("parameter", "condition"));
  }
  AxisSimulation wanted;
  wanted.condition = *condition;
  if (const auto text = request.parameter("seed")) {
    const auto [stop, error] = std::from_chars(text->data(), text->data() + text->size(), wanted.seed);
    if (error != std::errc{} || stop != text->data() + text->size()) {
      return fail(ErrorCode::InvalidArgument, "The seed is a whole number from 0.", {{"parameter", "seed"}});
    }
  }
  auto table = simulate_preset(request.parameters[0], wanted);
  if (!table) {
    return fail(table.error());
  }
  Response response;
  response.content_type = "text/csv; charset=utf-8";
  response.body = csv_of(*table);
  return response;
}

}  // namespace

void add_sample_routes(Router& router, ApiContext& /*context*/) {
  router.add({"GET", "/v1/samples/{preset}", "getSample", {"condition", "seed"}, Handler([](const Request& request) {
                return get_sample(request);
              })});
}

}  // namespace driftlab::server
