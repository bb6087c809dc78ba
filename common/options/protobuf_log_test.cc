#include "common/options/protobuf_log.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace isotherm {
namespace {

TEST(ProtobufLogTest, F64AThousandFieldsThatAreNoTextWriteOneLine) {
  LimitProtobufLog();
  google::protobuf::Value value;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 1000; ++i)
    value.ParseFromString("\x1a\x01\xff");  // A text of one byte: none.
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(log, '\n'), 1) << log.substr(0, 400);
  EXPECT_THAT(log, ::testing::HasSubstr("Protobuf: String field"));
}

}  // namespace
}  // namespace isotherm
