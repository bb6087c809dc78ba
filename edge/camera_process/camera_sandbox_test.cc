// A hostile library can do little in a camera's process: a real process tries, and says in its
// frames what came of it.

#include "edge/camera_process/camera_sandbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <fstream>

#include "common/testing/temporary_directory.h"
#include "edge/camera_process/camera_process.h"
#include "edge/camera_process/testing/sandbox_probe.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr std::chrono::seconds kPatience{20};

class CameraSandboxTest : public ::testing::Test {
 protected:
  CameraSandboxTest() {
    for (const char* name : {"allowed", "foreign"}) std::ofstream(folder_.path() / name) << "text";
  }

  /// Runs the process, and keeps what its second frame says.
  void Run(const std::string& what) {
    CameraProcess::Settings settings;
    settings.name = "fake camera";
    settings.program = FAKE_CAMERA_PROCESS;
    settings.arguments = {what, "0", folder_.path().string()};
    CameraProcess camera(settings, clock_);
    const Status opened = camera.Open();
    ASSERT_TRUE(opened.ok()) << opened.message();
    settings_ = camera.cameras().at(0).settings;
    const SteadyTime end = clock_.SteadyNow() + kPatience;
    for (int frames = 0; frames < 2 && clock_.SteadyNow() < end;) {
      const Result<SourceItem> item = camera.Read({});
      ASSERT_TRUE(item.has_value()) << item.error().message();
      const auto* frame = std::get_if<RawFrame>(&*item);
      if (frame == nullptr) continue;
      ++frames;
      ASSERT_GE(frame->pixels.size(), results_.size());
      std::copy_n(frame->pixels.data(), results_.size(), results_.begin());
    }
  }
  int ErrorOf(SandboxAttempt attempt) const { return results_[static_cast<std::size_t>(attempt)]; }
  void ExpectNoNetwork() const {
    EXPECT_EQ(ErrorOf(SandboxAttempt::kInternetSocket), EACCES);
    EXPECT_EQ(ErrorOf(SandboxAttempt::kInternetDatagrams), EACCES);
    EXPECT_EQ(ErrorOf(SandboxAttempt::kRouteSocket), EACCES);
    EXPECT_EQ(ErrorOf(SandboxAttempt::kDeviceSocket), 0) << "cameras are plugged in and out";
    EXPECT_EQ(ErrorOf(SandboxAttempt::kIoRing), EPERM);
    EXPECT_EQ(ErrorOf(SandboxAttempt::kStartProgram), EPERM);
    EXPECT_EQ(ErrorOf(SandboxAttempt::kSignalParent), EPERM);
  }

  const testing::TemporaryDirectory folder_;
  const SystemClock clock_{};
  std::string settings_;
  SandboxResults results_{};
};

TEST_F(CameraSandboxTest, WithoutItTheProcessMayDoAll) {
  ASSERT_NO_FATAL_FAILURE(Run("free"));
  for (const SandboxAttempt attempt :
       {SandboxAttempt::kInternetSocket, SandboxAttempt::kLocalSocket,
        SandboxAttempt::kDeviceSocket, SandboxAttempt::kReadForeign, SandboxAttempt::kWriteForeign,
        SandboxAttempt::kCreateFile, SandboxAttempt::kReadAllowed, SandboxAttempt::kWriteAllowed,
        SandboxAttempt::kReadParent, SandboxAttempt::kSignalParent}) {
    EXPECT_EQ(ErrorOf(attempt), 0) << static_cast<int>(attempt);
  }
  EXPECT_EQ(ErrorOf(SandboxAttempt::kStartProgram), ENOENT);
  EXPECT_EQ(settings_, "all on");
}

TEST_F(CameraSandboxTest, ConfinedItHasItsFilesAndNothingElseAndFramesCome) {
  ASSERT_NO_FATAL_FAILURE(Run("go-on"));
  ExpectNoNetwork();
  EXPECT_EQ(ErrorOf(SandboxAttempt::kLocalSocket), EACCES);
  if (settings_ != "all on, confined") GTEST_SKIP() << "this kernel has no Landlock";
  EXPECT_EQ(ErrorOf(SandboxAttempt::kReadForeign), EACCES);
  EXPECT_EQ(ErrorOf(SandboxAttempt::kWriteForeign), EACCES);
  EXPECT_EQ(ErrorOf(SandboxAttempt::kCreateFile), EACCES);
  EXPECT_EQ(ErrorOf(SandboxAttempt::kReadAllowed), 0);
  EXPECT_EQ(ErrorOf(SandboxAttempt::kWriteAllowed), EACCES) << "it may be read only";
  EXPECT_EQ(ErrorOf(SandboxAttempt::kReadParent), EACCES);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "new"));
}

TEST_F(CameraSandboxTest, LocalSocketsAreThereForLibrariesThatNeedThem) {
  ASSERT_NO_FATAL_FAILURE(Run("local"));
  EXPECT_EQ(ErrorOf(SandboxAttempt::kLocalSocket), 0);
  ExpectNoNetwork();
}

TEST_F(CameraSandboxTest, WhereAServiceForbidsLandlockFramesComeAndItIsSaid) {
  ::testing::internal::CaptureStderr();
  Run("unit-filter");
  const std::string said = ::testing::internal::GetCapturedStderr();
  ASSERT_FALSE(HasFatalFailure()) << said;
  EXPECT_EQ(settings_, "all on, not confined");
  EXPECT_THAT(said, HasSubstr("allow landlock_create_ruleset"));
  ExpectNoNetwork();
  EXPECT_EQ(ErrorOf(SandboxAttempt::kReadForeign), 0) << "that is what it says";
}

}  // namespace
}  // namespace isotherm
