#include "server/http/forwarded.hpp"

#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

using Headers = std::vector<std::pair<std::string, std::string>>;
const std::vector<Network> kProxies = networks({"10.0.0.1", "10.0.0.2"});

std::string seen(const std::string& peer, const Headers& headers) { return client_address(peer, headers, kProxies); }

TEST(Forwarded, IsBelievedOfListedProxiesAlone) {
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "for=192.0.2.7;proto=https"}}), "192.0.2.7");
  EXPECT_EQ(seen("192.0.2.9", {{"forwarded", "for=192.0.2.7"}}), "192.0.2.9");
  EXPECT_EQ(client_address("127.0.0.1", {{"forwarded", "for=192.0.2.7"}}, {}), "127.0.0.1");
  EXPECT_EQ(seen("10.0.0.1", {{"x-forwarded-for", "192.0.2.7"}}), "10.0.0.1") << "another header says nothing";
}

TEST(Forwarded, TakesTheNearestThatIsNoProxy) {
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "for=203.0.113.5, for=192.0.2.7, for=10.0.0.2"}}), "192.0.2.7")
      << "what stands left of the client is its own claim";
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "for=203.0.113.5"}, {"forwarded", "for=192.0.2.7"}}), "192.0.2.7");
}

TEST(Forwarded, ReadsPortsQuotesAndVersionSix) {
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "proto=https; For=\"192.0.2.7:4711\""}}), "192.0.2.7");
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "for=\"[2001:db8::1]:80\""}}), "2001:db8::1");
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "by=\"a;for=1.2.3.4,x\";for=192.0.2.7"}}), "192.0.2.7");
}

TEST(Forwarded, KnowsAProxyInWhicheverFormItsAddressComes) {
  EXPECT_TRUE(is_listed("10.1.2.9", networks({"192.0.2.1", "10.1.2.0/24"})));
  EXPECT_FALSE(is_listed("10.1.3.9", networks({"10.1.2.0/24"})));
  EXPECT_TRUE(is_listed("2001:db8::5", networks({"2001:db8::/32"})));
  EXPECT_TRUE(is_listed("::ffff:10.1.2.9", networks({"10.1.2.0/24"}))) << "as a socket for both families has it";
  EXPECT_TRUE(is_listed("10.1.2.9", networks({"::ffff:10.1.2.9"})));
  EXPECT_FALSE(is_listed("", networks({"10.1.2.0/24"})));
  EXPECT_EQ(plain_text(boost::asio::ip::make_address("::ffff:10.1.2.9")), "10.1.2.9");
  EXPECT_EQ(plain_text(boost::asio::ip::make_address("2001:db8::5")), "2001:db8::5");
  EXPECT_EQ(seen("10.0.0.1", {{"forwarded", "for=\"[::ffff:192.0.2.7]\""}}), "192.0.2.7");
  for (const char* const none : {"10.0.0.0/33", "10.0.0.0/x", "10.0.0.0/", "2001:db8::/129", "host", ""}) {
    EXPECT_FALSE(Network::parse(none)) << none;
  }
}

TEST(Forwarded, NamesTheProxyWhereTheHeaderHidesOrIsMalformed) {
  for (const char* const value : {"for=unknown", "for=_hidden", "for=", "proto=https", "for=\"[::1\"", "for=1.2.3", "",
                                  "for=192.0.2.7, for=_x"}) {
    EXPECT_EQ(seen("10.0.0.1", {{"forwarded", value}}), "10.0.0.1") << value;
  }
}

}  // namespace
}  // namespace driftlab::server
