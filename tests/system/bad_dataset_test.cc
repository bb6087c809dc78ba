// A folder that is broken, or hardly right, is imported. The tool says one sentence that names the
// file, or warns of the likely cause.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <functional>
#include <sstream>

#include "tests/system/bad_input.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

TEST_F(BadInputTest, TheUntouchedFolderIsImported) { ImportGood(); }

struct BrokenDataset {
  const char* name;
  std::function<void(const DatasetFolder&)> damage;
  int status;
  const char* word;
};

class BrokenDatasetTest : public BadInputTest,
                          public ::testing::WithParamInterface<BrokenDataset> {};

TEST_P(BrokenDatasetTest, IsRefusedInOneSentence) {
  GetParam().damage(dataset_);
  ExpectOneSentence(Import(), GetParam().status, GetParam().word);
  EXPECT_FALSE(std::filesystem::exists(Recording())) << "a recording of a refused dataset";
}

INSTANTIATE_TEST_SUITE_P(
    , BrokenDatasetTest,
    ::testing::Values(
        BrokenDataset{"MissingFolder", [](const DatasetFolder& d) { d.Remove(""); }, kNoInput,
                      "scan"},
        BrokenDataset{"EmptyFolder",
                      [](const DatasetFolder& d) {
                        d.Remove("");
                        std::filesystem::create_directories(d.path());
                      },
                      kNoInput, "scan"},
        BrokenDataset{"MissingCalibration",
                      [](const DatasetFolder& d) { d.Remove("rig.textproto"); }, kNoInput,
                      "rig.textproto"},
        BrokenDataset{
            "CalibrationWithoutIntrinsics",
            [](const DatasetFolder& d) { d.Write("rig.textproto", "depth_scale: 1000\n"); },
            kBadData, "rig.textproto"},
        BrokenDataset{"MisspeltImage",
                      [](const DatasetFolder& d) { d.Rename("depth/1.png", "depth/l.png"); },
                      kNoInput, "depth/1.png"},
        BrokenDataset{"EightBitImage",
                      [](const DatasetFolder& d) { d.WriteOtherPng("depth/1.png", 32, 24, 1, 8); },
                      kBadData, "depth/1.png"},
        BrokenDataset{"ImageOfAnotherSize",
                      [](const DatasetFolder& d) {
                        d.WriteImage("thermal/1.png", {32, 24, 30000});
                      },
                      kBadData, "thermal/1.png"},
        BrokenDataset{"NotAnImage", [](const DatasetFolder& d) { d.Write("depth/1.png", "hello"); },
                      kBadData, "depth/1.png"},
        BrokenDataset{"DuplicateStamp",
                      [](const DatasetFolder& d) {
                        d.Write("depth.txt", "1.0 depth/0.png\n1.0 depth/1.png\n");
                      },
                      kBadData, "depth.txt"},
        BrokenDataset{"UnsortedStamps",
                      [](const DatasetFolder& d) {
                        d.Write("depth.txt", "2.0 depth/0.png\n1.0 depth/1.png\n");
                      },
                      kBadData, "depth.txt"},
        BrokenDataset{"StampThatIsNoNumber",
                      [](const DatasetFolder& d) { d.Write("depth.txt", "now depth/0.png\n"); },
                      kBadData, "depth.txt"}),
    [](const auto& suite) { return suite.param.name; });

struct DoubtfulDataset {
  const char* name;
  std::function<void(const DatasetFolder&)> damage;
  const char* cause;  ///< The message, with the likely cause.
};

class DoubtfulDatasetTest : public BadInputTest,
                            public ::testing::WithParamInterface<DoubtfulDataset> {};

// What was imported is there: it may be all that there is.
TEST_P(DoubtfulDatasetTest, IsImportedWithAWarningAndStatus65) {
  GetParam().damage(dataset_);
  const Finished import = Import();
  EXPECT_EQ(import.status, kBadData) << import.output;
  EXPECT_THAT(import.output, HasSubstr("isotherm: warning: "));
  EXPECT_THAT(import.output, HasSubstr(GetParam().cause));
  const Finished inspect = RunTool({"inspect", Recording()});
  EXPECT_EQ(inspect.status, kBadData) << inspect.output;
  EXPECT_THAT(inspect.output, HasSubstr(GetParam().cause));
  EXPECT_THAT(inspect.output, HasSubstr("4 frames of 32 x 24 pixels"));
}

