#include "server/store/told_error.hpp"

#include "server/store/files.hpp"

#include <gtest/gtest.h>

#include <cerrno>

namespace driftlab::server {
namespace {

TEST(ToldError, LeavesOutWhereAFileLies) {
  const Error error = file_error(EIO, "flush", "/srv/drift lab/data/blobs/ab/abcd");
  ASSERT_NE(error.message.find("/srv/drift lab/data"), std::string::npos) << "the log names it";
  const Error told = without_paths(error);
  EXPECT_EQ(told.message, "Could not flush [a file that the log names]: Input/output error.");
  EXPECT_TRUE(told.fields.empty());
  EXPECT_EQ(told.code, ErrorCode::Io);
}

TEST(ToldError, LeavesOutWhatALibraryPutIn) {
  const Error told =
      without_paths({ErrorCode::Internal, "Unforeseen: filesystem error: cannot open [/srv/data/x].", {}});
  EXPECT_EQ(told.message, "Unforeseen: filesystem error: cannot open [[a file that the log names]].");
  const Error located =
      without_paths({ErrorCode::Io, "One fault.", {{"/inputs/recordings/0", "Could not read /srv/d/x."}}});
  ASSERT_EQ(located.fields.size(), 1U);
  EXPECT_EQ(located.fields[0], (ErrorField{"/inputs/recordings/0", "Could not read [a file that the log names]."}));
}

TEST(ToldError, KeepsPathsOfTheApiAndWhatClientsSent) {
  const Error of_api{
      ErrorCode::Internal, "Ask /v1/jobs again; /docs/operations says more, 5 deg/s too.", {{"row", "17"}}};
  EXPECT_EQ(without_paths(of_api).message, of_api.message);
  EXPECT_EQ(without_paths(of_api).fields, of_api.fields);
  const Error of_client{ErrorCode::NotFound, "There is no device \"/etc/passwd\".", {}};
  EXPECT_EQ(without_paths(of_client).message, of_client.message);
}

}  // namespace
}  // namespace driftlab::server
