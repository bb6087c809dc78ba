#include "ground/measuring/shape_measurer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "ground/measuring/area_outline.h"
#include "ground/mesh/face_measurement.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// A profile has no more points than a screen has columns.
constexpr int kMaxProfilePoints = 2000;
/// Rays of a profile begin this far in front of the straight line between its ends.
constexpr double kProfileReach_m = 0.05;

Eigen::Vector3d ToEigen(const measuring::Vector3& v) { return {v.x(), v.y(), v.z()}; }

/// The value that a difference takes of a shape, and its standard uncertainty.
struct ShapeValue {
  double celsius = NAN;
  double sigma_k = NAN;
};
ShapeValue ValueOf(const measuring::MeasuredShape& measured) {
  if (measured.has_object()) {
    return {measured.object().mean_celsius(),
            measured.object().has_sigma_k() ? measured.object().sigma_k() : NAN};
  }
  if (!measured.has_record() || !measured.record().has_object_celsius()) return {};
  return {measured.record().object_celsius(),
          measured.record().has_object_sigma_k() ? measured.record().object_sigma_k() : NAN};
}

void SetAlarm(const measuring::Shape& shape, measuring::MeasuredShape& measured) {
  double highest = NAN, lowest = NAN;
  if (measured.has_object()) {
    highest = measured.object().max_celsius();
    lowest = measured.object().min_celsius();
  } else if (measured.has_record() && measured.record().has_object_celsius()) {
    highest = lowest = measured.record().object_celsius();
  } else if (measured.has_difference_k()) {
    highest = lowest = measured.difference_k();
  }
  if (shape.has_alarm_above_celsius() && highest > shape.alarm_above_celsius())
    measured.set_alarm("above");
  if (shape.has_alarm_below_celsius() && lowest < shape.alarm_below_celsius())
    measured.set_alarm("below");
}

void SetDifference(const measuring::Shape& shape,
                   const std::map<std::string, const measuring::MeasuredShape*>& by_id,
                   measuring::MeasuredShape& measured) {
  const auto first = by_id.find(shape.first());
  const auto second = by_id.find(shape.second());
  if (first == by_id.end() || second == by_id.end()) {
    measured.set_problem("one of the two objects does not exist any more");
    return;
  }
  const ShapeValue a = ValueOf(*first->second), b = ValueOf(*second->second);
  if (std::isnan(a.celsius) || std::isnan(b.celsius)) {
    measured.set_problem("one of the two objects has no temperature");
    return;
  }
  measured.set_difference_k(a.celsius - b.celsius);
  if (!std::isnan(a.sigma_k) && !std::isnan(b.sigma_k))
    measured.set_difference_sigma_k(std::hypot(a.sigma_k, b.sigma_k));
}

}  // namespace

MeasuringOptions MakeMeasuringOptions(const GroundOptions& options,
                                      const ThermalSensorModel& sensor) {
  MeasuringOptions measuring;
  measuring.surface.min_weight = static_cast<float>(options.export_().expert().min_weight());
  measuring.limits.limits = CompleteLimits(options.thermal(), sensor);
  measuring.interpretation = options.interpretation();
  return measuring;
}

ShapeMeasurer::ShapeMeasurer(const TsdfVolume& tsdf, const ThermalVolume& thermal,
                             const RigidTransform& T_world_model, const MeasuringOptions& options)
    : probe_(tsdf, thermal, options.surface),
      T_world_model_(T_world_model),
      T_model_world_(T_world_model.inverse()),
      options_(options),
      temperatures_(options.interpretation) {}

std::optional<ProbeHit> ShapeMeasurer::Find(const measuring::Anchor& anchor) {
  return probe_.Cast({.origin = T_model_world_ * ToEigen(anchor.origin()),
                      .direction = T_model_world_.linear() * ToEigen(anchor.direction())},
                     kAnchorReach_m);
}

measuring::Vector3 ShapeMeasurer::InWorld(const Eigen::Vector3d& p_model) const {
  const Eigen::Vector3d p = T_world_model_ * p_model;
  measuring::Vector3 message;
  message.set_x(p.x());
  message.set_y(p.y());
  message.set_z(p.z());
  return message;
}

