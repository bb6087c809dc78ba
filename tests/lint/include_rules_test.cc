#include "tests/lint/include_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/lint/folder_arrows.h"

namespace isotherm::lint {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<std::string> MessagesFor(const std::string& path, const std::string& line) {
  std::vector<std::string> messages;
  for (const Violation& violation : CheckIncludes({{path, {"// A comment.", line}}})) {
    EXPECT_EQ(violation.path, path);
    EXPECT_EQ(violation.line, 2);
    messages.push_back(violation.message);
  }
  return messages;
}

TEST(IncludeRulesTest, TheRepositoryKeepsTheDependencyRule) {
  const std::vector<SourceFile> files = ReadSourceTree(ISOTHERM_SOURCE_DIR);
  ASSERT_GT(files.size(), 50U) << "nothing to check in " ISOTHERM_SOURCE_DIR;
  const std::vector<Violation> violations = CheckIncludes(files);
  EXPECT_TRUE(violations.empty()) << ToString(violations);
}

TEST(IncludeRulesTest, EdgeAndGroundNeverIncludeEachOther) {
  EXPECT_THAT(MessagesFor("edge/nuc/nuc_supervisor.cc", "#include \"ground/tsdf/tsdf_volume.h\""),
              ElementsAre(HasSubstr("edge must not include ground")));
  EXPECT_THAT(
      MessagesFor("ground/service/ground_main.cc", "#  include \"edge/source/frame_source.h\""),
      ElementsAre(HasSubstr("ground must not include edge")));
  EXPECT_THAT(MessagesFor("edge/pipeline/edge_pipeline_test.cc", "#include \"ground/cli/tool.h\""),
              ElementsAre(HasSubstr("edge must not include ground")));
}

TEST(IncludeRulesTest, LowerFoldersDoNotKnowHigherOnes) {
  EXPECT_THAT(MessagesFor("common/base/status.h", "#include \"common/time/clock.h\""),
              ElementsAre(HasSubstr("common/base must not include common/time")));
  EXPECT_THAT(MessagesFor("common/frame/frame.h", "#include \"common/codec/codec.h\""),
              ElementsAre(HasSubstr("common/frame must not include common/codec")));
  EXPECT_THAT(MessagesFor("common/recording/recording.h", "#include \"edge/spool/spool.h\""),
              ElementsAre(HasSubstr("common must not include edge")));
  EXPECT_THAT(MessagesFor("common/codec/codec.cc", "#include \"common/frame/frame.h\""), IsEmpty());
}

TEST(IncludeRulesTest, StagesDoNotIncludeTheirSiblings) {
  EXPECT_THAT(MessagesFor("ground/icp/icp.cc", "#include \"ground/renderer/palette.h\""),
              ElementsAre(HasSubstr("ground/icp must not include ground/renderer")));
  EXPECT_THAT(MessagesFor("ground/thermal/fuser.h", "#include \"ground/tsdf/tsdf_volume.h\""),
              IsEmpty());
  EXPECT_THAT(
      MessagesFor("ground/results/scan_result.cc", "#include \"ground/renderer/palette.h\""),
      IsEmpty());
}

TEST(IncludeRulesTest, SdkHeadersStayInOneFolderAndInSources) {
  EXPECT_THAT(MessagesFor("edge/publisher/publisher.cc", "#include <dds/dds.h>"),
              ElementsAre(HasSubstr("belongs to common/transport only")));
  EXPECT_THAT(MessagesFor("common/transport/participant.h", "#include \"dds/dds.h\""),
              ElementsAre(HasSubstr(".cc files only")));
  EXPECT_THAT(MessagesFor("ground/subscriber/subscriber.cc", "#include <libusb-1.0/libusb.h>"),
              ElementsAre(HasSubstr("belongs to edge/usb only")));
  EXPECT_THAT(MessagesFor("ground/service/live_scan.cc", "#include <isotherm_frames.h>"),
              ElementsAre(HasSubstr("belongs to common/transport only")));
  EXPECT_THAT(MessagesFor("common/transport/participant.cc", "#include \"dds/dds.h\""), IsEmpty());
  // A header that is part of one source file.
  const auto asio = "#include <boost/asio/post.hpp>";
  EXPECT_THAT(MessagesFor("ground/console/http_connection.h", asio), IsEmpty());
  EXPECT_THAT(MessagesFor("ground/console/door.h", asio), ElementsAre(HasSubstr(".cc files only")));
  const auto part = "#include \"ground/console/http_connection.h\"";
  EXPECT_THAT(MessagesFor("ground/console/web_server.cc", part), IsEmpty());
  EXPECT_THAT(MessagesFor("ground/console/console.cc", part),
              ElementsAre(HasSubstr("part of ground/console/web_server.cc")));
}

TEST(IncludeRulesTest, HeavyHeadersDoNotLeaveTheirFolder) {
  const SourceFile image = {"ground/renderer/image.h", {"#include <opencv2/core.hpp>"}};
  const SourceFile message = {"common/rig/rig_file.h", {"#include \"common/rig/rig_file.pb.h\""}};
  const SourceFile neighbour = {"ground/renderer/image.cc",
                                {"#include \"ground/renderer/image.h\""}};
  EXPECT_THAT(CheckIncludes({image, message, neighbour}), IsEmpty());

  const SourceFile pipeline = {
      "ground/results/scan_result.cc",
      {"#include \"ground/renderer/image.h\"", "#include \"common/rig/rig_file.h\""}};
  const std::vector<Violation> violations = CheckIncludes({image, message, neighbour, pipeline});
  ASSERT_EQ(violations.size(), 2U) << ToString(violations);
  EXPECT_EQ(violations[0].path, image.path);
  EXPECT_THAT(violations[0].message, HasSubstr("reaches other folders"));
  EXPECT_EQ(violations[1].path, message.path);
}

TEST(IncludeRulesTest, TestHelpersStayOutOfPrograms) {
  EXPECT_THAT(MessagesFor("ground/tsdf/integrator.cc", "#include \"common/testing/scene.h\""),
              ElementsAre(HasSubstr("test helpers are for tests only")));
  EXPECT_THAT(MessagesFor("ground/tsdf/integrator_test.cc", "#include \"common/testing/scene.h\""),
              IsEmpty());
}

TEST(IncludeRulesTest, ReferencesOfKernelsStayOutOfPrograms) {
  constexpr char kReference[] = "#include \"ground/tsdf/reference/raycast_reference.h\"";
  for (const char* program : {"ground/tsdf/raycaster.cc", "ground/service/ground_service.cc"}) {
    EXPECT_THAT(MessagesFor(program, kReference),
                ElementsAre(HasSubstr("references of kernels are for tests only")));
  }
  EXPECT_THAT(MessagesFor("ground/tsdf/raycast_kernel_test.cc", kReference), IsEmpty());
  EXPECT_THAT(MessagesFor("ground/tsdf/reference/raycast_reference.h",
                          "#include \"common/testing/kernel_checks.h\""),
              IsEmpty());
}

TEST(IncludeRulesTest, OddWaysToIncludeAreRefused) {
  EXPECT_THAT(MessagesFor("ground/tsdf/a.cc", "#include \"../tracker/icp.h\""),
              ElementsAre(HasSubstr("path from the root")));
  EXPECT_THAT(MessagesFor("ground/tsdf/a.cc", "#include \"voxel_grid.h\""),
              ElementsAre(HasSubstr("path from the root")));
  EXPECT_THAT(MessagesFor("ground/tsdf/a.cc", "#include <bits/stdc++.h>"),
              ElementsAre(HasSubstr("is not used here")));
  EXPECT_THAT(MessagesFor("common/nowhere/a.cc", "#include \"common/base/status.h\""),
              ElementsAre(HasSubstr("has no rule yet")));
}

TEST(IncludeRulesTest, NoFoldersStandOnEachOther) {
  const std::vector<Violation> violations = CheckCircles(ReadSourceTree(ISOTHERM_SOURCE_DIR));
  EXPECT_TRUE(violations.empty()) << ToString(violations);
  EXPECT_THAT(FindCircle(RepositoryRule().arrows), IsEmpty()) << "the table itself has a circle";
}

TEST(IncludeRulesTest, TheTableListsNothingThatIsNotSo) {
  const std::vector<Violation> violations =
      CheckListed(ReadSourceTree(ISOTHERM_SOURCE_DIR), RepositoryRule());
  EXPECT_TRUE(violations.empty()) << ToString(violations);
}

TEST(IncludeRulesTest, ListedArrowsThatNobodyUsesAreFound) {
  const SourceFile icp = {"ground/icp/icp.cc",
                          {"#include \"ground/surface/maps.h\"", "#include <png.h>"}};
  const SourceFile icp_test = {"ground/icp/icp_test.cc", {"#include \"ground/tsdf/grid.h\""}};
  const SourceFile maps = {"ground/surface/maps.cc", {"#include \"common/base/status.h\""}};
  const SourceFile peers = {"tests/link/peers/peer.cc", {}};
  const std::vector<SourceFile> files = {icp, icp_test, maps, peers};
  const DependencyRule rule = {{{"ground/icp", {"ground/surface"}}, {"ground/surface", {}}},
                               {"common/base"},
                               {{"png.h", "ground/icp"}}};
  EXPECT_THAT(CheckListed(files, rule), IsEmpty());

  const auto messages = [&](const DependencyRule& changed) {
    std::vector<std::string> texts;
    for (const Violation& violation : CheckListed(files, changed))
      texts.push_back(violation.message);
    return texts;
  };
  DependencyRule wrong = rule;
  wrong.arrows["ground/icp"].insert("ground/tsdf");  // Its test includes it, which does not count.
  EXPECT_THAT(messages(wrong), ElementsAre("ground/icp is listed with ground/tsdf, but includes "
                                           "nothing of it"));
  wrong = rule;
  wrong.arrows["ground/nowhere"] = {};
  EXPECT_THAT(messages(wrong), ElementsAre(HasSubstr("ground/nowhere is listed, but there is no")));
  wrong = rule;
  wrong.arrows["ground/surface"] = {"common/base"};
  EXPECT_THAT(messages(wrong), ElementsAre(HasSubstr("which every folder may include")));
  wrong = rule;
  wrong.shared.insert("common/png");
  EXPECT_THAT(messages(wrong), ElementsAre(HasSubstr("may include common/png, but neither does")));
  wrong = rule;
  wrong.sdk_homes = {{"png.h", "ground/png"}, {"libusb", "ground/icp"}};
  EXPECT_THAT(messages(wrong), ElementsAre(HasSubstr("ground/icp is the home of <libusb...>"),
                                           HasSubstr("ground/png is the home of <png.h...>")));
}

TEST(IncludeRulesTest, ACircleOfFoldersIsFound) {
  const SourceFile tracker = {"ground/icp/icp.h", {"#include \"ground/tsdf/grid.h\""}};
  const SourceFile tsdf = {"ground/tsdf/raycaster.cc", {"#include \"ground/surface/maps.h\""}};
  const SourceFile surface = {"ground/surface/maps.cc", {"#include \"ground/icp/icp.h\""}};
  EXPECT_THAT(CheckCircles({tracker, tsdf}), IsEmpty());

  const std::vector<Violation> violations = CheckCircles({tracker, tsdf, surface});
  ASSERT_EQ(violations.size(), 1U);
  EXPECT_THAT(violations[0].message,
              HasSubstr("ground/icp -> ground/tsdf -> ground/surface -> ground/icp"));

  // A test may look back at what stands on its folder.
  const SourceFile test = {"ground/surface/maps_test.cc", surface.lines};
  EXPECT_THAT(CheckCircles({tracker, tsdf, test}), IsEmpty());
}

TEST(IncludeRulesTest, AStageKnowsItsOptionsAndItsInputButNeverThePipeline) {
  EXPECT_THAT(MessagesFor("ground/icp/icp.cc", "#include \"ground/options/ground_options.pb.h\""),
              IsEmpty());
  EXPECT_THAT(MessagesFor("ground/icp/icp.cc", "#include \"ground/surface/surface_maps.h\""),
              IsEmpty());
  EXPECT_THAT(MessagesFor("ground/icp/icp.cc", "#include \"ground/pipeline/ground_pipeline.h\""),
              ElementsAre(HasSubstr("ground/icp must not include ground/pipeline")));
  EXPECT_THAT(MessagesFor("edge/nuc/nuc_control.h", "#include \"edge/pipeline/edge_pipeline.h\""),
              ElementsAre(HasSubstr("edge/nuc must not include edge/pipeline")));
  EXPECT_THAT(MessagesFor("ground/pipeline/x.h", "#include \"ground/service/live_scan.h\""),
              ElementsAre(HasSubstr("ground/pipeline must not include ground/service")));
  for (const auto& [folder, targets] : RepositoryRule().arrows) {
    if (targets.contains("ground/pipeline")) {
      EXPECT_THAT(folder, AnyOf("ground/experiment", "ground/calibration", "ground/results",
                                "ground/offline", "ground/guidance", "ground/service"));
    }
  }
}

}  // namespace
}  // namespace isotherm::lint
