#include "edge/feedback_text.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace isotherm {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

// Nobody holds a rig more exactly than this.
constexpr double kLeastMove_m = 0.03;
constexpr double kLeastTurn_deg = 5.0;

void Append(std::string part, std::string& text) {
  if (!text.empty()) text += ", ";
  text += part;
}

void AppendMove(double metres, const char* positive, const char* negative, std::string& text) {
  if (std::abs(metres) < kLeastMove_m) return;
  Append(fmt::format("{:.2f} m {}", std::abs(metres), metres > 0.0 ? positive : negative), text);
}

void AppendTurn(double deg, const char* positive, const char* negative, std::string& text) {
  if (std::abs(deg) < kLeastTurn_deg) return;
  Append(fmt::format("turn {:.0f} deg {}", std::abs(deg), deg > 0.0 ? positive : negative), text);
}

}  // namespace

std::string MoveText(const RigidTransform& T_depth_next) {
  std::string text;
  // The depth camera's axes: x right, y down, z forward.
  const Eigen::Vector3d t = T_depth_next.translation();
  AppendMove(t.x(), "right", "left", text);
  AppendMove(t.y(), "down", "up", text);
  AppendMove(t.z(), "forward", "back", text);
  const Eigen::Vector3d ahead = T_depth_next.linear().col(2);
  AppendTurn(std::atan2(ahead.x(), ahead.z()) * kDegPerRad, "right", "left", text);
  AppendTurn(std::atan2(ahead.y(), std::hypot(ahead.x(), ahead.z())) * kDegPerRad, "down", "up",
             text);
  return text.empty() ? "here" : text;
}

std::string FeedbackText(const Feedback& feedback) {
  std::string text(ToString(feedback.tracking_state));
  if (feedback.pose_covariance) {
    const PoseSigma sigma = LargestSigma(*feedback.pose_covariance);
    text += fmt::format(" within {:.1f} mm {:.2f} deg", 1e3 * sigma.translation_m,
                        sigma.rotation_rad * kDegPerRad);
  }
  if (std::isfinite(feedback.view.good))
    text += fmt::format(", view {:.0f} % good", 100.0 * feedback.view.good);
  if (std::isfinite(feedback.model.good)) {
    text += fmt::format(", all {:.0f} % of {:.2f} m2", 100.0 * feedback.model.good,
                        feedback.covered_area_m2);
  }
  for (const Advice advice : feedback.advice) text += fmt::format(", {}", ToString(advice));
  if (!feedback.advice_reason.empty()) text += fmt::format(" ({})", feedback.advice_reason);
  if (feedback.T_depth_next)
    text += fmt::format(", next view: {}", MoveText(*feedback.T_depth_next));
  return text;
}

std::string LatencyText(const FeedbackLatency& latency) {
  if (!std::isfinite(latency.p50_s)) return "unknown";
  return fmt::format("p50 {:.0f} ms, p99 {:.0f} ms", 1e3 * latency.p50_s, 1e3 * latency.p99_s);
}

std::optional<std::string> FeedbackNarrator::Tell(const Feedback& feedback) {
  const bool same = told_ && told_->tracking_state == feedback.tracking_state &&
                    told_->advice == feedback.advice && told_->done == feedback.done;
  if (same) return std::nullopt;
  told_ = feedback;
  told_->picture.clear();
  return FeedbackText(feedback);
}

}  // namespace isotherm
