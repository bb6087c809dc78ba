#include "ground/measuring/shape_measurer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "ground/measuring/shape_store.h"
#include "ground/measuring/testing/plate.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;
using testing::kPlate_m;
using testing::PlateModel;

void SetVector(double x, double y, double z, measuring::Vector3& v) {
  v.set_x(x);
  v.set_y(y);
  v.set_z(z);
}

/// Straight at the wall.
void AddAnchor(double x, double y, measuring::Shape& shape) {
  measuring::Anchor& anchor = *shape.add_anchors();
  SetVector(x, y, -0.2, *anchor.mutable_origin());
  SetVector(0, 0, 1, *anchor.mutable_direction());
}

measuring::Shape MakeShape(const std::string& id, measuring::Shape::Kind kind) {
  measuring::Shape shape;
  shape.set_id(id);
  shape.set_kind(kind);
  return shape;
}

/// A wall that gets warmer along x: 20 °C at 0, 100 K per metre.
class ShapeMeasurerTest : public ::testing::Test {
 protected:
  ShapeMeasurerTest() {
    model_.AddPlane({0, 0, kPlate_m}, -Eigen::Vector3d::UnitZ());
    model_.Measure(
        [](const Eigen::Vector3d& p) { return static_cast<float>(20.0 + 100.0 * p.x()); });
    options_.limits.limits = GroundOptions().thermal();
    options_.limits.limits.mutable_angle()->set_min_deg(0);
    options_.limits.limits.mutable_angle()->set_good_deg(40);
    options_.limits.limits.mutable_angle()->set_max_deg(50);
  }
  ShapeMeasurer Measurer() {
    return {model_.tsdf, model_.thermal, RigidTransform::Identity(), options_};
  }
  measuring::MeasuredShape Measure(const measuring::Shape& shape) {
    *list_.add_shapes() = shape;
    return Measurer().Measure(list_).back();
  }
  measuring::Shape Square(const std::string& id, double low, double high) {
    measuring::Shape area = MakeShape(id, measuring::Shape::AREA);
    AddAnchor(low, low, area);
    AddAnchor(high, low, area);
    AddAnchor(high, high, area);
    AddAnchor(low, high, area);
    return area;
  }

  /// A temperature is that of the voxel around: half of 4 mm at 100 K/m, and steps of 0.025 K.
  static constexpr double kVoxel_k = 0.23;

  PlateModel model_;
  MeasuringOptions options_;
  measuring::ShapeList list_;
};

TEST_F(ShapeMeasurerTest, ASpotReadsTheVoxelUnderIt) {
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  AddAnchor(0.08, 0.05, spot);
  const measuring::MeasuredShape measured = Measure(spot);
  EXPECT_EQ(measured.problem(), "");
  ASSERT_TRUE(measured.record().hit());
  EXPECT_NEAR(measured.record().apparent_celsius(), 28.0, kVoxel_k);
  EXPECT_EQ(measured.record().object_celsius(), measured.record().apparent_celsius());
  EXPECT_EQ(measured.record().quality(), "good");
  EXPECT_NEAR(measured.record().point().z(), kPlate_m, 1e-4);
  EXPECT_EQ(measured.record().reasons_size(), 0);
}

TEST_F(ShapeMeasurerTest, AShapeHasAnEmissivityOfItsOwn) {
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  AddAnchor(0.15, 0.05, spot);
  spot.mutable_parameters()->set_emissivity(0.5);
  spot.mutable_parameters()->set_reflected_celsius(20.0);
  const measuring::VoxelRecord record = Measure(spot).record();
  const double expected = *TrueCelsius(BandRadiance(), record.apparent_celsius(), 0.5, 20.0);
  EXPECT_NEAR(record.object_celsius(), expected, 1e-3);
  EXPECT_GT(record.object_celsius(), record.apparent_celsius() + 10.0);
}

TEST_F(ShapeMeasurerTest, ALineHasTheProfileOfTheWall) {
  measuring::Shape line = MakeShape("l", measuring::Shape::LINE);
  AddAnchor(0.02, 0.1, line);
  AddAnchor(0.17, 0.1, line);
  const measuring::MeasuredShape measured = Measure(line);
  EXPECT_NEAR(measured.length_m(), 0.15, 1e-4);
  EXPECT_NEAR(measured.surface_length_m(), 0.15, 1e-4);
  ASSERT_GT(measured.profile_size(), 35);
  for (const measuring::ProfilePoint& point : measured.profile()) {
    EXPECT_NEAR(point.along_m(), point.point().x() - 0.02, 1e-4);
    EXPECT_NEAR(point.object_celsius(), 20.0 + 100.0 * point.point().x(), kVoxel_k);
  }
  EXPECT_NEAR(measured.object().mean_celsius(), 29.5, kVoxel_k);
}

