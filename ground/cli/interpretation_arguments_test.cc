#include "ground/cli/interpretation_arguments.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

class InterpretationArgumentsTest : public ::testing::Test {
 protected:
  void UseRegions(const char* text) {
    arguments_.regions = folder_.path() / "regions.textproto";
    std::ofstream(arguments_.regions) << text;
  }
  std::string Problem() {
    InterpretationOptions options;
    return ApplyArguments(arguments_, options).message();
  }

  const testing::TemporaryDirectory folder_;
  InterpretationArguments arguments_;
};

TEST_F(InterpretationArgumentsTest, CommandLineHoldsOverTheFileAndBoxesComeLast) {
  UseRegions(R"(emissivity: 0.9 reflected_celsius: 20
    region { name: "hot pipe: left" box { min { x_m: 0 y_m: 0 z_m: 0 } max { x_m: 1 y_m: 1 z_m: 1 } } emissivity: 0.3 }
    region { name: "glass" box { min { x_m: 0 y_m: 0 z_m: 0 } max { x_m: 2 y_m: 2 z_m: 2 } } })");
  arguments_.emissivity = 0.8;
  arguments_.band = "3 5";
  arguments_.labels = {"hot pipe: left: emissivity=0.4 reflected=30"};
  arguments_.boxes = {"1 2 3 4 5 6: emissivity=0.5", "0,0,0 , 1,1,1:reflected=-5 name=window"};
  InterpretationOptions options;
  const Status status = ApplyArguments(arguments_, options);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(options.emissivity(), 0.8);
  EXPECT_EQ(options.reflected_celsius(), 20.0);
  EXPECT_EQ(options.expert().band_min_um(), 3.0);
  ASSERT_EQ(options.region_size(), 4);
  EXPECT_EQ(options.region(0).emissivity(), 0.4);
  EXPECT_EQ(options.region(0).reflected_celsius(), 30.0);
  EXPECT_EQ(options.region(2).box().min().x_m(), 1.0);
  EXPECT_EQ(options.region(2).box().max().z_m(), 6.0);
  EXPECT_EQ(options.region(2).emissivity(), 0.5);
  EXPECT_FALSE(options.region(2).has_reflected_celsius());
  EXPECT_EQ(options.region(3).name(), "window");
  EXPECT_EQ(options.region(3).reflected_celsius(), -5.0);
}

TEST_F(InterpretationArgumentsTest, MaterialAndUncertaintiesAreOfTheModelAndOfBoxes) {
  arguments_.emissivity_sigma = 0.02;
  arguments_.reflected_sigma_k = 3.0;
  arguments_.material = "paint";
  arguments_.boxes = {
      "0 0 0 1 1 1: emissivity=0.2 material=steel emissivity-sigma=0.05 reflected-sigma=2"};
  InterpretationOptions options;
  const Status status = ApplyArguments(arguments_, options);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(options.emissivity_sigma(), 0.02);
  EXPECT_EQ(options.reflected_sigma_k(), 3.0);
  EXPECT_EQ(options.material(), "paint");
  EXPECT_EQ(options.region(0).material(), "steel");
  EXPECT_EQ(options.region(0).emissivity_sigma(), 0.05);
  EXPECT_EQ(options.region(0).reflected_sigma_k(), 2.0);
}

TEST_F(InterpretationArgumentsTest, WhatCannotBeReadIsSaid) {
  for (const auto& [box, said] : {std::pair("1 2 3 4 5: emissivity=1", "--box: expected 6 numbers"),
                                  {"0 0 0 1 1 1", "nothing to interpret with"},
                                  {"0 0 0 1 1 1: name=x", "nothing to interpret with"},
                                  {"0 0 0 1 1 1: emisivity=1", "'emisivity=1' is not known"},
                                  {"0 0 0 1 1 1: emissivity", "'emissivity' is not known"},
                                  {"0 0 0 1 1 1: emissivity=warm", "'warm' is not a number"}}) {
    arguments_.boxes = {box};
    EXPECT_NE(Problem().find(said), std::string::npos) << box << ": " << Problem();
  }
}

TEST_F(InterpretationArgumentsTest, UnknownLabelsAreSaidWithTheKnownOnes) {
  arguments_.labels = {"pipe: emissivity=0.4"};
  EXPECT_NE(Problem().find("--regions FILE brings them"), std::string::npos) << Problem();
  UseRegions(
      R"(region { name: "pipes" box { min { x_m: 0 y_m: 0 z_m: 0 } max { x_m: 1 y_m: 1 z_m: 1 } } })");
  EXPECT_NE(Problem().find("Did you mean 'pipes'?"), std::string::npos) << Problem();
}

TEST_F(InterpretationArgumentsTest, UnknownFieldsInTheFileAreSaidWithTheirPlace) {
  UseRegions("region {\n  emisivity: 0.3\n}");
  EXPECT_NE(Problem().find("regions.textproto:2"), std::string::npos) << Problem();
}

}  // namespace
}  // namespace isotherm
