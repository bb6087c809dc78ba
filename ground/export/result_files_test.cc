#include "ground/export/result_files.h"

#include <gtest/gtest.h>

#include <clocale>
#include <fstream>
#include <iterator>
#include <limits>
#include <locale>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/testing/temporary_directory.h"
#include "common/testing/volume_shapes.h"
#include "ground/export/trajectory_text.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

std::string ReadAll(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class ResultsTest : public ::testing::Test {
 protected:
  ResultsTest() : tsdf_(Grid(), 0.016, 64), thermal_(64) {
    testing::FillPlane(tsdf_, {0, 0, 0.06}, -Eigen::Vector3d::UnitZ());
    testing::FillThermal(tsdf_, thermal_, [](const Eigen::Vector3d& p) {
      return ThermalVoxel::Make(static_cast<float>(20.0 + 500.0 * p.x()), ConditionClass::kGood,
                                ConditionClass::kGood);
    });
    poses_.push_back({CaptureTimeFromNanoseconds(1'700'000'000'123'456'789),
                      MakeTransform({0.1, -0.2, 0.3}, Eigen::Quaterniond(0, 0, 0, -1))});
    FillView();
  }

  static VoxelGrid Grid() {
    VoxelGrid grid;
    grid.voxel_size_m = 0.004;
    grid.blocks = {4, 4, 4};
    return grid;
  }

  void FillView() {
    view_.Resize(32, 24);
    for (int y = 0; y < 24; ++y) {
      for (int x = 0; x < 32; ++x) {
        view_.vx.At(x, y) = 0.004F * static_cast<float>(x);
        view_.vy.At(x, y) = 0.004F * static_cast<float>(y);
        view_.vz.At(x, y) = 0.06F;
        view_.nx.At(x, y) = view_.ny.At(x, y) = 0.0F;
        view_.nz.At(x, y) = -1.0F;
      }
    }
  }

  ResultInputs Inputs() const {
    return ResultInputs{.tsdf = tsdf_,
                        .thermal = thermal_,
                        .trajectory = poses_,
                        .view = &view_,
                        .p_map_viewer = {0.06, 0.05, -0.5},
                        .renderer_options = renderer_,
                        .thermal_options = thermal_options_,
                        .export_options = export_,
                        .stats = stats_};
  }

  Result<ResultSummary> Write(const fs::path& dir, int threads = 2) const {
    ThreadPool pool(threads);
    return WriteResults(Inputs(), dir, pool);
  }

  TsdfVolume tsdf_;
  ThermalVolume thermal_;
  std::vector<StampedPose> poses_;
  SurfaceMaps view_;
  RendererOptions renderer_;
  ThermalOptions thermal_options_;
  ExportOptions export_;
  const Json stats_ = {{"frames", {{"depth", 3}}}};
  const testing::TemporaryDirectory folder_;
};

constexpr const char* kFiles[] = {"cloud.ply",
                                  "mesh.ply",
                                  "trajectory.txt",
                                  "stats.json",
                                  "renders/angle.png",
                                  "renders/distance.png",
                                  "renders/thermal.png",
                                  "renders/geometry.png",
                                  "renders/coverage.png",
                                  "renders/motion.png",
                                  "renders/disagreement.png",
                                  "renders/age.png",
                                  "renders/uncertainty.png"};

TEST_F(ResultsTest, WritesEveryFileOfTheContract) {
  const fs::path dir = folder_.path() / "a" / "b";
  ASSERT_TRUE(PrepareOutputDir(dir).ok());
  const Result<ResultSummary> summary = Write(dir);
  ASSERT_TRUE(summary) << summary.error().message();
  for (const char* name : kFiles) EXPECT_GT(fs::file_size(dir / name), 50U) << name;
  EXPECT_EQ(summary->points, 32U * 32U);
  EXPECT_EQ(summary->triangles, 2U * 31U * 31U);
  EXPECT_EQ(summary->measured_points, summary->points);
  EXPECT_EQ(summary->good_points, summary->points);
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(dir)) files += entry.is_regular_file();
  EXPECT_EQ(files, 13);  // Nothing partial is left.
}

TEST_F(ResultsTest, SameInputsGiveTheSameBytesWhateverTheThreads) {
  for (const int threads : {1, 4}) {
    const fs::path dir = folder_.path() / std::to_string(threads);
    ASSERT_TRUE(PrepareOutputDir(dir).ok());
    ASSERT_TRUE(Write(dir, threads));
  }
  for (const char* name : kFiles) {
    EXPECT_EQ(ReadAll(folder_.path() / "1" / name), ReadAll(folder_.path() / "4" / name)) << name;
  }
}

TEST_F(ResultsTest, OptionsLeaveFilesOut) {
  export_.mutable_expert()->set_mesh(false);
  export_.mutable_expert()->set_cloud(false);
  export_.mutable_expert()->set_renders(false);
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  ASSERT_TRUE(Write(folder_.path()));
  EXPECT_FALSE(fs::exists(folder_.path() / "mesh.ply"));
  EXPECT_FALSE(fs::exists(folder_.path() / "cloud.ply"));
  EXPECT_FALSE(fs::exists(folder_.path() / "renders"));
  EXPECT_TRUE(fs::exists(folder_.path() / "trajectory.txt"));
}

