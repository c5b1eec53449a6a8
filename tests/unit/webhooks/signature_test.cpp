#include "server/webhooks/signature.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab::server {
namespace {

// The example of the specification's reference libraries.
constexpr const char* kSecret = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw";
constexpr const char* kId = "msg_p5jXN8AQM9LWM0D4loKWxJek";
constexpr std::int64_t kTimestamp = 1614265330;
constexpr const char* kBody = R"({"test": 2432232314})";
constexpr const char* kSignature = "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=";

TEST(WebhookSignature, IsThatOfTheSpecification) {
  EXPECT_EQ(webhook_signature(kId, kTimestamp, kBody, {kSecret}), kSignature);
}

TEST(WebhookSignature, HasOneForEachSecretThatLives) {
  const std::string other = make_webhook_secret();
  const std::string both = webhook_signature(kId, kTimestamp, kBody, {other, kSecret});
  EXPECT_EQ(both, webhook_signature(kId, kTimestamp, kBody, {other}) + " " + kSignature);
}

TEST(WebhookSignature, IsNotMadeWithWhatIsNoSecret) {
  EXPECT_EQ(webhook_signature(kId, kTimestamp, kBody, {"", "whsec_", "MfKQ9r8GKYqr", "whsec_!!!=", "whsec_abc"}), "");
}

TEST(WebhookSignature, SecretsHaveTheShapeOfTheSpecificationAndDiffer) {
  const std::string secret = make_webhook_secret();
  EXPECT_THAT(secret, testing::MatchesRegex("whsec_[A-Za-z0-9+/]*="));
  EXPECT_EQ(secret.size(), 6U + 44U);  // 32 bytes
  EXPECT_NE(secret, make_webhook_secret());
}

}  // namespace
}  // namespace driftlab::server
