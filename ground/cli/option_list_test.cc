#include "ground/cli/option_list.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "ground/cli/option_tree.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string List(std::string_view program, std::string_view stage, bool with_expert) {
  const Result<std::string> text = ListOptions(program, stage, with_expert);
  return text ? *text : text.error().message();
}

TEST(OptionListTest, EverydayOptionsComeFirstAndTheOthersWhenAskedFor) {
  const std::string everyday = List("ground", "", false);
  EXPECT_THAT(everyday,
              AllOf(HasSubstr("\n  volume.voxel_size_m = 0.002\n      Edge length of a voxel"),
                    HasSubstr("\n  thermal.distance.good_m = 0.6\n"),
                    HasSubstr("more for experts: --expert\n"), Not(HasSubstr(".expert."))));
  const std::string all = List("ground", "", true);
  const std::size_t expert = all.find("tracker.external_odometry.expert.max_gap_s = 0.2\n");
  ASSERT_NE(expert, std::string::npos);
  EXPECT_LT(all.rfind("  thermal.distance.good_m = 0.6\n"), all.find(".expert."));
  EXPECT_THAT(all, HasSubstr("  thermal.expert.policy = BEST_CONDITIONS\n"));
}

TEST(OptionListTest, AStageAndItsExpertBlockCanBeNamed) {
  const std::string stage = List("ground", "volume", false);
  EXPECT_THAT(stage, AllOf(HasSubstr("volume.spill_dir"), Not(HasSubstr("max_memory_bytes =")),
                           Not(HasSubstr("\n  thermal."))));
  EXPECT_THAT(List("ground", "tsdf", true), HasSubstr("  tsdf.expert.max_weight = 255\n"));
  EXPECT_THAT(List("ground", "thermal.expert.motion", false),
              HasSubstr("  thermal.expert.motion.smear_good_px = 0.5\n"));
  EXPECT_THAT(List("ground", "tsfd", false), HasSubstr("Did you mean 'tsdf'?"));
}

TEST(OptionListTest, PartsOfSeveralGroupsAreListed) {
  EXPECT_THAT(List("ground", "renderer", false),
              AllOf(HasSubstr("renderer.isotherm   (several; in a file only)"),
                    HasSubstr("      celsius   (none)")));
}

/// Whoever reads the page must learn what each option does.
TEST(OptionListTest, EachOptionHasAComment) {
  const auto pool = LoadOptionDescriptors();
  ASSERT_TRUE(pool);
  int options = 0;
  for (const char* program :
       {"isotherm.GroundOptions", "isotherm.EdgeOptions", "isotherm.SimulationOptions"}) {
    const google::protobuf::Descriptor* type = pool->FindMessageTypeByName(program);
    ASSERT_NE(type, nullptr) << program;
    for (const OptionRing ring : {OptionRing::kEveryday, OptionRing::kExpert}) {
      for (const OptionGroup& group : GroupsOf(*type, "", ring)) {
        // Points and poses say in their own comment what their numbers are.
        if (group.name.ends_with("pose") || group.name.ends_with("T_depth_body")) continue;
        for (const google::protobuf::FieldDescriptor* field : group.options) {
          EXPECT_NE(Comment(*field), "") << program << ": " << group.name << "." << field->name();
          ++options;
        }
      }
    }
  }
  EXPECT_GT(options, 200);
}

TEST(OptionListTest, ThePageInTheDocumentsIsCurrent) {
  std::ostringstream page;
  page << std::ifstream(ISOTHERM_SOURCE_DIR "/docs/options.md").rdbuf();
  const Result<std::string> made = OptionsPage();
  ASSERT_TRUE(made) << made.error().message();
  EXPECT_TRUE(page.str() == *made)
      << "docs/options.md is not what the .proto files say; from the top of the source tree:\n"
         "  build/release/bin/isotherm options --markdown > docs/options.md";
}

}  // namespace
}  // namespace isotherm