TEST_F(ResultsTest, WhatAnEarlierScanLeftIsFoundAndRemovedAndNothingElse) {
  const fs::path dir = folder_.path() / "out";
  EXPECT_FALSE(HoldsResults(dir));
  ASSERT_TRUE(PrepareOutputDir(dir).ok());
  EXPECT_FALSE(HoldsResults(dir));
  const auto put = [&](const char* name) { std::ofstream(dir / name) << "x"; };
  put("scan.mcap");
  put("my_model.iso");
  EXPECT_FALSE(HoldsResults(dir)) << "not ours";
  fs::create_directory(dir / "renders");
  put("renders/own.png");
  for (const char* name : {"model.iso", "model-2.iso", "mesh.ply", "renders/age.png"}) put(name);
  EXPECT_TRUE(HoldsResults(dir));
  RemoveOtherResults(dir, {"model.iso", "renders/age.png"});
  for (const char* name :
       {"scan.mcap", "my_model.iso", "renders/own.png", "model.iso", "renders/age.png"})
    EXPECT_TRUE(fs::exists(dir / name)) << name;
  EXPECT_FALSE(fs::exists(dir / "model-2.iso"));
  EXPECT_FALSE(fs::exists(dir / "mesh.ply"));
}

TEST_F(ResultsTest, WarningsKnowTheSurfaceAndAreInTheStatistics) {
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  ResultInputs inputs = Inputs();
  inputs.warnings = [](const ResultSummary& summary) {
    return std::vector<std::string>{std::to_string(summary.points) + " points of nothing"};
  };
  ThreadPool pool(2);
  ASSERT_TRUE(WriteResults(inputs, folder_.path(), pool));
  EXPECT_NE(ReadAll(folder_.path() / "stats.json").find("\"1024 points of nothing\""),
            std::string::npos);
}

TEST_F(ResultsTest, OneFileThatFailsDoesNotStopTheOthers) {
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  fs::create_directories(folder_.path() / "stats.json" / "in-the-way");
  const Result<ResultSummary> summary = Write(folder_.path());
  ASSERT_FALSE(summary);
  EXPECT_NE(summary.error().message().find("stats.json"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder_.path() / "mesh.ply"));
  EXPECT_TRUE(fs::exists(folder_.path() / "trajectory.txt"));
}

TEST_F(ResultsTest, StatsKeepTheCallersValuesAndAddTheSurface) {
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  ASSERT_TRUE(Write(folder_.path()));
  const std::string stats = ReadAll(folder_.path() / "stats.json");
  for (const char* text : {"\"depth\": 3", "\"software\": \"Isotherm ", "\"points\": 1024",
                           "\"measured_fraction\": 1"}) {
    EXPECT_NE(stats.find(text), std::string::npos) << text << " in " << stats;
  }
}

TEST_F(ResultsTest, InterpretedResultsKeepWhatWasMeasured) {
  InterpretationOptions options;
  options.set_emissivity(0.5);
  const Interpretation interpretation = Interpretation::Create(options).value();
  ResultInputs inputs = Inputs();
  inputs.interpretation = &interpretation;
  inputs.trajectory.reset();
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  ThreadPool pool(1);
  const Result<ResultSummary> summary = WriteResults(inputs, folder_.path(), pool);
  ASSERT_TRUE(summary) << summary.error().message();
  EXPECT_FALSE(fs::exists(folder_.path() / "trajectory.txt"));
  ASSERT_EQ(summary->interpretation.size(), 1U);
  EXPECT_EQ(summary->interpretation[0].measured, summary->points);
  // The hottest point was 83 °C apparent (20 + 500 x, x up to 0.126 m).
  EXPECT_NEAR(summary->temperatures.max_celsius, interpretation.ObjectCelsius(0, 83.0F), 0.1);
  EXPECT_GT(summary->temperatures.max_celsius, 110.0);
  EXPECT_NE(ReadAll(folder_.path() / "stats.json").find("\"interpretation\""), std::string::npos);
  const std::string cloud = ReadAll(folder_.path() / "cloud.ply");
  EXPECT_NE(cloud.find("property float scalar_apparent_temperature\nend_header"),
            std::string::npos);
  constexpr std::size_t kPointBytes = 6 * 4 + 3 + 4 + 2 + 4 + 3 + 4 * 4 + 4;
  EXPECT_EQ(cloud.size() - cloud.find("end_header\n") - 11, summary->points * kPointBytes);
}