TEST_F(ShapeMeasurerTest, AnAreaHasItsSizeItsStatisticsAndItsHeat) {
  model_.Measure([](const Eigen::Vector3d&) { return 80.0F; });
  measuring::Shape area = Square("a", 0.03, 0.15);
  area.mutable_parameters()->set_air_celsius(20.0);
  area.mutable_parameters()->set_film_coefficient_w_m2k(10.0);
  area.mutable_parameters()->set_reflected_celsius(20.0);
  const measuring::MeasuredShape measured = Measure(area);
  EXPECT_EQ(measured.problem(), "");
  EXPECT_NEAR(measured.area_m2() / (0.12 * 0.12), 1.0, 2e-3);
  EXPECT_NEAR(measured.object().mean_celsius(), 80.0, 0.03);
  EXPECT_DOUBLE_EQ(measured.quality().good(), 1.0);
  const double per_m2 = 5.670374419e-8 * (std::pow(353.15, 4) - std::pow(293.15, 4)) + 10.0 * 60.0;
  EXPECT_NEAR(measured.heat_flow().total_w() / (per_m2 * 0.12 * 0.12), 1.0, 5e-3);
}

TEST_F(ShapeMeasurerTest, AHotSpotIsFoundWhereItIs) {
  model_.Measure([](const Eigen::Vector3d& p) {
    return (p.head<2>() - Eigen::Vector2d(0.07, 0.11)).norm() < 0.006 ? 95.0F : 40.0F;
  });
  const measuring::MeasuredShape measured = Measure(Square("a", 0.03, 0.15));
  EXPECT_NEAR(measured.object().max_celsius(), 95.0, 0.03);
  EXPECT_NEAR(measured.object().hottest().x(), 0.07, 0.010);
  EXPECT_NEAR(measured.object().hottest().y(), 0.11, 0.010);
}

TEST_F(ShapeMeasurerTest, HalfAnAreaThatWasNotMeasuredIsSaid) {
  model_.Measure([](const Eigen::Vector3d& p) { return p.x() < 0.09 ? 50.0F : NAN; });
  const measuring::MeasuredShape measured = Measure(Square("a", 0.03, 0.15));
  EXPECT_NEAR(measured.quality().never(), 0.5, 0.04);  // A voxel of 30.
  EXPECT_NEAR(measured.heat_flow().measured_m2() / measured.area_m2(), 0.5, 0.04);
}

TEST_F(ShapeMeasurerTest, ADifferenceIsThatOfTheMeans) {
  *list_.add_shapes() = Square("warm", 0.12, 0.16);
  measuring::Shape spot = MakeShape("cool", measuring::Shape::SPOT);
  AddAnchor(0.04, 0.04, spot);
  *list_.add_shapes() = spot;
  measuring::Shape difference = MakeShape("d", measuring::Shape::DIFFERENCE);
  difference.set_first("warm");
  difference.set_second("cool");
  EXPECT_NEAR(Measure(difference).difference_k(), 34.0 - 24.0, 2.0 * kVoxel_k);
}

TEST_F(ShapeMeasurerTest, ADifferenceToWhatIsGoneSaysSo) {
  measuring::Shape difference = MakeShape("d", measuring::Shape::DIFFERENCE);
  difference.set_first("nobody");
  EXPECT_THAT(Measure(difference).problem(), HasSubstr("does not exist"));
}

TEST_F(ShapeMeasurerTest, ADistanceIsStraight) {
  measuring::Shape distance = MakeShape("d", measuring::Shape::DISTANCE);
  AddAnchor(0.02, 0.02, distance);
  AddAnchor(0.02 + 0.09, 0.02 + 0.12, distance);
  EXPECT_NEAR(Measure(distance).length_m(), 0.15, 1e-4);
}

