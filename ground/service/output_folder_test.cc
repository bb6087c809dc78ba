#include "ground/service/output_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::internal::CaptureStderr;
using ::testing::internal::GetCapturedStderr;

class OutputFolderTest : public ::testing::Test {
 protected:
  /// Looks five times a second, for as long as that.
  void TendFor(Nanoseconds duration) {
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += 200ms) folder_.Tend(now_);
  }

  Status answer_ = IoError("there is no such disk");
  int tries_ = 0;
  SteadyTime now_{1h};
  OutputFolder folder_{"/media/disk", [this](const std::filesystem::path&) {
                         ++tries_;
                         return answer_;
                       }};
};

TEST_F(OutputFolderTest, F31AMissingDiskIsSaidOnceAndLookedForWithGrowingPauses) {
  CaptureStderr();
  TendFor(60s);
  const std::string log = GetCapturedStderr();
  EXPECT_EQ(std::ranges::count(log, '\n'), 1) << log;
  EXPECT_THAT(folder_.problem().value_or(""), HasSubstr("there is no such disk"));
  // After 0.5, 1.5, 3.5 and 7.5 s, then each 5 s.
  EXPECT_GE(tries_, 12);
  EXPECT_LE(tries_, 15);
}

TEST_F(OutputFolderTest, F31ADiskThatComesIsUsedAndSaid) {
  TendFor(20s);
  answer_ = OkStatus();
  CaptureStderr();
  TendFor(6s);
  EXPECT_THAT(GetCapturedStderr(), HasSubstr("can be used, folder=/media/disk"));
  EXPECT_EQ(folder_.problem(), std::nullopt);
}

TEST_F(OutputFolderTest, AFolderThatIsThereIsLookedAtOnce) {
  answer_ = OkStatus();
  CaptureStderr();
  TendFor(20s);
  EXPECT_EQ(GetCapturedStderr(), "");
  EXPECT_EQ(tries_, 1);
}

}  // namespace
}  // namespace isotherm
