#include "common/base/read_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kMaxBytes = 1000;

using ::testing::AllOf;
using ::testing::HasSubstr;

class ReadFileTest : public ::testing::Test {
 protected:
  std::filesystem::path Write(const std::string& content) const {
    std::ofstream(path_, std::ios::binary) << content;
    return path_;
  }
  void ExpectRefused(const std::filesystem::path& path, StatusCode code, const char* why) const {
    const Result<std::string> read = ReadFile(path, kMaxBytes);
    ASSERT_FALSE(read.has_value());
    EXPECT_EQ(read.error().code(), code);
    EXPECT_THAT(read.error().message(), AllOf(HasSubstr(path.string()), HasSubstr(why)));
  }

  testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "file";
};

TEST_F(ReadFileTest, ReturnsEveryByte) {
  const std::string content("a\0b\r\n\xff", 6);
  EXPECT_EQ(ReadFile(Write(content), kMaxBytes).value(), content);
  EXPECT_EQ(ReadFile(Write(""), kMaxBytes).value(), "");
}

TEST_F(ReadFileTest, FollowsALinkToAFile) {
  std::filesystem::create_symlink(Write("content"), folder_.path() / "link");
  EXPECT_EQ(ReadFile(folder_.path() / "link", kMaxBytes).value(), "content");
}

TEST_F(ReadFileTest, APipeThatNobodyWritesToIsRefusedAtOnce) {
  ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
  ExpectRefused(path_, StatusCode::kInvalidArgument, "is a pipe or a device");
}

TEST_F(ReadFileTest, ADeviceThatNeverEndsIsRefused) {
  ExpectRefused("/dev/zero", StatusCode::kInvalidArgument, "is a pipe or a device");
}

TEST_F(ReadFileTest, AFolderIsRefused) {
  ExpectRefused(folder_.path(), StatusCode::kInvalidArgument, "is a folder");
}

TEST_F(ReadFileTest, AMissingFileIsNotFound) {
  ExpectRefused(folder_.path() / "nowhere", StatusCode::kNotFound, "No such file");
}

TEST_F(ReadFileTest, ALargerFileThanAskedForIsRefused) {
  Write("12345");
  EXPECT_TRUE(ReadFile(path_, 5).has_value());
  const Status refused = ReadFile(path_, 4).error();
  EXPECT_EQ(refused.code(), StatusCode::kDataLoss);
  EXPECT_EQ(refused.message(), path_.string() + ": has 5 bytes, more than are read (4 at most)");
}

}  // namespace
}  // namespace isotherm
