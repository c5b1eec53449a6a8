#include "server/store/s3/signature.hpp"

#include "server/store/digest.hpp"
#include "server/store/s3/client.hpp"
#include "server/store/s3/xml.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace driftlab::server::s3 {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// Key and time of the examples in "Authenticating Requests: Using the Authorization Header" of the Amazon S3 API
/// Reference, whose signatures these are.
const Credentials kExampleKey{
    "AKIAIOSFODNN7"
    "EXAMPLE",
    "wJalrXUtnFEMI/K7MDENG/bPxRfiCYEXAMPLEKEY", ""};
constexpr UtcMicros kExampleTime = 1'369'353'600'000'000;  // 2013-05-24T00:00:00Z

std::string signature_of(Signed request) {
  request.headers.emplace_back("host", "examplebucket.s3.amazonaws.com");
  const Pairs headers = signed_headers(request, kExampleKey, "us-east-1", kExampleTime);
  const std::string value = headers.back().second;
  return value.substr(value.rfind('=') + 1);
}

TEST(S3Signature, IsThatOfThePublishedExamples) {
  const std::string nothing = sha256_hex("");
  EXPECT_EQ(signature_of({"GET", "/test.txt", {}, {{"range", "bytes=0-9"}}, nothing}),
            "f0e8bdb87c964420e857bd35b5d6ed310bd44f0170aba48dd91039c6036bdb41");
  EXPECT_EQ(signature_of({"PUT",
                          "/test$file.text",
                          {},
                          {{"date", "Fri, 24 May 2013 00:00:00 GMT"}, {"x-amz-storage-class", "REDUCED_REDUNDANCY"}},
                          sha256_hex("Welcome to Amazon S3.")}),
            "98ad721746da40c64f1a55b78f14c238d841ea1380cd77a1b5971af0ece108bd");
  EXPECT_EQ(signature_of({"GET", "/", {{"lifecycle", ""}}, {}, nothing}),
            "fea454ca298b7da1c68078a5d1bdbfbbe0d65c699e0f91ac7a200a0136783543");
  EXPECT_EQ(signature_of({"GET", "/", {{"prefix", "J"}, {"max-keys", "2"}}, {}, nothing}),
            "34b48302e7b5fa45bde8084f4b7868a86f0a534bc59db6670ed5711ef69dc6f7");
}

TEST(S3Signature, ATemporaryKeySendsItsToken) {
  Credentials key = kExampleKey;
  key.session_token = "token";
  const Pairs headers = signed_headers({"GET", "/", {}, {}, ""}, key, "us-east-1", kExampleTime);
  EXPECT_THAT(headers, testing::Contains(testing::Pair("x-amz-security-token", "token")));
}

TEST(S3Signature, EncodesByBytes) {
  EXPECT_EQ(percent_encoded("a b/ü~*"), "a%20b%2F%C3%BC~%2A");
  EXPECT_EQ(percent_encoded("a b/c", true), "a%20b/c");
  EXPECT_EQ(canonical_query({{"b", "2"}, {"a", "1=&"}}), "a=1%3D%26&b=2");
}

TEST(S3Xml, FindsElementsByTheirWholeName) {
  const std::string text =
      "<?xml version='1.0'?><R "
      "xmlns=\"x\"><Key>a&amp;b&#38;&lt;&unknown;</Key><KeyCount>2</KeyCount><Key/><Key>c</Key></R>";
  EXPECT_THAT(elements(text, "Key"), ElementsAre("a&amp;b&#38;&lt;&unknown;", "", "c"));
  EXPECT_EQ(element_text(text, "Key"), "a&b&<&unknown;");
  EXPECT_EQ(element_text(text, "Other"), std::nullopt);
}

TEST(S3Xml, WhatIsNoXmlHasNoElements) {
  for (const char* text : {"", "<", "<Key", "<Key>", "<Key>a</Ke", "<Key a", "</Key>", "&;<Key>&</Key"}) {
    EXPECT_THAT(elements(text, "Key"), IsEmpty()) << text;
  }
  EXPECT_EQ(element_text("<Key>a&b</Key>", "Key"), "a&b");
  EXPECT_EQ(element_text("<Key>&#x41;&#xFFFFFFFFF;</Key>", "Key"), "A&#xFFFFFFFFF;");
}

TEST(S3Time, ReadsBothForms) {
  EXPECT_EQ(read_time("Fri, 24 May 2013 00:00:00 GMT"), kExampleTime);
  EXPECT_EQ(read_time("2013-05-24T00:00:00.000Z"), kExampleTime);
  EXPECT_EQ(read_time("yesterday"), std::nullopt);
}

}  // namespace
}  // namespace driftlab::server::s3