TEST_F(ShapeMeasurerTest, AlarmsSayAboveAndBelow) {
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  AddAnchor(0.08, 0.05, spot);
  spot.set_alarm_above_celsius(27.0);
  EXPECT_EQ(Measure(spot).alarm(), "above");
  spot.set_alarm_above_celsius(29.0);
  EXPECT_EQ(Measure(spot).alarm(), "");
  spot.set_alarm_below_celsius(28.5);
  EXPECT_EQ(Measure(spot).alarm(), "below");
}

TEST_F(ShapeMeasurerTest, ARuleThatFailedIsNamed) {
  testing::FillThermal(model_.tsdf, model_.thermal, [](const Eigen::Vector3d&) {
    return ThermalVoxel::Make(40.0F, ConditionClass::kBad, ConditionClass::kAcceptable,
                              ConditionClass::kGood);
  });
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  AddAnchor(0.08, 0.05, spot);
  const measuring::VoxelRecord record = Measure(spot).record();
  EXPECT_EQ(record.quality(), "bad");
  ASSERT_EQ(record.reasons_size(), 2);
  EXPECT_THAT(record.reasons(0), HasSubstr("distance bad"));
  EXPECT_THAT(record.reasons(1), HasSubstr("angle acceptable only"));
}

TEST_F(ShapeMeasurerTest, ThePlaceOfTheModelInWorldDoesNotMatter) {
  RigidTransform T_world_model = RigidTransform::Identity();
  T_world_model.translation() << 1.0, -2.0, 0.5;
  T_world_model.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  measuring::Shape area = Square("a", 0.03, 0.15);
  for (measuring::Anchor& anchor : *area.mutable_anchors()) {
    const Eigen::Vector3d p =
        T_world_model *
        Eigen::Vector3d(anchor.origin().x(), anchor.origin().y(), anchor.origin().z());
    const Eigen::Vector3d d = T_world_model.linear() * Eigen::Vector3d::UnitZ();
    SetVector(p.x(), p.y(), p.z(), *anchor.mutable_origin());
    SetVector(d.x(), d.y(), d.z(), *anchor.mutable_direction());
  }
  measuring::ShapeList list;
  *list.add_shapes() = area;
  const auto measured =
      ShapeMeasurer(model_.tsdf, model_.thermal, T_world_model, options_).Measure(list).front();
  EXPECT_NEAR(measured.area_m2() / (0.12 * 0.12), 1.0, 2e-3);
  const Eigen::Vector3d corner = T_world_model * Eigen::Vector3d(0.03, 0.03, kPlate_m);
  EXPECT_NEAR(measured.corners(0).x(), corner.x(), 1e-4);
  EXPECT_NEAR(measured.corners(0).y(), corner.y(), 1e-4);
}

TEST_F(ShapeMeasurerTest, TheSameModelAndShapesGiveTheSameBits) {
  *list_.add_shapes() = Square("a", 0.03, 0.15);
  measuring::Shape line = MakeShape("l", measuring::Shape::LINE);
  AddAnchor(0.02, 0.1, line);
  AddAnchor(0.17, 0.12, line);
  *list_.add_shapes() = line;
  const auto first = Measurer().Measure(list_);
  const auto second = Measurer().Measure(list_);
  for (std::size_t i = 0; i < first.size(); ++i)
    EXPECT_EQ(ExactJson(first[i]), ExactJson(second[i]));
}

TEST_F(ShapeMeasurerTest, APointBesideTheSurfaceIsAProblemInWords) {
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  AddAnchor(0.9, 0.05, spot);
  EXPECT_EQ(Measure(spot).problem(), "point 1 is not on the surface");
}

TEST_F(ShapeMeasurerTest, ShapesThatCannotBeAreRefusedInWords) {
  measuring::Shape spot = MakeShape("s", measuring::Shape::SPOT);
  EXPECT_THAT(Validate(spot).message(), HasSubstr("points"));
  AddAnchor(0.1, 0.1, spot);
  EXPECT_TRUE(Validate(spot).ok());
  spot.mutable_anchors(0)->mutable_direction()->set_z(NAN);
  EXPECT_FALSE(Validate(spot).ok());
  spot.mutable_anchors(0)->mutable_direction()->set_z(1.0);
  spot.mutable_parameters()->set_emissivity(0.0);
  EXPECT_THAT(Validate(spot).message(), HasSubstr("emissivity"));
  spot.mutable_parameters()->set_emissivity(0.9);
  spot.set_id("");
  EXPECT_FALSE(Validate(spot).ok());
}

}  // namespace
}  // namespace isotherm
