#include "ground/cli/refinement_text.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

namespace isotherm {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
// Half a pixel is what the fusion takes as a registration error; and what is wrong alike in the
// whole scan, as delays in DelayCheck.
constexpr double kMaxShift_px = 0.5;
constexpr double kMaxSigmaToAgree_px = 1.0;
constexpr double kSigmas = 3.0;
constexpr int kGap_px = 8;

/// One value of a calibration, as it is shown.
struct ShownValue {
  std::string name;
  std::string unit;
  double before = 0.0, after = 0.0, sigma = 0.0;
  bool is_told = false;
};

std::vector<ShownValue> ShownValues(const RecordingRefinement& refined) {
  const Refinement& r = refined.refinement;
  const auto rotation_deg = [](const RigidTransform& pose) -> Eigen::Vector3d {
    const Eigen::AngleAxisd rotation(pose.linear());
    return kDegrees * rotation.angle() * rotation.axis();
  };
  const Eigen::Vector3d turn_before = rotation_deg(r.before.T_thermal_depth);
  const Eigen::Vector3d turn_after = rotation_deg(r.after.T_thermal_depth);
  std::vector<ShownValue> values;
  const auto add = [&](PlacementParameter parameter, const std::string& name,
                       const std::string& unit, double scale, double before, double after) {
    values.push_back({name, unit, before, after, scale * r.Sigma(parameter), r.Tells(parameter)});
  };
  const std::array<const char*, 3> axes = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    add(static_cast<PlacementParameter>(kRotationX + i),
        fmt::format("rotation {}", axes[static_cast<std::size_t>(i)]), "degrees", kDegrees,
        turn_before[i], turn_after[i]);
  }
  for (int i = 0; i < 3; ++i) {
    add(static_cast<PlacementParameter>(kTranslationX + i),
        fmt::format("translation {}", axes[static_cast<std::size_t>(i)]), "mm", 1e3,
        1e3 * r.before.T_thermal_depth.translation()[i],
        1e3 * r.after.T_thermal_depth.translation()[i]);
  }
  add(kDelay, "delay", "ms", 1e3, 1e3 * refined.DelayBefore(), 1e3 * refined.DelayAfter());
  add(kPrincipalX, "principal point x", "px", 1.0, r.before.camera.cx, r.after.camera.cx);
  add(kPrincipalY, "principal point y", "px", 1.0, r.before.camera.cy, r.after.camera.cy);
  return values;
}

}  // namespace

RefinementVerdict Assess(const RecordingRefinement& refined, double max_shift_s) {
  const Refinement& r = refined.refinement;
  RefinementVerdict verdict;
  if (r.shift.rms_px > std::max(kMaxShift_px, kSigmas * r.shift.sigma_px)) {
    verdict.geometry = r.improves_held_out ? DelayVerdict::kMoved : DelayVerdict::kNotAssessed;
  } else if (r.shift.sigma_px <= kMaxSigmaToAgree_px) {
    verdict.geometry = DelayVerdict::kAgrees;
  }
  verdict.delay =
      Assess({.delay_s = r.correction[kDelay], .sigma_s = r.Sigma(kDelay)}, max_shift_s);
  if (verdict.delay == DelayVerdict::kMoved && !r.improves_held_out)
    verdict.delay = DelayVerdict::kNotAssessed;
  return verdict;
}

std::string RefinementText(const RecordingRefinement& refined) {
  const Refinement& r = refined.refinement;
  std::string text = fmt::format("{:<18}{:>10}{:>10}{:>10}{:>14}\n", "", "before", "after",
                                 "change", "uncertain by");
  for (const ShownValue& value : ShownValues(refined)) {
    text += fmt::format("{:<18}{:>10.3f}{:>10.3f}{:>+10.3f}{:>14.3f} {}{}\n", value.name,
                        value.before, value.after, value.after - value.before, value.sigma,
                        value.unit, value.is_told ? "" : "   (this scan cannot tell)");
  }
  text += fmt::format(
      "points of the surface land {:.2f} px elsewhere in the thermal image (uncertain by {:.2f} "
      "px)\n"
      "images that were held out differ from the others by {:.3f} K after, {:.3f} K before\n"
      "from {} thermal frames and {} of {} points, where temperatures change along the surface; {} "
      "of {} directions told\n",
      r.shift.rms_px, r.shift.sigma_px, r.held_out_after_k, r.held_out_before_k, r.frames,
      r.textured_points, r.points, r.observed_directions, kPlacementParameters);
  return text;
}

std::string CheckText(const RecordingRefinement& refined, const RefinementVerdict& verdict) {
  const Refinement& r = refined.refinement;
  const auto line = [](const char* name, DelayVerdict part, const std::string& figures) {
    const char* word = part == DelayVerdict::kMoved    ? "moved by"
                       : part == DelayVerdict::kAgrees ? "ok, within"
                                                       : "cannot tell here:";
    return fmt::format("{:<10}{} {}\n", name, word, figures);
  };
  return line("pose", verdict.geometry,
              fmt::format("{:.2f} px in the thermal image, uncertain by {:.2f} px", r.shift.rms_px,
                          r.shift.sigma_px)) +
         line("delay", verdict.delay,
              fmt::format("{:+.1f} ms, uncertain by {:.1f} ms", 1e3 * r.correction[kDelay],
                          1e3 * r.Sigma(kDelay)));
}

nlohmann::json RefinementJson(const RecordingRefinement& refined,
                              const RefinementVerdict& verdict) {
  const Refinement& r = refined.refinement;
  nlohmann::json json;
  for (const ShownValue& value : ShownValues(refined)) {
    json["values"].push_back({{"name", value.name},
                              {"unit", value.unit},
                              {"before", value.before},
                              {"after", value.after},
                              {"sigma", value.sigma},
                              {"told_by_this_scan", value.is_told}});
  }
  json["geometry"] = ToString(verdict.geometry);
  json["delay"] = ToString(verdict.delay);
  json["shift_px"] = r.shift.rms_px;
  json["shift_sigma_px"] = r.shift.sigma_px;
  json["held_out_before_k"] = r.held_out_before_k;
  json["held_out_after_k"] = r.held_out_after_k;
  json["thermal_frames"] = r.frames;
  json["points"] = r.points;
  json["points_with_texture"] = r.textured_points;
  json["directions_told"] = r.observed_directions;
  json["covariance_of"] = kPlacementParameterNames;
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
