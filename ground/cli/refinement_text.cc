#include "ground/cli/refinement_text.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

namespace isotherm {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr int kGap_px = 8;

/// One value of a calibration, as it is shown.
struct ShownValue {
  std::string name;
  std::string unit;
  double before = 0.0, after = 0.0;
  double change = 0.0, sigma = 0.0;  ///< Rotations are about the camera's axes.
  std::string remark;
};

std::vector<ShownValue> ShownValues(const RecordingRefinement& refined) {
  const Refinement& r = refined.refinement;
  std::vector<ShownValue> values;
  const auto add = [&](int parameter, const std::string& name, const std::string& unit,
                       double scale, double before, double after) {
    const auto of = static_cast<PlacementParameter>(parameter);
    values.push_back({name, unit, scale * before, scale * after, scale * r.correction[parameter],
                      scale * r.Sigma(of),
                      r.Keeps(of)    ? "kept"
                      : !r.Tells(of) ? "this scan hardly tells"
                                     : ""});
  };
  const auto rotation = [](const RigidTransform& pose) -> Eigen::Vector3d {
    const Eigen::AngleAxisd turn(pose.linear());
    return turn.angle() * turn.axis();
  };
  const Eigen::Vector3d turn_before = rotation(r.before.T_thermal_depth);
  const Eigen::Vector3d turn_after = rotation(r.after.T_thermal_depth);
  constexpr const char* kAxes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    add(kRotationX + i, fmt::format("rotation {}", kAxes[i]), "degrees", kDegrees, turn_before[i],
        turn_after[i]);
  }
  for (int i = 0; i < 3; ++i) {
    add(kTranslationX + i, fmt::format("translation {}", kAxes[i]), "mm", 1e3,
        r.before.T_thermal_depth.translation()[i], r.after.T_thermal_depth.translation()[i]);
  }
  add(kDelay, "delay", "ms", 1e3, refined.DelayBefore(), refined.DelayAfter());
  add(kPrincipalX, "principal point x", "px", 1.0, r.before.camera.cx, r.after.camera.cx);
  add(kPrincipalY, "principal point y", "px", 1.0, r.before.camera.cy, r.after.camera.cy);
  add(kNearInfluence, "near influence", "%", 100.0, r.before.influence.near_fraction,
      r.after.influence.near_fraction);
  add(kTotalInfluence, "total influence", "%", 100.0, r.before.influence.total_fraction,
      r.after.influence.total_fraction);
  return values;
}

}  // namespace

std::string RefinementText(const RecordingRefinement& refined) {
  const Refinement& r = refined.refinement;
  std::string text = fmt::format("{:<18}{:>10}{:>10}{:>10}{:>14}\n", "", "before", "after",
                                 "change", "uncertain by");
  for (const ShownValue& value : ShownValues(refined)) {
    text += fmt::format("{:<18}{:>10.3f}{:>10.3f}{:>+10.3f}{:>14.3f} {}{}\n", value.name,
                        value.before, value.after, value.change, value.sigma, value.unit,
                        value.remark.empty() ? "" : fmt::format("   ({})", value.remark));
  }
  text += fmt::format(
      "points of the surface land {:.2f} px elsewhere in the thermal image (uncertain by {:.2f} "
      "px), the delay apart\n"
      "images that were held out differ from the others by {:.3f} K after, {:.3f} K before\n"
      "from {} thermal frames and {} of {} points, where temperatures change along the surface; {} "
      "of {} directions told\n",
      r.shift.rms_px, r.shift.sigma_px, r.held_out.after_k, r.held_out.before_k, r.frames,
      r.textured_points, r.points, r.observed_directions, kPlacementParameters);
  return text;
}

std::string CheckText(const RecordingRefinement& refined, const CalibrationVerdict& verdict) {
  const Refinement& r = refined.refinement;
  return fmt::format("{:<10}{}\n{:<10}{}\n{:<10}{}\n{:<10}{}\n", "pose",
                     DescribePose(r, verdict.pose), "delay", DescribeDelay(r, verdict.delay),
                     "influence", DescribeInfluence(r, verdict.influence), "offset",
                     DescribeOffset(r, verdict.offset)) +
         (refined.depth ? fmt::format("{:<10}{}\n", "depth", DescribeDepth(*refined.depth)) : "");
}

Json RefinementJson(const RecordingRefinement& refined, const CalibrationVerdict& verdict) {
  const Refinement& r = refined.refinement;
  Json json;
  json["pose"] = ToString(verdict.pose);
  json["delay"] = ToString(verdict.delay);
  for (const ShownValue& value : ShownValues(refined)) {
    json["values"].push_back(Json{{"name", value.name},
                                  {"unit", value.unit},
                                  {"before", value.before},
                                  {"after", value.after},
                                  {"change", value.change},
                                  {"sigma", value.sigma},
                                  {"remark", value.remark}});
  }
  json["shift_px"] = r.shift.rms_px;
  json["shift_sigma_px"] = r.shift.sigma_px;
  json["held_out_before_k"] = r.held_out.before_k;
  json["held_out_after_k"] = r.held_out.after_k;
  json["influence"] = ToString(verdict.influence);
  json["offset"] = ToString(verdict.offset);
  if (r.epoch_offset) {
    json["offset_k"] = r.epoch_offset->kelvin;
    json["offset_sigma_k"] = r.epoch_offset->sigma_k;
  }
  if (refined.depth) {
    json["depth"] = ToString(refined.depth->verdict);
    json["depth_uneven"] = refined.depth->uneven;
    json["depth_uneven_sigma"] = refined.depth->sigma;
    json["depth_frames"] = refined.depth->frames;
  }
  json["thermal_frames"] = r.frames;
  json["points"] = r.points;
  json["points_with_texture"] = r.textured_points;
  json["directions_told"] = r.observed_directions;
  json["corrections"] = kPlacementParameterNames;
  for (int row = 0; row < kPlacementParameters; ++row) {
    const PlacementVector values = r.covariance.row(row);
    json["covariance"].push_back(std::vector<double>(values.begin(), values.end()));
  }
  return json;
}

Image<float> BeforeAndAfter(const RecordingRefinement& refined) {
  const Image<float>& left = refined.before_celsius;
  const Image<float>& right = refined.after_celsius;
  Image<float> both(left.width() + kGap_px + right.width(), std::max(left.height(), right.height()),
                    NAN);
  for (int y = 0; y < left.height(); ++y)
    std::copy(left.Row(y).begin(), left.Row(y).end(), both.Row(y).begin());
  for (int y = 0; y < right.height(); ++y) {
    std::copy(right.Row(y).begin(), right.Row(y).end(),
              both.Row(y).begin() + left.width() + kGap_px);
  }
  return both;
}

}  // namespace isotherm
