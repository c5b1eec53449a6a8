/// The line of a request is put together as text: it must be JSON whatever a client writes into it.
#include "schema/json/json.hpp"
#include "server/observe/log.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>

namespace driftlab::server {
namespace {

Json read(const LogFields& fields) { return Json::parse("{" + fields.members() + "}"); }

TEST(LogFields, MembersStandInTheirOrder) {
  EXPECT_EQ(LogFields().text("method", "GET").count("status", 200).text_or_null("token", "").members(),
            R"("method":"GET","status":200,"token":null)");
}

TEST(LogFields, EveryByteOfATextComesBackOrIsReplaced) {
  for (int byte = 0; byte < 0x80; ++byte) {
    const std::string text = "/v1/" + std::string(1, static_cast<char>(byte)) + "x";
    EXPECT_EQ(read(LogFields().text("target", text))["target"], text) << byte;
  }
  EXPECT_EQ(read(LogFields().text("target", "\xC3\xA9"))["target"], "\xC3\xA9");
  EXPECT_EQ(read(LogFields().text("target", "a\xFFz"))["target"], "a\xEF\xBF\xBDz");
}

TEST(LogFields, NumbersComeBackAsTheyWere) {
  for (const double seconds : {0.0, 1e-5, 0.000123, 1.0 / 3.0, 86400.0, 1e300}) {
    EXPECT_EQ(read(LogFields().number("seconds", seconds))["seconds"].get<double>(), seconds);
  }
  EXPECT_TRUE(read(LogFields().number("seconds", std::numeric_limits<double>::quiet_NaN()))["seconds"].is_null());
  EXPECT_EQ(read(LogFields().count("bytes", UINT64_MAX))["bytes"].get<std::uint64_t>(), UINT64_MAX);
}

}  // namespace
}  // namespace driftlab::server
