#include "ground/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ReportTest : public ::testing::Test {
 protected:
  ReportTest() {
    inputs_.title = "Door 7";
    inputs_.software = "isotherm 1";
    SeverityTable& table = *inputs_.severity.add_table();
    table.set_basis("similar");
    SeverityRow& row = *table.add_row();
    row.set_above_k(5.0);
    row.set_level("probable deficiency");
    row.set_action("repair");
  }
  measuring::MeasuredShape& Add(const std::string& name, measuring::Shape::Kind kind) {
    measuring::Shape& shape = *inputs_.measurements.add_shapes();
    shape.set_id(name);
    shape.set_name(name);
    shape.set_kind(kind);
    return *inputs_.measurements.add_measured();
  }
  ReportInputs inputs_;
};

TEST_F(ReportTest, ADifferenceIsAssessedByTheTable) {
  Add("left - right", measuring::Shape::DIFFERENCE).set_difference_k(-7.5);
  const ReportFiles files = MakeReport(inputs_);
  EXPECT_THAT(files.html, HasSubstr("probable deficiency: repair"));
  EXPECT_THAT(files.csv, HasSubstr("left - right,difference,,,,,-7.5"));
  EXPECT_EQ(Json::parse(files.json)["assessment"][0]["severity"], "probable deficiency");
}

TEST_F(ReportTest, WithoutATableNothingIsAssessed) {
  inputs_.severity.Clear();
  Add("d", measuring::Shape::DIFFERENCE).set_difference_k(100.0);
  EXPECT_THAT(MakeReport(inputs_).html, Not(HasSubstr("deficiency")));
}

TEST_F(ReportTest, NamesCannotBreakThePage) {
  Add("<script>alert(1)</script>", measuring::Shape::NOTE);
  inputs_.remarks = "\"><img src=x>";
  const ReportFiles files = MakeReport(inputs_);
  EXPECT_THAT(files.html, Not(HasSubstr("<script>")));
  EXPECT_THAT(files.html, Not(HasSubstr("<img src=x>")));
}

TEST_F(ReportTest, NamesCannotBreakTheTable) {
  EXPECT_EQ(EscapeCsv("a,b"), "\"a,b\"");
  EXPECT_EQ(EscapeCsv("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(EscapeCsv("=HYPERLINK(1)"), "'=HYPERLINK(1)");
  EXPECT_EQ(EscapeCsv("-3.5"), "-3.5");
}

TEST_F(ReportTest, WhatWasNotMeasuredIsToldWithItsReason) {
  Surface mesh;
  // Two right triangles of half a square metre: one good, one too far and too oblique.
  for (int i = 0; i < 2; ++i) {
    CloudPoint point;
    point.distance_class = point.angle_class = i == 0 ? 1 : 0;
    point.motion_class = 1;
    for (const Eigen::Vector3f& p : {Eigen::Vector3f(0, 0, 0), {1, 0, 0}, {0, 1, 0}}) {
      point.position_m = p + Eigen::Vector3f(3.0F * static_cast<float>(i), 0, 0);
      mesh.points.push_back(point);
    }
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  mesh.points[3].distance_class = kNeverMeasured;  // A third of the second.
  const CoverageByReason coverage = CoverageOf(mesh);
  EXPECT_NEAR(coverage.total_m2, 1.0, 1e-6);
  EXPECT_NEAR(coverage.good_m2, 0.5, 1e-6);
  EXPECT_NEAR(coverage.bad_m2, 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(coverage.never_m2, 1.0 / 6.0, 1e-6);
  EXPECT_NEAR(coverage.distance_m2, 1.0 / 3.0, 1e-6);
  EXPECT_NEAR(coverage.angle_m2, 1.0 / 3.0, 1e-6);
  inputs_.coverage = coverage;
  EXPECT_THAT(MakeReport(inputs_).html, HasSubstr("16.7 %"));
}

TEST_F(ReportTest, ItClaimsNoConformityAndNamesFilesAndSoftware) {
  inputs_.hashes = {{"model.iso", "abc123"}};
  const std::string html = MakeReport(inputs_).html;
  EXPECT_THAT(html, HasSubstr("structured after ISO 18434-1"));
  EXPECT_THAT(html, HasSubstr("claims no conformity"));
  EXPECT_THAT(html, HasSubstr("abc123"));
  EXPECT_THAT(html, HasSubstr("isotherm 1"));
}

TEST_F(ReportTest, AnObjectThatCouldNotBeMeasuredSaysWhy) {
  Add("gone", measuring::Shape::SPOT).set_problem("point 1 is not on the surface");
  EXPECT_THAT(MakeReport(inputs_).html, HasSubstr("point 1 is not on the surface"));
}

}  // namespace
}  // namespace isotherm
