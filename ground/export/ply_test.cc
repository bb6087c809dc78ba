#include "ground/export/ply.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

/// A PLY reader that knows nothing of the writer: any scalar properties, one list per face.
struct PlyFile {
  std::vector<std::string> names;
  std::vector<std::string> comments;
  std::vector<std::map<std::string, double>> vertices;
  std::vector<std::vector<int>> faces;
  std::size_t bytes_left = 0;
};

template <typename T>
T Take(const std::string& bytes, std::size_t& at) {
  T value{};
  EXPECT_LE(at + sizeof(T), bytes.size());
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  at += sizeof(T);
  return value;
}

PlyFile ReadPly(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
  const std::string mark = "end_header\n";
  std::size_t at = bytes.find(mark) + mark.size();
  std::istringstream header(bytes.substr(0, at));
  PlyFile ply;
  std::vector<std::string> types;
  std::size_t vertices = 0, faces = 0;
  for (std::string line; std::getline(header, line);) {
    std::istringstream words(line);
    std::string first, second, third;
    words >> first >> second >> third;
    if (first == "format") {
      EXPECT_EQ(line, "format binary_little_endian 1.0");
    }
    if (first == "comment") ply.comments.push_back(line);
    if (first == "element" && second == "vertex") vertices = std::stoul(third);
    if (first == "element" && second == "face") faces = std::stoul(third);
    if (first == "property" && second != "list") {
      types.push_back(second);
      ply.names.push_back(third);
    }
    if (first == "property" && second == "list") {
      EXPECT_EQ(line, "property list uchar int vertex_indices");
    }
  }
  for (std::size_t i = 0; i < vertices; ++i) {
    auto& vertex = ply.vertices.emplace_back();
    for (std::size_t k = 0; k < types.size(); ++k) {
      vertex[ply.names[k]] = types[k] == "float"
                                 ? static_cast<double>(Take<float>(bytes, at))
                                 : static_cast<double>(Take<std::uint8_t>(bytes, at));
    }
  }
  for (std::size_t i = 0; i < faces; ++i) {
    auto& face = ply.faces.emplace_back(Take<std::uint8_t>(bytes, at));
    for (int& index : face) index = Take<std::int32_t>(bytes, at);
  }
  ply.bytes_left = bytes.size() - at;
  return ply;
}

Surface FourPoints() {
  Surface surface;
  surface.points = {
      {{1.5F, -2.25F, 0.125F}, {0, 0, 1}, 60.0F, 1, 2},
      {{0, 0, 0}, {1, 0, 0}, 20.0F, 2, 0},
      {{7, 8, 9}, {0, 1, 0}, 100.0F, 0, 1},
      {{3, 3, 3}, {0, -1, 0}, NAN, kNeverMeasured, kNeverMeasured},
  };
  surface.triangles = {{0, 1, 3}};
  return surface;
}

class PlyTest : public ::testing::Test {
 protected:
  PlyStyle Style() const {
    return {.colours = colours_,
            .scale = TemperatureScale{.min_celsius = 20.0, .max_celsius = 100.0},
            .palette_name = "coolwarm",
            .software = "Isotherm test"};
  }
  testing::TemporaryDirectory folder_;
  const ColourTable colours_{RendererOptions()};
  const std::filesystem::path path_ = folder_.path() / "out.ply";
};

TEST_F(PlyTest, PropertiesAreThoseOfTheContractInItsOrder) {
  ASSERT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
  const std::vector<std::string> expected = {"x",
                                             "y",
                                             "z",
                                             "nx",
                                             "ny",
                                             "nz",
                                             "red",
                                             "green",
                                             "blue",
                                             "scalar_temperature",
                                             "scalar_distance_class",
                                             "scalar_angle_class",
                                             "quality",
                                             "scalar_motion_class",
                                             "scalar_disagreement_class",
                                             "scalar_nuc_epoch",
                                             "scalar_nuc_age_s",
                                             "scalar_measured_distance",
                                             "scalar_measured_angle",
                                             "scalar_temperature_sigma"};
  EXPECT_EQ(ReadPly(path_).names, expected);
}

TEST_F(PlyTest, ValuesReadBack) {
  ASSERT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
  PlyFile ply = ReadPly(path_);
  ASSERT_EQ(ply.vertices.size(), 4U);
  EXPECT_EQ(ply.bytes_left, 0U);
  EXPECT_EQ(ply.vertices[0]["x"], 1.5);
  EXPECT_EQ(ply.vertices[0]["y"], -2.25);
  EXPECT_EQ(ply.vertices[0]["z"], 0.125);
  EXPECT_EQ(ply.vertices[0]["nz"], 1.0);
  EXPECT_EQ(ply.vertices[0]["scalar_temperature"], 60.0);
  EXPECT_EQ(ply.vertices[0]["quality"], 60.0);
  EXPECT_EQ(ply.vertices[0]["scalar_distance_class"], 1.0);
  EXPECT_EQ(ply.vertices[0]["scalar_angle_class"], 2.0);
  EXPECT_EQ(ply.vertices[0]["red"], 221.0);
  EXPECT_EQ(ply.vertices[1]["blue"], 192.0);
  EXPECT_EQ(ply.vertices[2]["red"], 180.0);
}

