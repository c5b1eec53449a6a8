#include "server/http/chunked.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace driftlab::server {
namespace {

struct Read {
  std::string data;
  std::size_t taken = 0;  ///< what stands behind belongs to the next request
  bool done = false;
  bool refused = false;
};

/// Feeds `body` in pieces of `piece` bytes, each beside what was left of those before.
Read read(std::string_view body, std::size_t piece) {
  Read result;
  ChunkedBody reader;
  std::size_t arrived = 0;
  while (!reader.done()) {
    const auto step = reader.step(body.substr(result.taken, arrived - result.taken));
    if (!step) {
      result.refused = true;
      return result;
    }
    result.data += step->data;
    result.taken += step->taken;
    if (step->taken == 0 && !reader.done()) {
      if (arrived == body.size()) {
        return result;
      }
      arrived = std::min(arrived + piece, body.size());
    }
  }
  result.done = true;
  return result;
}

TEST(Chunked, GivesTheSameContentHoweverTheBytesArrive) {
  const std::string next = "GET / HTTP/1.1\r\n";
  const std::string body = "4\r\nabcd\r\n00A;name=\"a;b\"\r\n\r\n23456789\r\n1\r\n\r\r\n0;last\r\n\r\n";
  for (std::size_t piece = 1; piece <= body.size() + next.size(); ++piece) {
    const Read found = read(body + next, piece);
    ASSERT_TRUE(found.done) << piece;
    ASSERT_EQ(found.data, "abcd\r\n23456789\r") << piece;
    ASSERT_EQ(found.taken, body.size()) << piece;
  }
}

TEST(Chunked, RefusesWhatReadersDisagreeAbout) {
  for (const char* const body :
       {"4\nabcd\r\n0\r\n\r\n", "4\r\nabcd\n0\r\n\r\n", "4\r\nabcde\r\n0\r\n\r\n", "4\r\nabc\r\n\r\n0\r\n\r\n",
        "0\r\nAuthorization: Bearer x\r\n\r\n", "0\r\n\n", "0x4\r\nabcd\r\n0\r\n\r\n", "-4\r\nabcd\r\n0\r\n\r\n",
        "+4\r\nabcd\r\n", " 4\r\nabcd\r\n", "4 \r\nabcd\r\n", "\r\n\r\n", ";a\r\n\r\n", "g\r\n", "4;a\rb\r\nabcd\r\n",
        "4;a\nb\r\nabcd\r\n", "10000000000000000\r\n", "4\r\rabcd"}) {
    for (const std::size_t piece : {std::size_t{1}, std::size_t{64}}) {
      const Read found = read(body, piece);
      EXPECT_TRUE(found.refused) << body << " in pieces of " << piece;
    }
  }
}

TEST(Chunked, HoldsNoLongLine) {
  const std::string fits = "0;" + std::string(254, 'x') + "\r\n\r\n";
  EXPECT_TRUE(read(fits, 1).done);
  const std::string endless = "0;" + std::string(255, 'x');
  EXPECT_TRUE(read(endless, 1).refused);
  EXPECT_TRUE(read(endless, 4096).refused);
}

TEST(Chunked, WaitsForWhatHasNotCome) {
  const std::string body = "3\r\nabc\r\n0\r\n\r\n";
  for (std::size_t length = 0; length < body.size(); ++length) {
    const Read found = read(body.substr(0, length), length + 1);
    EXPECT_FALSE(found.done || found.refused) << length;
  }
  EXPECT_EQ(read("ffffffffffffffff\r\nabc", 64).data, "abc");
}

}  // namespace
}  // namespace driftlab::server