void ShapeMeasurer::ToWorld(measuring::Statistics& statistics) const {
  *statistics.mutable_hottest() = InWorld(ToEigen(statistics.hottest()));
  *statistics.mutable_coldest() = InWorld(ToEigen(statistics.coldest()));
}

measuring::VoxelRecord ShapeMeasurer::RecordOf(const ProbeHit& hit,
                                               const Interpretation& interpretation) {
  measuring::VoxelRecord record =
      RecordAt(probe_.tsdf(), probe_.thermal(), hit, interpretation, options_.limits);
  *record.mutable_point() = InWorld(hit.point);
  *record.mutable_normal() = ToMessage(T_world_model_.linear().cast<float>() * hit.normal);
  return record;
}

measuring::VoxelRecord ShapeMeasurer::Pick(const measuring::Anchor& ray,
                                           const measuring::ObjectParameters& parameters) {
  const auto interpretation = temperatures_.For(temperatures_.Complete(parameters));
  const std::optional<ProbeHit> hit = Find(ray);
  if (!hit || !interpretation) return {};
  return RecordOf(*hit, **interpretation);
}

std::vector<measuring::MeasuredShape> ShapeMeasurer::Measure(const measuring::ShapeList& shapes) {
  std::vector<measuring::MeasuredShape> all;
  all.reserve(static_cast<std::size_t>(shapes.shapes_size()));
  for (const measuring::Shape& shape : shapes.shapes()) all.push_back(MeasureOne(shape));
  std::map<std::string, const measuring::MeasuredShape*> by_id;
  for (const measuring::MeasuredShape& measured : all) by_id[measured.id()] = &measured;
  for (int i = 0; i < shapes.shapes_size(); ++i) {
    measuring::MeasuredShape& measured = all[static_cast<std::size_t>(i)];
    if (shapes.shapes(i).kind() == measuring::Shape::DIFFERENCE)
      SetDifference(shapes.shapes(i), by_id, measured);
    SetAlarm(shapes.shapes(i), measured);
  }
  return all;
}

measuring::MeasuredShape ShapeMeasurer::MeasureOne(const measuring::Shape& shape) {
  measuring::MeasuredShape measured;
  measured.set_id(shape.id());
  if (const Status valid = Validate(shape); !valid.ok()) {
    measured.set_problem(valid.message());
    return measured;
  }
  const auto interpretation = temperatures_.For(temperatures_.Complete(shape.parameters()));
  if (!interpretation) {
    measured.set_problem(interpretation.error().message());
    return measured;
  }
  switch (shape.kind()) {
    case measuring::Shape::SPOT:
    case measuring::Shape::NOTE:
      MeasurePlace(shape, **interpretation, measured);
      break;
    case measuring::Shape::LINE:
      MeasureLine(shape, **interpretation, measured);
      break;
    case measuring::Shape::AREA:
      MeasureArea(shape, **interpretation, measured);
      break;
    case measuring::Shape::DISTANCE:
      MeasureDistance(shape, measured);
      break;
    default:
      break;  // A difference follows when all are measured.
  }
  return measured;
}

std::optional<std::vector<ProbeHit>> ShapeMeasurer::FindAll(const measuring::Shape& shape,
                                                            std::size_t at_least,
                                                            measuring::MeasuredShape& measured) {
  std::vector<ProbeHit> hits;
  for (const measuring::Anchor& anchor : shape.anchors()) {
    const std::optional<ProbeHit> hit = Find(anchor);
    if (!hit) {
      measured.set_problem(fmt::format("point {} is not on the surface", hits.size() + 1));
      return std::nullopt;
    }
    hits.push_back(*hit);
    *measured.add_corners() = InWorld(hit->point);
  }
  if (hits.size() >= at_least) return hits;
  measured.set_problem("too few points");
  return std::nullopt;
}

void ShapeMeasurer::MeasurePlace(const measuring::Shape& shape,
                                 const Interpretation& interpretation,
                                 measuring::MeasuredShape& measured) {
  const auto hits = FindAll(shape, 1, measured);
  if (hits) *measured.mutable_record() = RecordOf(hits->front(), interpretation);
}

