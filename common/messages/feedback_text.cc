#include "common/messages/feedback_text.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

// Nobody holds a rig more exactly than this.
constexpr double kMinMove_m = 0.03;
constexpr double kMinRotation_deg = 5.0;

void Append(const std::string& part, std::string& text) {
  if (!text.empty()) text += ", ";
  text += part;
}

void AppendMove(double metres, const char* positive, const char* negative, std::string& text) {
  if (std::abs(metres) < kMinMove_m) return;
  Append(fmt::format("{:.2f} m {}", std::abs(metres), metres > 0.0 ? positive : negative), text);
}

void AppendRotation(double deg, const char* positive, const char* negative, std::string& text) {
  if (std::abs(deg) < kMinRotation_deg) return;
  Append(fmt::format("turn {:.0f} deg {}", std::abs(deg), deg > 0.0 ? positive : negative), text);
}

/// Returns the advice without its reason; empty if there is none.
std::string AdviceWords(const Feedback& feedback) {
  std::string text;
  for (const Advice advice : feedback.advice) Append(std::string(ToString(advice)), text);
  return text;
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
  AppendRotation(std::atan2(ahead.x(), ahead.z()) / kRadPerDeg, "right", "left", text);
  AppendRotation(std::atan2(ahead.y(), std::hypot(ahead.x(), ahead.z())) / kRadPerDeg, "down", "up",
                 text);
  return text.empty() ? "here" : text;
}

std::string AdviceText(const Feedback& feedback) {
  const std::string text = AdviceWords(feedback);
  if (text.empty()) return feedback.advice_reason.empty() ? "go on" : feedback.advice_reason;
  return feedback.advice_reason.empty() ? text
                                        : fmt::format("{} ({})", text, feedback.advice_reason);
}

std::vector<std::string> FeedbackParts(const Feedback& feedback, std::vector<std::string> urgent) {
  if (feedback.frames_left_out > 0) {
    urgent.push_back(
        fmt::format("ground BEHIND {}: reconstruct its scan.mcap again", feedback.frames_left_out));
  }
  std::vector<std::string> parts = {AdviceText(feedback)};
  if (const std::string words = AdviceWords(feedback); !urgent.empty() && !words.empty()) {
    parts = {words};
    if (!feedback.advice_reason.empty()) urgent.push_back(feedback.advice_reason);
  }
  parts.insert(parts.end(), urgent.begin(), urgent.end());
  std::string& tracking = parts.emplace_back(ToString(feedback.tracking_state));
  if (feedback.pose_covariance) {
    const PoseSigma sigma = LargestSigma(*feedback.pose_covariance);
    tracking += fmt::format(" within {:.1f} mm {:.2f} deg", 1e3 * sigma.translation_m,
                            sigma.rotation_rad / kRadPerDeg);
  }
  if (std::isfinite(feedback.view.good))
    parts.push_back(fmt::format("view {:.0f} % good", 100.0 * feedback.view.good));
  if (std::isfinite(feedback.model.good)) {
    parts.push_back(fmt::format("all {:.0f} % of {:.2f} m2", 100.0 * feedback.model.good,
                                feedback.covered_area_m2));
  }
  if (feedback.T_depth_next) {
    parts.push_back(fmt::format("next view: {}", MoveText(*feedback.T_depth_next)));
  } else if (feedback.tracking_state == TrackingState::kLost && feedback.T_world_depth_next) {
    const Eigen::Vector3d p = feedback.T_world_depth_next->translation();
    const Eigen::Vector3d ahead = feedback.T_world_depth_next->linear().col(2);
    parts.push_back(
        fmt::format("it worked at ({:.2f} {:.2f} {:.2f}) m looking ({:.2f} {:.2f} {:.2f})", p.x(),
                    p.y(), p.z(), ahead.x(), ahead.y(), ahead.z()));
  }
  return parts;
}

std::string FeedbackText(const Feedback& feedback) {
  std::string text;
  for (const std::string& part : FeedbackParts(feedback)) Append(part, text);
  return text;
}

std::string LatencyText(const FeedbackLatency& latency) {
  if (!std::isfinite(latency.p50_s)) return "unknown";
  return fmt::format("p50 {:.0f} ms, p99 {:.0f} ms", 1e3 * latency.p50_s, 1e3 * latency.p99_s);
}

std::optional<std::string> FeedbackReporter::Report(const Feedback& feedback) {
  const bool same = reported_ && reported_->tracking_state == feedback.tracking_state &&
                    reported_->advice == feedback.advice && reported_->done == feedback.done;
  if (same) return std::nullopt;
  reported_ = feedback;
  reported_->image.clear();
  return FeedbackText(feedback);
}

}  // namespace isotherm
