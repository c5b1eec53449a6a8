#include "server/http/multipart.hpp"

#include <gtest/gtest.h>

#include <map>

namespace driftlab::server {
namespace {

struct Read {
  std::vector<std::pair<std::string, std::string>> parts;
  std::optional<ErrorCode> fault;
};

/// Feeds `body` in pieces of `piece` bytes.
Read read(std::string_view body, std::size_t piece, std::string_view boundary = "b") {
  Read result;
  MultipartReader reader(boundary, {[&](const std::string& name, const std::string&) -> Status {
                                      result.parts.emplace_back(name, "");
                                      return {};
                                    },
                                    [&](std::span<const std::byte> bytes) -> Status {
                                      result.parts.back().second.append(reinterpret_cast<const char*>(bytes.data()),
                                                                        bytes.size());
                                      return {};
                                    }});
  for (std::size_t at = 0; at < body.size(); at += piece) {
    const std::string_view bytes = body.substr(at, piece);
    if (const Status fed = reader.feed(std::as_bytes(std::span(bytes.data(), bytes.size()))); !fed) {
      result.fault = fed.error().code;
      return result;
    }
  }
  if (const Status done = reader.finish(); !done) {
    result.fault = done.error().code;
  }
  return result;
}

std::string part(const std::string& name, const std::string& content) {
  return "--b\r\nContent-Disposition: form-data; name=\"" + name + "\"\r\n\r\n" + content + "\r\n";
}

TEST(Multipart, GivesTheSamePartsHoweverTheBytesArrive) {
  const std::string tricky = "a\r\n--\r\n--c\r\n-\r\n--B\r\n\r\n";  // everything but the boundary
  const std::string body =
      part("metadata", "{}") + part("file", tricky) + part("empty", "") + "--b--\r\nepilogue --b\r\n";
  for (std::size_t piece = 1; piece <= body.size(); ++piece) {
    const Read found = read(body, piece);
    ASSERT_FALSE(found.fault) << piece;
    ASSERT_EQ(found.parts,
              (std::vector<std::pair<std::string, std::string>>{{"metadata", "{}"}, {"file", tricky}, {"empty", ""}}))
        << piece;
  }
}

TEST(Multipart, SkipsAPreambleAndBlanksAfterABoundary) {
  const Read found = read(
      "preamble\r\n--b  \r\nContent-Type: text/plain\r\ncontent-disposition: form-data; filename=x; "
      "name=file\r\n\r\n1\r\n--b--",
      3);
  EXPECT_FALSE(found.fault);
  EXPECT_EQ(found.parts, (std::vector<std::pair<std::string, std::string>>{{"file", "1"}}));
}

TEST(Multipart, SaysWhenTheClosingBoundaryNeverCame) {
  const std::string body = part("file", "1,2,3") + "--b--";
  for (std::size_t size = 0; size < body.size(); ++size) {
    EXPECT_EQ(read(std::string_view(body).substr(0, size), 5).fault, ErrorCode::Truncated) << size;
  }
  EXPECT_FALSE(read(body, 5).fault);
}

TEST(Multipart, RefusesPartHeadersThatAreEndlessOrNameless) {
  EXPECT_EQ(read("--b\r\nContent-Type: text/plain\r\n\r\nx\r\n--b--", 7).fault, ErrorCode::ParseError);
  EXPECT_EQ(read("--b\r\n\r\nx\r\n--b--", 7).fault, ErrorCode::ParseError);
  EXPECT_EQ(read("--b\r\nX: " + std::string(9000, 'y'), 1000).fault, ErrorCode::ParseError);
  EXPECT_EQ(read("--b" + std::string(9000, ' '), 1000).fault, ErrorCode::ParseError);
  EXPECT_EQ(read("--b\r\nX: " + std::string(9000, 'y') + "\r\nContent-Disposition: form-data; name=a\r\n\r\nx\r\n--b--",
                 20000)
                .fault,
            ErrorCode::ParseError);
}

TEST(Multipart, StopsWhereACallbackRefuses) {
  int data_calls = 0;
  MultipartReader reader(
      "b", {[](const std::string&, const std::string&) -> Status { return fail(ErrorCode::InvalidArgument, "No."); },
            [&](std::span<const std::byte>) -> Status {
              ++data_calls;
              return {};
            }});
  const std::string body = part("file", "1") + "--b--";
  const Status fed = reader.feed(std::as_bytes(std::span(body)));
  ASSERT_FALSE(fed);
  EXPECT_EQ(fed.error().code, ErrorCode::InvalidArgument);
  EXPECT_EQ(data_calls, 0);
}

TEST(MultipartBoundary, IsReadFromTheContentType) {
  EXPECT_EQ(multipart_boundary("multipart/form-data; boundary=abc"), "abc");
  EXPECT_EQ(multipart_boundary("Multipart/Form-Data ; charset=utf-8; Boundary=\"a b\""), "a b");
  for (const char* const type : {"", "text/csv", "multipart/mixed; boundary=a", "multipart/form-data",
                                 "multipart/form-data; boundary=", "multipart/form-data; boundary=\"\""}) {
    EXPECT_FALSE(multipart_boundary(type)) << type;
  }
  EXPECT_FALSE(multipart_boundary("multipart/form-data; boundary=" + std::string(71, 'a')));
}

}  // namespace
}  // namespace driftlab::server
