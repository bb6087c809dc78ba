#include "common/base/status.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

TEST(StatusTest, DefaultIsOkAndExitsWithZero) {
  EXPECT_TRUE(Status().ok());
  EXPECT_EQ(ExitCode(Status()), 0);
}

TEST(StatusTest, ContextGoesInFrontAndKeepsTheCode) {
  const Status status = NotFound("no such file").WithContext("depth.txt");
  EXPECT_EQ(status.message(), "depth.txt: no such file");
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_TRUE(OkStatus().WithContext("depth.txt").message().empty());
}

TEST(StatusTest, EachFailureHasANonZeroExitStatus) {
  for (const Status& status :
       {InvalidArgument(""), NotFound(""), DataLoss(""), FailedPrecondition(""),
        ResourceExhausted(""), Unavailable(""), IoError(""), Internal("")}) {
    EXPECT_GE(ExitCode(status), 64) << ToString(status.code());
  }
}

}  // namespace
}  // namespace isotherm
