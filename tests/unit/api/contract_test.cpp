// The route table and the embedded contract say the same, in both directions.
#include "schema/contract.hpp"

#include "server/api/api.hpp"
#include "tests/unit/api/world.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <set>

namespace driftlab::server {
namespace {

using Json = nlohmann::json;

struct Described {
  std::string operation_id;
  std::set<std::string> query;
  friend bool operator==(const Described&, const Described&) = default;
};
// GoogleTest asks for this name.
void PrintTo(const Described& described, std::ostream* stream) {  // NOLINT(readability-identifier-naming)
  *stream << described.operation_id << "?";
  for (const std::string& name : described.query) {
    *stream << name << ",";
  }
}
using Table = std::map<std::pair<std::string, std::string>, Described>;  // (method, path)

Table routes_of_the_daemon() {
  World world;
  Table table;
  for (const Route& route : world.router.routes()) {
    Described described{std::string(route.operation_id), {}};
    for (const std::string_view name : route.query) {
      described.query.emplace(name);
    }
    EXPECT_TRUE(table.emplace(std::pair(route.method, route.pattern), described).second) << route.pattern;
  }
  return table;
}

const Json& contract() {
  static const Json document = Json::parse(contract_file("openapi.json"));
  return document;
}

const Json& resolved(const Json& node) {
  return node.contains("$ref") ? contract().at(Json::json_pointer(node["$ref"].get<std::string>().substr(1))) : node;
}

Table routes_of_the_contract() {
  Table table;
  for (const auto& [path, operations] : contract()["paths"].items()) {
    for (const auto& [name, operation] : operations.items()) {
      std::string method = name;
      std::transform(method.begin(), method.end(), method.begin(),
                     [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
      Described described{operation["operationId"].get<std::string>(), {}};
      for (const Json& written : operation.value("parameters", Json::array())) {
        const Json& parameter = resolved(written);
        if (parameter["in"] == "query") {
          described.query.insert(parameter["name"].get<std::string>());
        }
      }
      table.emplace(std::pair(method, path), described);
    }
  }
  return table;
}

TEST(Contract, ListsTheRoutesOfTheDaemonAndNoOthers) {
  const Table daemon = routes_of_the_daemon();
  EXPECT_EQ(daemon, routes_of_the_contract());
  EXPECT_GT(daemon.size(), 20U);
}

TEST(Contract, IsTheVersionOfTheBinary) {
  EXPECT_EQ(contract()["openapi"], "3.1.1");
  EXPECT_EQ(contract()["info"]["version"], DRIFTLAB_VERSION);
}

void collect_references(const Json& node, std::set<std::string>& found) {
  for (const auto& [key, value] : node.items()) {
    if (key == "$ref" && value.is_string()) {
      found.insert(value.get<std::string>());
    } else if (value.is_structured()) {
      collect_references(value, found);
    }
  }
}

TEST(Contract, RefersToSchemasThatAreServed) {
  std::set<std::string> references;
  collect_references(contract(), references);
  int files = 0;
  for (const std::string& reference : references) {
    if (!reference.starts_with('#')) {
      ASSERT_TRUE(reference.starts_with("schemas/")) << reference;
      const std::string name = reference.substr(8, reference.find('#') - 8);
      EXPECT_FALSE(contract_file(name).empty()) << reference;
      ++files;
    }
  }
  EXPECT_GT(files, 5);
}

}  // namespace
}  // namespace driftlab::server
