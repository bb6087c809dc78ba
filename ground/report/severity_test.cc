#include "ground/report/severity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using ::testing::HasSubstr;

SeverityTables TwoRows() {
  SeverityTables tables;
  SeverityTable& table = *tables.add_table();
  table.set_basis("similar");
  SeverityRow& low = *table.add_row();
  low.set_above_k(1.0);
  low.set_up_to_k(15.0);
  low.set_level("probable");
  SeverityRow& high = *table.add_row();
  high.set_above_k(15.0);
  high.set_level("major");
  return tables;
}

TEST(SeverityTest, ADifferenceFindsItsRow) {
  const SeverityTables tables = TwoRows();
  EXPECT_EQ(FindSeverity(tables, "similar", 1.0), nullptr);
  EXPECT_EQ(FindSeverity(tables, "similar", 1.1)->level(), "probable");
  EXPECT_EQ(FindSeverity(tables, "similar", 15.0)->level(), "probable");
  EXPECT_EQ(FindSeverity(tables, "similar", 15.1)->level(), "major");
  EXPECT_EQ(FindSeverity(tables, "similar", 900.0)->level(), "major");
  EXPECT_EQ(FindSeverity(tables, "ambient", 15.1), nullptr);
}

TEST(SeverityTest, RowsThatOverlapOrDescendAreRefused) {
  SeverityTables tables = TwoRows();
  EXPECT_TRUE(Validate(tables).ok());
  tables.mutable_table(0)->mutable_row(1)->set_above_k(14.0);
  EXPECT_THAT(Validate(tables).message(), HasSubstr("row 2"));
  tables = TwoRows();
  tables.mutable_table(0)->mutable_row(0)->clear_up_to_k();
  EXPECT_FALSE(Validate(tables).ok());
  tables = TwoRows();
  tables.mutable_table(0)->set_basis("sideways");
  EXPECT_FALSE(Validate(tables).ok());
  EXPECT_FALSE(Validate(SeverityTables()).ok());
}

TEST(SeverityTest, TheShippedTableIsGood) {
  const auto tables = ReadSeverityTables(ISOTHERM_SOURCE_DIR "/deploy/severity/neta-mts.textproto");
  ASSERT_TRUE(tables) << tables.error().message();
  EXPECT_EQ(FindSeverity(*tables, "similar", 16.0)->level(), "major discrepancy");
  EXPECT_EQ(FindSeverity(*tables, "ambient", 41.0)->level(), "major discrepancy");
}

}  // namespace
}  // namespace isotherm
