#include "server/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

TEST(Settings, ListenOnThisMachineAlone) {
  const auto address = listen_address(Settings{});
  ASSERT_TRUE(address) << address.error().message;
  EXPECT_EQ(address->address, "127.0.0.1");
  EXPECT_EQ(address->port, 8477);
}

TEST(Settings, RefuseAnotherAddressWithoutTlsAndTokensUnlessInsecure) {
  for (const char* const listen : {"0.0.0.0:8477", "192.168.1.4:80", "[::]:8477", "[2001:db8::1]:1"}) {
    Settings settings;
    settings.listen = listen;
    const auto address = listen_address(settings);
    ASSERT_TRUE(address) << listen;
    const auto refused = require_safe_address(settings, *address, true);
    ASSERT_FALSE(refused) << listen;
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(refused.error().fields[0], (ErrorField{"parameter", "listen"}));
    EXPECT_THAT(refused.error().message, testing::HasSubstr("--insecure"));
    settings.insecure = true;
    EXPECT_TRUE(require_safe_address(settings, *address, false)) << listen;
    settings.insecure = false;
    settings.tls_certificate = "certificate.pem";
    settings.tls_key = "key.pem";
    EXPECT_FALSE(require_safe_address(settings, *address, false)) << listen;
    EXPECT_TRUE(require_safe_address(settings, *address, true)) << listen;
    settings.require_tokens = true;
    EXPECT_TRUE(require_safe_address(settings, *address, false)) << listen;
  }
}

TEST(Settings, TakeLoopbackInEitherFamily) {
  for (const auto& [listen, address] : {std::pair{"127.0.0.2:1", "127.0.0.2"}, std::pair{"[::1]:8477", "::1"}}) {
    Settings settings;
    settings.listen = listen;
    const auto taken = listen_address(settings);
    ASSERT_TRUE(taken) << listen;
    EXPECT_EQ(taken->address, address);
    EXPECT_TRUE(require_safe_address(settings, *taken, false)) << listen;
  }
}

TEST(Settings, TakeCertificateAndKeyTogether) {
  Settings settings;
  settings.tls_certificate = "certificate.pem";
  EXPECT_EQ(listen_address(settings).error().fields[0], (ErrorField{"parameter", "tls-key"}));
  std::swap(settings.tls_certificate, settings.tls_key);
  EXPECT_EQ(listen_address(settings).error().fields[0], (ErrorField{"parameter", "tls-certificate"}));
}

TEST(Settings, RefuseWhatIsNoAddressAndPort) {
  for (const char* const listen :
       {"", "8477", "localhost:8477", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:65536", "127.0.0.1:80 "}) {
    Settings settings;
    settings.listen = listen;
    settings.insecure = true;
    EXPECT_FALSE(listen_address(settings)) << listen;
  }
}

TEST(Settings, AConnectionStringIsShownWithoutItsPassword) {
  EXPECT_EQ(without_password("postgresql://me:secret@db:5432/x?sslmode=require"),
            "postgresql://me:***@db:5432/x?sslmode=require");
  EXPECT_EQ(without_password("postgresql://me:a/b@c@db/x"), "postgresql://me:***@db/x");
  EXPECT_EQ(without_password("postgresql:///x?user=me&password=secret&host=/run"),
            "postgresql:///x?user=me&password=***&host=/run");
  for (const char* const plain :
       {"", "postgresql://me@db:5432/x", "postgresql://[::1]:5432/x", "postgresql:///x?host=/run"}) {
    EXPECT_EQ(without_password(plain), plain);
  }
}

}  // namespace
}  // namespace driftlab::server