TEST_F(ResultsTest, RenderingsAreInterpretedToo) {
  renderer_.mutable_expert()->set_legend(false);
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  renderer_.set_scale(FIXED);
  ThreadPool pool(1);
  ASSERT_TRUE(Write(folder_.path()));
  const std::string apparent = ReadAll(folder_.path() / "renders/thermal.png");
  const std::string distance = ReadAll(folder_.path() / "renders/distance.png");
  InterpretationOptions options;
  options.set_emissivity(0.5);
  const Interpretation interpretation = Interpretation::Create(options).value();
  ResultInputs inputs = Inputs();
  inputs.interpretation = &interpretation;
  ASSERT_TRUE(WriteResults(inputs, folder_.path(), pool));
  EXPECT_NE(ReadAll(folder_.path() / "renders/thermal.png"), apparent);
  EXPECT_EQ(ReadAll(folder_.path() / "renders/distance.png"), distance);
}

TEST_F(ResultsTest, ProgressRisesToOne) {
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  double last = -1.0;
  ThreadPool pool(1);
  ASSERT_TRUE(WriteResults(Inputs(), folder_.path(), pool, [&](std::string_view, double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  }));
  EXPECT_EQ(last, 1.0);
}

TEST_F(ResultsTest, ExtentWithoutTemperaturesIsStillExported) {
  const ThermalVolume unmeasured(64);
  ResultInputs inputs{.tsdf = tsdf_,
                      .thermal = unmeasured,
                      .trajectory = {},
                      .view = &view_,
                      .renderer_options = renderer_,
                      .thermal_options = thermal_options_,
                      .export_options = export_,
                      .stats = {}};
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  ThreadPool pool(1);
  const Result<ResultSummary> summary = WriteResults(inputs, folder_.path(), pool);
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->measured_points, 0U);
  EXPECT_FALSE(summary->scale);
}

TEST_F(ResultsTest, UnwritableOutputFolderIsRefusedBeforeTheScan) {
  const fs::path file = folder_.path() / "file";
  std::ofstream(file) << "in the way";
  for (const fs::path& dir : {file, file / "below", fs::path("/proc/isotherm-cannot-be-here")}) {
    const Status status = PrepareOutputDir(dir);
    EXPECT_EQ(status.code(), StatusCode::kIoError);
    EXPECT_NE(status.message().find(dir.string()), std::string::npos) << status.message();
  }
  EXPECT_EQ(ReadAll(file), "in the way");
}

TEST_F(ResultsTest, PreparingTwiceKeepsOlderResults) {
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  std::ofstream(folder_.path() / "cloud.ply") << "older";
  ASSERT_TRUE(PrepareOutputDir(folder_.path()).ok());
  EXPECT_EQ(ReadAll(folder_.path() / "cloud.ply"), "older");
}

TEST(ExportOptionsTest, LeastWeightMustBeAPossibleWeight) {
  ExportOptions options;
  EXPECT_TRUE(Validate(options).ok());
  options.mutable_expert()->set_min_weight(1000.0);
  EXPECT_TRUE(Validate(options).ok());
  for (const double wrong : {0.0, -1.0, 1000.5, std::numeric_limits<double>::quiet_NaN()}) {
    options.mutable_expert()->set_min_weight(wrong);
    EXPECT_EQ(Validate(options).code(), StatusCode::kInvalidArgument) << wrong;
  }
}

/// Decimal commas and grouped digits, in C++ streams and, if the system has such a locale, in C as
/// well.
class LocaleWithComma {
 public:
  LocaleWithComma() : before_(std::locale::global(std::locale(std::locale(), new Punctuation))) {
    std::setlocale(LC_ALL, "de_DE.UTF-8");
  }
  ~LocaleWithComma() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }
  LocaleWithComma(const LocaleWithComma&) = delete;
  LocaleWithComma& operator=(const LocaleWithComma&) = delete;

 private:
  struct Punctuation : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  std::locale before_;
};

TEST(TrajectoryTest, F70LineIsExactAndIndependentOfTheLocale) {
  const StampedPose pose{
      CaptureTimeFromNanoseconds(1'700'000'000'000'000'007),
      MakeTransform({1234.5, -0.25, 1e-9}, Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5))};
  const std::string expected =
      "1700000000.000000007 1234.500000000 -0.250000000 0.000000001 -0.500000000 0.500000000 "
      "-0.500000000 0.500000000";
  EXPECT_EQ(TumLine(pose), expected);
  const LocaleWithComma locale;
  EXPECT_EQ(TumLine(pose), expected);
  EXPECT_EQ(JsonText(0.5), "0.5\n");
}

TEST(JsonTest, KeepsOrderAndEscapes) {
  Json json;
  json["b"] = 1;
  json["a"]["nested"] = "tab\there \"quoted\" \\ caf\u00e9";
  json["list"].push_back(0.1);
  json["list"].push_back(true);
  json["nan"] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(JsonText(json),
            "{\n  \"b\": 1,\n  \"a\": {\n    \"nested\": \"tab\\there \\\"quoted\\\" \\\\ "
            "caf\u00e9\"\n"
            "  },\n  \"list\": [\n    0.1,\n    true\n  ],\n  \"nan\": null\n}\n");
}

TEST(JsonTest, F70BytesThatAreNotUtf8AreReplaced) {
  EXPECT_EQ(JsonText("a\xff\xc3(\xe2\x82"), "\"a\uFFFD\uFFFD(\uFFFD\"\n");
}

}  // namespace
}  // namespace isotherm
