#include "ground/report/report.h"
#include "ground/thermal/measurement_quality.h"

namespace isotherm {
namespace {

bool IsBad(std::uint8_t condition) {
  return condition == static_cast<std::uint8_t>(ConditionClass::kBad);
}

/// Adds a third of a triangle, at one of its corners.
void AddCorner(const CloudPoint& point, double area_m2, CoverageByReason& coverage) {
  coverage.total_m2 += area_m2;
  if (point.distance_class == kNeverMeasured) {
    coverage.never_m2 += area_m2;
    return;
  }
  switch (QualityOf(point.distance_class, point.angle_class, point.motion_class)) {
    case MeasurementQuality::kGood:
      coverage.good_m2 += area_m2;
      break;
    case MeasurementQuality::kAcceptable:
      coverage.acceptable_m2 += area_m2;
      break;
    default:
      coverage.bad_m2 += area_m2;
  }
  if (IsBad(point.distance_class)) coverage.distance_m2 += area_m2;
  if (IsBad(point.angle_class)) coverage.angle_m2 += area_m2;
  if (IsBad(point.motion_class)) coverage.motion_m2 += area_m2;
  if (IsBad(point.disagreement_class)) coverage.disagreement_m2 += area_m2;
}

}  // namespace

CoverageByReason CoverageOf(const Surface& mesh) {
  CoverageByReason coverage;
  for (const Eigen::Vector3i& t : mesh.triangles) {
    const auto corner = [&](int i) -> const CloudPoint& {
      return mesh.points[static_cast<std::size_t>(t[i])];
    };
    const Eigen::Vector3d a = corner(0).position_m.cast<double>();
    const double area_m2 = 0.5 * (corner(1).position_m.cast<double>() - a)
                                     .cross(corner(2).position_m.cast<double>() - a)
                                     .norm();
    for (int i = 0; i < 3; ++i) AddCorner(corner(i), area_m2 / 3.0, coverage);
  }
  return coverage;
}

}  // namespace isotherm
