// `isotherm convert` and what `inspect` says of recordings, as a user runs them.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "tests/tool/recording_tool_run.h"

namespace isotherm::testing {
namespace {

class ConvertToolTest : public RecordingToolRun {};

TEST_F(ConvertToolTest, ThereAndBackNothingOfTheFramesChanges) {
  Simulate();
  const Outcome viewable = Run("convert scan.mcap -o view.mcap --encoding viewable");
  ASSERT_EQ(viewable.status, 0) << viewable.err;
  const Outcome compact = Run("convert view.mcap -o small.mcap --encoding compact");
  ASSERT_EQ(compact.status, 0) << compact.err;
  Content scan, view, small;
  Read("scan.mcap", scan);
  Read("view.mcap", view);
  Read("small.mcap", small);
  ASSERT_GT(scan.pixels.size(), 10U);
  for (const Content* other : {&view, &small}) {
    EXPECT_EQ(other->pixels, scan.pixels);
    EXPECT_EQ(other->frames, scan.frames);
    EXPECT_EQ(other->rig, scan.rig);
    EXPECT_EQ(other->poses.at("groundtruth").size(), scan.poses.at("groundtruth").size());
    EXPECT_EQ(other->info.metadata.at("simulation"), scan.info.metadata.at("simulation"));
  }
  EXPECT_LT(fs::file_size(folder_ / "small.mcap"), fs::file_size(folder_ / "view.mcap"));
  EXPECT_TRUE(view.info.messages_by_topic.contains("/thermal/transform"));
}

TEST_F(ConvertToolTest, InspectSaysWhichOfBothItIs) {
  Simulate();
  ASSERT_EQ(Run("convert scan.mcap -o view.mcap").status, 0);
  EXPECT_THAT(Run("inspect scan.mcap").out,
              AllOf(HasSubstr("compact: lossless, only Isotherm"),
                    HasSubstr("isotherm convert scan.mcap -o OUT.mcap --encoding viewable")));
  EXPECT_THAT(Run("inspect view.mcap").out, HasSubstr("viewable: Foxglove and Lichtblick"));
  EXPECT_THAT(Run("inspect view.mcap --json").out, HasSubstr("\"viewable\": true"));
}

TEST_F(ConvertToolTest, ARecordingWithSpoiledImagesSaysSoForEver) {
  Simulate();
  ASSERT_EQ(Run("convert scan.mcap -o holes.mcap --spoil-depth grid").status, 0);
  ASSERT_EQ(Run("convert holes.mcap -o worse.mcap --spoil-depth flying").status, 0);
  ASSERT_EQ(Run("convert worse.mcap -o small.mcap --encoding compact").status, 0);
  EXPECT_THAT(Run("inspect scan.mcap").out, Not(HasSubstr("SPOILED")));
  EXPECT_THAT(Run("inspect holes.mcap").out,
              HasSubstr("SPOILED       depth images are not what the camera sent: grid ("));
  EXPECT_THAT(Run("inspect small.mcap").out, HasSubstr("what the camera sent: grid, flying ("));
  Content small;
  Read("small.mcap", small);
  EXPECT_EQ(small.info.metadata.at("spoiled"),
            (std::map<std::string, std::string>{{"depth", "grid, flying"}}));
}

TEST_F(ConvertToolTest, PosesOfAResultComeAlong) {
  Simulate();
  fs::create_directory(folder_ / "result");
  Write("result/trajectory.txt", "1.5 0.1 0.2 0.3 0 0 0 1\n1.6 0.1 0.2 0.4 0 0 0 1\n");
  const Outcome outcome = Run("convert scan.mcap -o view.mcap --trajectory result");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("2 of the rig, from the trajectory"));
  Content view;
  Read("view.mcap", view);
  ASSERT_EQ(view.poses["trajectory"].size(), 2U);
  EXPECT_EQ(view.poses["trajectory"][1].T_world_depth.translation(),
            Eigen::Vector3d(0.1, 0.2, 0.4));
}

TEST_F(ConvertToolTest, WhatCannotBeIsRefusedAndNothingIsLost) {
  Simulate();
  Write("there.mcap", "precious");
  const Outcome exists = Run("convert scan.mcap -o there.mcap");
  EXPECT_EQ(exists.status, kUsage);
  EXPECT_THAT(exists.err, HasSubstr("exists already; --force replaces it"));
  EXPECT_EQ(ReadAll(folder_ / "there.mcap"), "precious");
  EXPECT_EQ(Run("convert nowhere.mcap -o x.mcap").status, kNoInput);
  EXPECT_EQ(Run("convert scan.mcap -o x.mcap --trajectory nowhere").status, kNoInput);
  EXPECT_THAT(Run("convert scan.mcap -o x.mcap --encoding png").err,
              HasSubstr("'png' is none of compact, viewable"));
  EXPECT_THAT(Run("convert scan.mcap -o ''").err, HasSubstr("names no file"));
  for (const auto& entry : fs::directory_iterator(folder_))
    EXPECT_FALSE(entry.path().extension() == ".partial") << entry.path();
}

}  // namespace
}  // namespace isotherm::testing
