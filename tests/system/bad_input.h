#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/testing/dataset_folder.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {

inline constexpr int kUsage = 64, kBadData = 65, kNoInput = 66, kCannotCreate = 73, kIoError = 74,
                     kConfiguration = 78;

inline Finished RunTool(std::vector<std::string> arguments,
                        std::filesystem::path output_file = {}) {
  return RunToEnd({Tool(), std::move(arguments), {}, std::move(output_file)}, kPatience);
}

/// The lines that are not a progress bar.
inline std::vector<std::string> Sentences(const std::string& output) {
  std::vector<std::string> sentences;
  std::istringstream lines(output);
  for (std::string line; std::getline(lines, line);) {
    if (line.find(" %") == std::string::npos || line.find("  [") == std::string::npos) {
      sentences.push_back(line);
    }
  }
  return sentences;
}

/// `finished` failed with `status` and said why in one line that contains `word`.
inline void ExpectOneSentence(const Finished& finished, const ::testing::Matcher<int>& status,
                              const std::string& word) {
  EXPECT_THAT(finished.status, status) << finished.output;
  EXPECT_THAT(Sentences(finished.output), ::testing::ElementsAre(::testing::HasSubstr(word)));
}

/// Imports and reconstructs a small dataset after a test has spoiled it.
class BadInputTest : public ::testing::Test {
 protected:
  std::filesystem::path Recording() const { return dataset_.root() / "scan.mcap"; }
  std::filesystem::path Results() const { return dataset_.root() / "results"; }

  Finished Import() const { return RunTool({"import", dataset_.path(), "-o", Recording()}); }
  void ImportGood() const {
    const Finished import = Import();
    ASSERT_EQ(import.status, 0) << import.output;
  }
  void WriteFile(const std::filesystem::path& path, const std::string& text) const {
    std::ofstream(path, std::ios::binary) << text;
  }

  DatasetFolder dataset_;
};

/// A calibration with the thermal camera `tx` beside the depth camera.
inline void WriteRig(const DatasetFolder& dataset, const std::string& depth_scale,
                     const std::string& tx) {
  dataset.Write("rig.textproto",
                "depth { width: 32 height: 24 fx: 30 fy: 30 cx: 15.5 cy: 11.5 }\ndepth_scale: " +
                    depth_scale +
                    "\nthermal { width: 20 height: 15 fx: 20 fy: 20 cx: 9.5 cy: 7 }\n"
                    "T_thermal_depth { tx: " +
                    tx + " ty: 0 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 }\n");
}

}  // namespace isotherm::system_test
