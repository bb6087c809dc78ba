#include "edge/daemon/replace_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

std::string ReadAll(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::span<const std::uint8_t> Bytes(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

TEST(ReplaceFileTest, TheNewestReplacesTheOneBefore) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png";
  ASSERT_TRUE(ReplaceFile(path, Bytes("first image")).ok());
  ASSERT_TRUE(ReplaceFile(path, Bytes("second")).ok());
  EXPECT_EQ(ReadAll(path), "second");
  EXPECT_FALSE(std::filesystem::exists(path.string() + ".partial"));
}

TEST(ReplaceFileTest, F65ALinkInItsPlaceIsNotFollowed) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png", victim = folder.path() / "victim";
  std::ofstream(victim) << "precious";
  std::filesystem::create_symlink(victim, path.string() + ".partial");
  EXPECT_FALSE(ReplaceFile(path, Bytes("image")).ok());
  EXPECT_EQ(ReadAll(victim), "precious");
  std::filesystem::remove(path.string() + ".partial");
  std::filesystem::create_symlink(victim, path);
  EXPECT_TRUE(ReplaceFile(path, Bytes("image")).ok()) << "the link itself is replaced";
  EXPECT_EQ(ReadAll(victim), "precious");
  EXPECT_EQ(ReadAll(path), "image");
}

TEST(ReplaceFileTest, WhatCannotBeWrittenLeavesTheOldOneAndIsSaid) {
  const testing::TemporaryDirectory folder;
  const auto path = folder.path() / "confidence.png";
  ASSERT_TRUE(ReplaceFile(path, Bytes("first")).ok());
  std::filesystem::create_directory(path.string() + ".partial");  // In the way.
  EXPECT_FALSE(ReplaceFile(path, Bytes("second")).ok());
  EXPECT_EQ(ReadAll(path), "first");
  const Status status = ReplaceFile(folder.path() / "no" / "folder.png", Bytes("x"));
  EXPECT_THAT(status.message(), HasSubstr("folder.png"));
}

}  // namespace
}  // namespace isotherm