/// Stamps of depth and thermal frames, from 100 s on, times `factor`.
void WriteStamps(const DatasetFolder& dataset, double factor, double thermal_later_s) {
  std::ostringstream depth, thermal;
  depth << std::fixed;
  thermal << std::fixed;
  for (int i = 0; i < DatasetFolder::kDepthFrames; ++i)
    depth << factor * (100.1 + 0.033 * i) << " depth/" << i << ".png\n";
  for (int i = 0; i < DatasetFolder::kThermalFrames; ++i)
    thermal << factor * (100.1 + thermal_later_s + 0.025 * i) << " thermal/" << i << ".png\n";
  dataset.Write("depth.txt", depth.str());
  dataset.Write("thermal.txt", thermal.str());
  dataset.Remove("nuc.txt");
  dataset.Remove("groundtruth.txt");
}

INSTANTIATE_TEST_SUITE_P(
    , DoubtfulDatasetTest,
    ::testing::Values(
        DoubtfulDataset{"StampsInMicroseconds",
                        [](const DatasetFolder& d) { WriteStamps(d, 1e6, 0.0); },
                        "these look like microseconds (30.3 Hz): divide them by 1000000"},
        DoubtfulDataset{"ThermalStampsOfAnotherClock",
                        [](const DatasetFolder& d) { WriteStamps(d, 1.0, 1000.0); },
                        "they seem to be stamped by two clocks"},
        DoubtfulDataset{"ExtrinsicsInMillimetres",
                        [](const DatasetFolder& d) { WriteRig(d, "1000", "50"); },
                        "as millimetres they would be 0.05 m"},
        DoubtfulDataset{"DepthInMetres", [](const DatasetFolder& d) { WriteRig(d, "1", "0.05"); },
                        "depth_scale 1000 would make it 0.5"},
        DoubtfulDataset{"DepthScaleTooLarge",
                        [](const DatasetFolder& d) { WriteRig(d, "5000", "0.05"); },
                        "depth_scale 1000 would make it 0.5"},
        DoubtfulDataset{"CentiDegrees",
                        [](const DatasetFolder& d) {
                          for (int i = 0; i < DatasetFolder::kThermalFrames; ++i)
                            d.WriteImage("thermal/" + std::to_string(i) + ".png",
                                         {20, 15, static_cast<std::uint16_t>(2300 + i)});
                        },
                        "as centi-degrees Celsius they would be 23.0 °C"},
        DoubtfulDataset{"NoTemperatures",
                        [](const DatasetFolder& d) {
                          for (int i = 0; i < DatasetFolder::kThermalFrames; ++i)
                            d.WriteImage("thermal/" + std::to_string(i) + ".png", {20, 15, 0});
                        },
                        "all are 0"}),
    [](const auto& suite) { return suite.param.name; });

// A pipe would be waited for until somebody writes to it.
TEST_F(BadInputTest, APipeInPlaceOfAFileIsRefusedAtOnceAndNamed) {
  for (const char* name :
       {"depth.txt", "thermal.txt", "groundtruth.txt", "nuc.txt", "rig.textproto", "depth/1.png"}) {
    const DatasetFolder folder;
    folder.Remove(name);
    ASSERT_EQ(mkfifo((folder.path() / name).c_str(), 0600), 0);
    ExpectOneSentence(RunTool({"import", folder.path(), "-o", Recording()}), ::testing::Gt(0),
                      name);
  }
}

TEST_F(BadInputTest, APipeAsOptionRigResultOrCameraIsRefusedAtOnceAndNamed) {
  const std::filesystem::path pipe = dataset_.root() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((dataset_.path() / "trajectory.txt").c_str(), 0600), 0);
  ImportGood();
  for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
           {"inspect", pipe},
           {"import", dataset_.path(), "-o", dataset_.root() / "other.mcap", "--rig", pipe},
           {"reconstruct", Recording(), "-o", Results(), "--config", pipe},
           {"reconstruct", Recording(), "-o", Results(), "--rig", pipe},
           {"evaluate", dataset_.path(), "--groundtruth", pipe}}) {
    const Finished finished = RunTool(arguments);
    EXPECT_GT(finished.status, 0) << arguments[0];
    EXPECT_LT(finished.status, 128) << arguments[0];
    EXPECT_THAT(finished.output, HasSubstr("pipe or a device")) << arguments[0];
  }
  for (const char* option : {"--config", "--rig", "--recording"}) {
    const Finished edge =
        RunToEnd({EdgeDaemon(),
                  {"--domain", std::to_string(OwnDomain()), "--exit-at-end", option, pipe},
                  {}},
                 kPatience);
    EXPECT_GT(edge.status, 0) << option;
    EXPECT_THAT(edge.output, HasSubstr("pipe or a device")) << option;
  }
}

}  // namespace
}  // namespace isotherm::system_test