void ShapeMeasurer::MeasureDistance(const measuring::Shape& shape,
                                    measuring::MeasuredShape& measured) {
  const auto hits = FindAll(shape, 2, measured);
  if (hits) measured.set_length_m(((*hits)[1].point - (*hits)[0].point).norm());
}

void ShapeMeasurer::MeasureLine(const measuring::Shape& shape, const Interpretation& interpretation,
                                measuring::MeasuredShape& measured) {
  const auto hits = FindAll(shape, 2, measured);
  if (!hits) return;
  const Eigen::Vector3d& from = (*hits)[0].point;
  const Eigen::Vector3d& to = (*hits)[1].point;
  const auto direction_of = [&](int i) -> Eigen::Vector3d {
    return (T_model_world_.linear() * ToEigen(shape.anchors(i).direction())).normalized();
  };
  const Eigen::Vector3d first = direction_of(0), second = direction_of(1);
  const double length = (to - from).norm();
  const int steps =
      std::clamp(static_cast<int>(std::ceil(length / probe_.tsdf().grid().voxel_size_m)), 1,
                 kMaxProfilePoints - 1);
  SurfaceSum sum(interpretation, temperatures_.Complete(shape.parameters()));
  std::optional<Eigen::Vector3d> before;
  double along = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) / steps;
    const Eigen::Vector3d towards = ((1.0 - t) * first + t * second).normalized();
    const Eigen::Vector3d on_line = from + t * (to - from);
    const auto hit =
        probe_.Cast({on_line - kProfileReach_m * towards, towards}, 2.0 * kProfileReach_m);
    if (!hit) continue;  // A gap in the surface.
    if (before) along += (hit->point - *before).norm();
    before = hit->point;
    const measuring::VoxelRecord record = RecordOf(*hit, interpretation);
    measuring::ProfilePoint& point = *measured.add_profile();
    point.set_along_m(along);
    *point.mutable_point() = record.point();
    point.set_quality(record.quality());
    if (record.has_apparent_celsius()) point.set_apparent_celsius(record.apparent_celsius());
    if (record.has_object_celsius()) point.set_object_celsius(record.object_celsius());
    if (record.has_object_sigma_k()) point.set_object_sigma_k(record.object_sigma_k());
    sum.Add(MeasuredPoint(probe_.tsdf(), probe_.thermal(), hit->point, hit->normal), 1.0);
  }
  measured.set_length_m(length);
  measured.set_surface_length_m(along);
  *measured.mutable_quality() = sum.quality();
  SetStatistics(sum, measured);
}

void ShapeMeasurer::MeasureArea(const measuring::Shape& shape, const Interpretation& interpretation,
                                measuring::MeasuredShape& measured) {
  const auto hits = FindAll(shape, 3, measured);
  if (!hits) return;
  std::vector<Eigen::Vector3d> corners;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < hits->size(); ++i) {
    corners.push_back((*hits)[i].point);
    direction += (T_model_world_.linear() * ToEigen(shape.anchors(static_cast<int>(i)).direction()))
                     .normalized();
  }
  if (direction.isZero(1e-9)) {
    measured.set_problem("its points were set from opposite sides");
    return;
  }
  SurfaceSum sum(interpretation, temperatures_.Complete(shape.parameters()));
  for (const AreaPiece& piece : AreaOutline(corners, direction).Pieces(probe_))
    sum.Add(*piece.point, piece.area_m2);
  measured.set_area_m2(sum.total());
  *measured.mutable_quality() = sum.quality();
  *measured.mutable_heat_flow() = sum.heat_flow();
  SetStatistics(sum, measured);
}

void ShapeMeasurer::SetStatistics(const SurfaceSum& sum, measuring::MeasuredShape& measured) const {
  if (auto object = sum.object()) {
    *measured.mutable_object() = *std::move(object);
    ToWorld(*measured.mutable_object());
  }
  if (auto apparent = sum.apparent()) {
    *measured.mutable_apparent() = *std::move(apparent);
    ToWorld(*measured.mutable_apparent());
  }
}

}  // namespace isotherm
