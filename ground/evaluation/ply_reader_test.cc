#include "ground/evaluation/ply_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "common/testing/temporary_directory.h"
#include "ground/evaluation/point_sets.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

std::string Bytes(const auto& value, bool swap) {
  std::string bytes(sizeof(value), '\0');
  std::memcpy(bytes.data(), &value, sizeof(value));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

// Two vertices (x, seen, temperature) and a face list that is of no interest.
std::string Binary(bool big_endian) {
  std::string ply =
      std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
      "_endian 1.0\ncomment x\nelement vertex 2\nproperty float x\nproperty ushort seen\n"
      "property double scalar_temperature\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  ply += Bytes(1.5F, big_endian) + Bytes(std::uint16_t{515}, big_endian) + Bytes(20.25, big_endian);
  ply += Bytes(-2.0F, big_endian) + Bytes(std::uint16_t{0}, big_endian) +
         Bytes(std::nan(""), big_endian);
  return ply + std::string(13, '\1');
}

void ExpectContent(const Result<PlyVertices>& vertices) {
  ASSERT_TRUE(vertices) << vertices.error().message();
  ASSERT_EQ(vertices->count, 2U);
  EXPECT_THAT(*vertices->Find("x"), ::testing::ElementsAre(1.5F, -2.0F));
  EXPECT_THAT(*vertices->Find("seen"), ::testing::ElementsAre(515.0F, 0.0F));
  EXPECT_EQ(vertices->Find("scalar_temperature")->at(0), 20.25F);
  EXPECT_TRUE(std::isnan(vertices->Find("scalar_temperature")->at(1)));
  EXPECT_EQ(vertices->Find("y"), nullptr);
}

TEST(PlyReaderTest, ReadsEveryFormat) {
  ExpectContent(ParsePly(Binary(false)));
  ExpectContent(ParsePly(Binary(true)));
  ExpectContent(ParsePly(
      "ply\r\nformat ascii 1.0\r\nelement vertex 2\r\nproperty float x\r\nproperty ushort seen\r\n"
      "property float scalar_temperature\r\nend_header\r\n1.5 515 20.25\r\n-2 0 nan\r\n"));
}

TEST(PlyReaderTest, ScalarFieldsAreFoundByTheirOldAndNewNames) {
  const auto with = [](const std::string& name) {
    return ParsePly("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty uchar " +
                    name + "\nend_header\n1 2\n");
  };
  for (const char* written : {"angle_class", "scalar_angle_class"}) {
    const auto vertices = with(written);
    ASSERT_TRUE(vertices) << vertices.error().message();
    for (const char* asked : {"angle_class", "scalar_angle_class"}) {
      ASSERT_NE(vertices->Find(asked), nullptr) << written << " as " << asked;
      EXPECT_EQ(vertices->Find(asked)->at(0), 2.0F);
    }
    EXPECT_EQ(vertices->Find("distance_class"), nullptr);
  }
}

TEST(PlyReaderTest, EveryTruncationIsAnError) {
  const std::string whole = Binary(false);
  const std::size_t faces = 13;
  for (std::size_t length = 0; length < whole.size() - faces; ++length) {
    EXPECT_FALSE(ParsePly(whole.substr(0, length))) << length;
  }
}

TEST(PlyReaderTest, AbsurdOrUnknownHeadersAreRefused) {
  const auto error = [](const std::string& text) { return ParsePly(text).error().message(); };
  EXPECT_THAT(error("hello\n"), HasSubstr("not a PLY file"));
  EXPECT_THAT(error("ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\n"
                    "property float x\nend_header\nabcd"),
              HasSubstr("truncated"));
  EXPECT_THAT(error("ply\nformat zip 1.0\nend_header\n"), HasSubstr("'zip'"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement face 1\n"), HasSubstr("must be 'vertex'"));
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n"),
      HasSubstr("'list' is not supported"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\nabc\n"),
              HasSubstr("'abc' is not a number"));
  EXPECT_EQ(ReadPly("/nonexistent.ply").error().code(), StatusCode::kNotFound);
}

TEST(PlyReaderTest, APipeIsRefusedAtOnceAndNamed) {
  const testing::TemporaryDirectory folder;
  const std::string pipe = folder.path() / "cloud.ply";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const Result<PlyVertices> read = ReadPly(pipe);
  ASSERT_FALSE(read.has_value());
  EXPECT_THAT(read.error().message(), HasSubstr(pipe + ": is a pipe or a device"));
}

TEST(PlyReaderTest, AFileThatIsTooLargeIsRefusedBeforeItIsRead) {
  const testing::TemporaryDirectory folder;
  const std::filesystem::path large = folder.path() / "cloud.ply";
  std::ofstream(large) << "ply\n";
  std::filesystem::resize_file(large, kMaxPlyBytes + 1);  // Takes no room on the disk.
  const Result<PlyVertices> read = ReadPly(large);
  ASSERT_FALSE(read.has_value());
  EXPECT_THAT(read.error().message(), HasSubstr("more than are read (4000000000 at most)"));
}

}  // namespace
}  // namespace isotherm
