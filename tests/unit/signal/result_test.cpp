#include "core/signal/result.hpp"

#include <gtest/gtest.h>

#include <set>

namespace driftlab {
namespace {

TEST(Result, NamesEveryCodeOnceInSnakeCase) {
  std::set<std::string_view> names;
  for (const ErrorCode code : all_error_codes()) {
    const std::string_view name = name_of(code);
    EXPECT_TRUE(names.insert(name).second) << name << " names two codes";
    EXPECT_EQ(name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos) << name;
  }
  EXPECT_EQ(name_of(all_error_codes().back()), "internal");
  EXPECT_EQ(name_of(ErrorCode::NonMonotonicTime), "non_monotonic_time");
}

TEST(Result, CarriesTheErrorWithItsFields) {
  Error error{ErrorCode::RaggedRow, "Line 3 has 2 values.", {}};
  error.fields.push_back({"row", "3"});
  const Result<int> result = fail(std::move(error).with("file", "a"));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::RaggedRow);
  ASSERT_EQ(result.error().fields.size(), 2U);
  EXPECT_EQ(result.error().fields[1], (ErrorField{"file", "a"}));
}

}  // namespace
}  // namespace driftlab
