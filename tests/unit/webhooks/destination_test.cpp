#include "server/webhooks/destination.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

using boost::asio::ip::make_address;
using testing::HasSubstr;

DestinationGuard allowing(const std::vector<std::string>& entries) { return DestinationGuard::with(entries).value(); }

TEST(Destination, OnlyAddressesOfTheInternetAreGlobal) {
  for (const char* const address : {"8.8.8.8", "1.1.1.1", "172.15.255.255", "172.32.0.0", "192.0.1.1", "100.63.255.255",
                                    "100.128.0.0", "223.255.255.255", "198.17.0.1", "198.20.0.0", "2606:4700::1111",
                                    "2a00:1450:4001::1", "2001:4860::8888", "::ffff:8.8.8.8"}) {
    EXPECT_TRUE(is_global(make_address(address))) << address;
  }
  for (const char* const address : {"0.0.0.0",
                                    "0.1.2.3",
                                    "10.0.0.1",
                                    "100.64.0.1",
                                    "100.127.255.255",
                                    "127.0.0.1",
                                    "127.9.9.9",
                                    "169.254.169.254",
                                    "172.16.0.1",
                                    "172.31.255.255",
                                    "192.0.0.8",
                                    "192.0.2.1",
                                    "192.88.99.1",
                                    "192.168.1.1",
                                    "198.18.0.1",
                                    "198.19.255.255",
                                    "198.51.100.7",
                                    "203.0.113.7",
                                    "224.0.0.1",
                                    "239.255.255.255",
                                    "240.0.0.1",
                                    "255.255.255.255",
                                    "::",
                                    "::1",
                                    "::ffff:127.0.0.1",
                                    "::ffff:169.254.169.254",
                                    "::ffff:10.1.2.3",
                                    "::127.0.0.1",
                                    "64:ff9b::7f00:1",
                                    "100::1",
                                    "fc00::1",
                                    "fd12::1",
                                    "fe80::1",
                                    "fec0::1",
                                    "ff02::1",
                                    "2001::1",
                                    "2001:db8::1",
                                    "2002:7f00:1::",
                                    "3fff::1",
                                    "4000::1"}) {
    EXPECT_FALSE(is_global(make_address(address))) << address;
  }
}

TEST(Destination, ReadsTheParts) {
  const auto found = DestinationGuard().read("https://CI.example.org:8443/hooks/driftlab?team=a%20b");
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_TRUE(found->secure);
  EXPECT_EQ(found->host, "ci.example.org");
  EXPECT_EQ(found->port, 8443);
  EXPECT_EQ(found->target, "/hooks/driftlab?team=a%20b");
  EXPECT_EQ(found->authority(), "ci.example.org:8443");
  const auto bare = DestinationGuard().read("https://[2606:4700::1111]");
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_EQ(bare->authority(), "[2606:4700::1111]");
  EXPECT_EQ(bare->target, "/");
  EXPECT_EQ(bare->port, 443);
}

TEST(Destination, RefusesWhatIsNoPlaceForAMessage) {
  for (const char* const url :
       {"", "ci.example.org", "ftp://ci.example.org/", "file:///etc/passwd", "https://", "https:///path",
        "https://user@ci.example.org/", "https://user:secret@ci.example.org/", "https://ci.example.org/#part",
        "https://ci.example.org:0/", "https://ci.example.org:99999/", "https://ci example.org/",
        "https://ci.example.org/\r\nX: y", "http://ci.example.org/", "https://127.0.0.1/", "https://[::1]/",
        "https://[::ffff:10.0.0.1]/", "https://169.254.169.254/latest/meta-data", "https://192.168.1.1/",
        // addresses in disguise, which resolvers take
        "https://2130706433/", "https://0x7f000001/", "https://0x7f.1/", "https://127.1/", "https://0177.0.0.1/"}) {
    EXPECT_FALSE(DestinationGuard().read(url)) << url;
  }
}

TEST(Destination, ExceptionsAreNamesAddressesAndNetworks) {
  const auto guard = allowing({"ci.lab.example", "127.0.0.1", "10.1.2.0/24", "fd00::/8"});
  EXPECT_TRUE(guard.read("http://127.0.0.1:9000/"));
  EXPECT_TRUE(guard.read("http://ci.lab.example/"));
  EXPECT_TRUE(guard.read("https://10.1.2.255/"));
  EXPECT_TRUE(guard.read("http://[fd12::1]/"));
  EXPECT_FALSE(guard.read("http://127.0.0.2/"));
  EXPECT_FALSE(guard.read("https://10.1.3.0/"));
  EXPECT_FALSE(guard.read("http://other.lab.example/"));
  EXPECT_TRUE(guard.admits("anything.example", make_address("10.1.2.3")));
  EXPECT_TRUE(guard.admits("anything.example", make_address("::ffff:10.1.2.3")));
  EXPECT_TRUE(guard.admits("ci.lab.example", make_address("192.168.7.7")));
  EXPECT_FALSE(guard.admits("anything.example", make_address("192.168.7.7")));
  EXPECT_TRUE(guard.admits("anything.example", make_address("8.8.8.8")));
}

TEST(Destination, AnExceptionThatIsNoneIsRefused) {
  for (const char* const entry :
       {"", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/x", "a b", "https://ci.example.org", "fd00::/129"}) {
    const auto refused = DestinationGuard::with({entry});
    ASSERT_FALSE(refused) << entry;
    EXPECT_THAT(refused.error().message, HasSubstr("webhook_allow"));
  }
}

}  // namespace
}  // namespace driftlab::server