TEST_F(PlyTest, NeverMeasuredIsNanAnd255AndGrey) {
  ASSERT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
  auto vertex = ReadPly(path_).vertices[3];
  EXPECT_TRUE(std::isnan(vertex["scalar_temperature"]));
  EXPECT_EQ(vertex["scalar_distance_class"], 255.0);
  EXPECT_EQ(vertex["scalar_angle_class"], 255.0);
  EXPECT_EQ(vertex["red"], 96.0);
}

// MeshLab aborts when it colours a mesh by a quality that is NaN.
TEST_F(PlyTest, QualityIsAlwaysANumberAndNeverMeasuredIsAbsoluteZero) {
  ASSERT_TRUE(WriteMeshPly(FourPoints(), Style(), path_).ok());
  for (auto& vertex : ReadPly(path_).vertices) {
    const bool measured = !std::isnan(vertex["scalar_temperature"]);
    EXPECT_NEAR(vertex["quality"], measured ? vertex["scalar_temperature"] : -273.15, 1e-4);
  }
}

// CloudCompare loads properties with this prefix without being asked.
TEST_F(PlyTest, EveryScalarFieldHasThePrefixOfCloudCompare) {
  PlyStyle style = Style();
  style.interpreted = true;
  ASSERT_TRUE(WriteCloudPly(FourPoints(), style, path_).ok());
  const std::vector<std::string> names = ReadPly(path_).names;
  ASSERT_EQ(names.size(), 21U);
  for (std::size_t i = 9; i < names.size(); ++i) {
    EXPECT_TRUE(names[i] == "quality" || names[i].starts_with("scalar_")) << names[i];
  }
}

TEST_F(PlyTest, MeshHasOnlyThePointsOfItsTriangles) {
  ASSERT_TRUE(WriteMeshPly(FourPoints(), Style(), path_).ok());
  PlyFile ply = ReadPly(path_);
  ASSERT_EQ(ply.vertices.size(), 3U);
  EXPECT_EQ(ply.faces, (std::vector<std::vector<int>>{{0, 1, 2}}));
  EXPECT_TRUE(std::isnan(ply.vertices[2]["scalar_temperature"]));
  EXPECT_EQ(ply.bytes_left, 0U);
}

TEST_F(PlyTest, HeaderSaysWhatTheNumbersMean) {
  ASSERT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
  std::string comments;
  for (const std::string& comment : ReadPly(path_).comments) comments += comment + "\n";
  for (const char* word : {"Isotherm test", "world", "metres", "degrees Celsius", "emissivity 1",
                           "coolwarm from 20.000 to 100.000", "255 never measured",
                           "180 degrees about x", "-273.15 = never measured"}) {
    EXPECT_NE(comments.find(word), std::string::npos) << word;
  }
}

TEST_F(PlyTest, EmptySurfaceIsAValidFile) {
  PlyStyle style = Style();
  style.scale.reset();
  ASSERT_TRUE(WriteMeshPly(Surface(), style, path_).ok());
  EXPECT_TRUE(ReadPly(path_).vertices.empty());
  EXPECT_EQ(ReadPly(path_).bytes_left, 0U);
}

TEST_F(PlyTest, LargeCloudsAreWrittenInChunksWithoutLoss) {
  Surface surface;
  surface.points.resize(100000);  // 3.7 MB.
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    surface.points[i].position_m = Eigen::Vector3f::Constant(static_cast<float>(i));
    surface.points[i].normal = Eigen::Vector3f::UnitX();
  }
  ASSERT_TRUE(WriteCloudPly(surface, Style(), path_).ok());
  PlyFile ply = ReadPly(path_);
  EXPECT_EQ(ply.bytes_left, 0U);
  for (std::size_t i = 0; i < ply.vertices.size(); i += 997) {
    ASSERT_EQ(ply.vertices[i]["y"], static_cast<double>(i));
  }
}

TEST_F(PlyTest, F41DiskFullNamesTheFileAndKeepsTheOlderOne) {
  ASSERT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
  Surface large;
  large.points.resize(100000);
  // A limit on the size of files fails a write half way, as a full disk does.
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 1U << 20;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &limit), 0);
  const Status status = WriteCloudPly(large, Style(), path_);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(status.code(), StatusCode::kResourceExhausted);
  EXPECT_NE(status.message().find(path_.string()), std::string::npos) << status.message();
  EXPECT_EQ(ReadPly(path_).vertices.size(), 4U);
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".partial"));
}

TEST_F(PlyTest, F65ALinkInThePlaceOfThePartialFileIsNotFollowed) {
  const std::filesystem::path victim = folder_.path() / "victim";
  std::ofstream(victim) << "precious";
  const std::filesystem::path partial = path_.string() + ".partial";
  std::filesystem::create_symlink(victim, partial);
  const Status status = WriteCloudPly(FourPoints(), Style(), path_);
  EXPECT_NE(status.message().find("remove"), std::string::npos) << status.message();
  EXPECT_EQ(std::filesystem::file_size(victim), 8U);
  std::filesystem::remove(partial);
  std::ofstream(partial) << "of a run that was interrupted";
  EXPECT_TRUE(WriteCloudPly(FourPoints(), Style(), path_).ok());
}

TEST_F(PlyTest, MissingFolderIsOneClearSentence) {
  const auto path = folder_.path() / "missing" / "out.ply";
  const Status status = WriteCloudPly(FourPoints(), Style(), path);
  EXPECT_EQ(status.code(), StatusCode::kIoError);
  EXPECT_NE(status.message().find(path.string()), std::string::npos);
  EXPECT_NE(status.message().find("choose a folder"), std::string::npos);
}

}  // namespace
}  // namespace isotherm
