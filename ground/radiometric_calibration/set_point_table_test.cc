#include "ground/radiometric_calibration/set_point_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(SetPointTableTest, ReadingsAndFilesAreRead) {
  const auto rows = ParseSetPoints(
      "# black body, reading\n30, 29.6, 0.2\n\n 120 ,hole 10 mm.mcap\r\n-5,images,0\n", "bb.csv",
      "/scans");
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 3U);
  EXPECT_EQ((*rows)[0].line, 2);
  EXPECT_EQ((*rows)[0].body_celsius, 30.0);
  EXPECT_EQ((*rows)[0].reading_celsius, 29.6);
  EXPECT_EQ((*rows)[0].sigma_k, 0.2);
  EXPECT_EQ((*rows)[1].images, "/scans/hole 10 mm.mcap");
  EXPECT_FALSE((*rows)[1].reading_celsius);
  EXPECT_FALSE((*rows)[1].sigma_k);
  EXPECT_EQ((*rows)[2].body_celsius, -5.0);
  EXPECT_EQ((*rows)[2].line, 5);
}

TEST(SetPointTableTest, WhatIsNoRowIsNamed) {
  const auto message = [](const std::string& text) {
    const auto rows = ParseSetPoints("20, 20\n" + text, "bb.csv", "");
    return rows ? std::string() : rows.error().message();
  };
  EXPECT_THAT(message("120"), AllOf(HasSubstr("bb.csv:2"), HasSubstr("separated by commas")));
  EXPECT_THAT(message("120,"), HasSubstr("separated by commas"));
  EXPECT_THAT(message("1,2,3,4"), HasSubstr("separated by commas"));
  EXPECT_THAT(message("hot, 20"), HasSubstr("\"hot\""));
  EXPECT_THAT(message("nan, 20"), HasSubstr("black body's temperature"));
  EXPECT_THAT(message("2000, 20"), HasSubstr("-100 to 1500"));
  EXPECT_THAT(message("20, 20000"), HasSubstr("a reading must be"));
  EXPECT_THAT(message("20, 20, -1"), HasSubstr("uncertainty must be 0 to 10 K"));
  EXPECT_THAT(message("30,5,29"), HasSubstr("uncertainty must be 0 to 10 K")) << "decimal commas";
  EXPECT_THAT(ParseSetPoints("# nothing\n", "bb.csv", "").error().message(),
              HasSubstr("bb.csv: there is no row"));
  std::string many;
  for (int i = 0; i < 1001; ++i) many += "20, 20\n";
  EXPECT_THAT(ParseSetPoints(many, "bb.csv", "").error().message(), HasSubstr("more than 1000"));
}

}  // namespace
}  // namespace isotherm
