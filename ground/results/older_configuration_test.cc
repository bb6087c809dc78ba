// What an earlier version wrote into its results is read as this version's options.

#include "ground/results/older_configuration.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "ground/json/message_json.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {
namespace {

GroundOptions Read(const Json& written) {
  const Json present = WithPresentNames(written, *GroundOptions::descriptor());
  GroundOptions options;
  const Status status = FromJson(present, "stats.json", options);
  EXPECT_TRUE(status.ok()) << status.message() << '\n' << present.dump();
  return options;
}

void ExpectTwoRegions(const GroundOptions& options) {
  EXPECT_EQ(options.interpretation().emissivity(), 0.9);
  ASSERT_EQ(options.interpretation().region_size(), 2);
  EXPECT_EQ(options.interpretation().region(0).name(), "door");
  EXPECT_EQ(options.interpretation().region(0).emissivity(), 0.5);
  EXPECT_EQ(options.interpretation().region(1).name(), "frame");
}

TEST(OlderConfigurationTest, MembersOfListsAreReadButForTextThatIsAMessageNow) {
  ExpectTwoRegions(Read(Json::parse(R"({"interpretation": {"emissivity": 0.9, "region": [
      {"name": "door", "box": "0 0 0 1 1 1", "emissivity": 0.5}, {"name": "frame"}]}})")));
}

TEST(OlderConfigurationTest, GroupsOfOneNameInTextAreAList) {
  ExpectTwoRegions(
      Read(OptionsFromLines("interpretation {\n  emissivity: 0.9\n  region {\n    name: \"door\"\n "
                            "   emissivity: 0.5\n  }\n"
                            "  region {\n    name: \"frame\"\n  }\n}\n")));
}

TEST(OlderConfigurationTest, AGroupThatStandsAloneIsAListOfOne) {
  const GroundOptions options =
      Read(OptionsFromLines("interpretation {\n  region {\n    name: \"door\"\n  }\n}\n"));
  ASSERT_EQ(options.interpretation().region_size(), 1);
  EXPECT_EQ(options.interpretation().region(0).name(), "door");
}

TEST(OlderConfigurationTest, WhatARenamedGroupContainsIsRenamedToo) {
  const GroundOptions options = Read(Json::parse(
      R"({"tracker": {"outside": {"source": "vio", "max_gap_s": 0.3, "T_depth_body": ""}}})"));
  EXPECT_EQ(options.tracker().external_odometry().expert().source(), "vio");
  EXPECT_EQ(options.tracker().external_odometry().expert().max_gap_s(), 0.3);
}

TEST(OlderConfigurationTest, AnEverydayOptionThatBecameAnExpertsJoinsTheOthersThere) {
  const GroundOptions options = Read(Json::parse(
      R"({"thermal": {"keep_bad": true, "expert": {"max_wait_s": 0.3, "policy": "LOWEST_GOOD"}}})"));
  EXPECT_TRUE(options.thermal().expert().keep_bad());
  EXPECT_EQ(options.thermal().expert().max_depth_gap_s(), 0.3);
  EXPECT_EQ(options.thermal().expert().policy(), LOWEST_GOOD);
}

}  // namespace
}  // namespace isotherm
