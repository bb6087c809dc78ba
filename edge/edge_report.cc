#include "edge/edge_report.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string_view>

namespace isotherm {
namespace {

std::string_view ToText(NucState state) {
  switch (state) {
    case NucState::kUnknown:
      return "unknown";
    case NucState::kIdle:
      return "idle";
    case NucState::kDesired:
      return "desired";
    case NucState::kImminent:
      return "imminent";
    case NucState::kInProgress:
      return "in progress";
    case NucState::kSettling:
      return "settling";
    case NucState::kBlocked:
      return "blocked";
    case NucState::kError:
      return "error";
  }
  return "?";
}

std::string_view ToText(TrackingState state) {
  switch (state) {
    case TrackingState::kWaiting:
      return "waiting";
    case TrackingState::kTracked:
      return "tracked";
    case TrackingState::kDegraded:
      return "degraded";
    case TrackingState::kLost:
      return "LOST";
  }
  return "?";
}

std::string_view ToText(Advice advice) {
  switch (advice) {
    case Advice::kMoveCloser:
      return "closer";
    case Advice::kMoveFarther:
      return "farther";
    case Advice::kLessOblique:
      return "less oblique";
    case Advice::kMoreOblique:
      return "more oblique";
    case Advice::kSlower:
      return "slower";
    case Advice::kHoldForNuc:
      return "hold for NUC";
    case Advice::kGoBackToRelocalise:
      return "go back to relocalise";
    case Advice::kDone:
      return "done";
  }
  return "?";
}

std::string FeedbackText(const Feedback& feedback) {
  std::string text = fmt::format("{}", ToText(feedback.tracking_state));
  if (feedback.pose_covariance) {
    const PoseSigma sigma = LargestSigma(*feedback.pose_covariance);
    text += fmt::format(" within {:.1f} mm {:.2f} deg", 1e3 * sigma.translation_m,
                        sigma.rotation_rad * 180.0 / std::numbers::pi);
  }
  if (std::isfinite(feedback.model.good)) {
    text += fmt::format(", {:.0f} % measured well", 100.0 * feedback.model.good);
  }
  for (const Advice advice : feedback.advice) text += fmt::format(", {}", ToText(advice));
  return text;
}

std::uint64_t Dropped(const SensorAccount& account) {
  return account.rejected + account.record_queue_full + account.record_failed +
         account.publish_queue_full + account.publish_failed;
}

/// "captured 900 = recorded 890 + rejected 0 + queue full 10 + write failed 0".
std::string Equation(std::string_view done, const SensorAccount& account, std::uint64_t succeeded,
                     std::uint64_t queue_full, std::uint64_t failed, std::int64_t on_the_way) {
  std::string text =
      fmt::format("captured {} = {} {} + rejected {} + queue full {} + failed {}", account.captured,
                  done, succeeded, account.rejected, queue_full, failed);
  if (on_the_way != 0) text += fmt::format(" + unaccounted {}", on_the_way);
  return text;
}

std::string ReceiptText(const StreamReceipt& receipt) {
  return fmt::format("ground received {}, missing {}", receipt.received,
                     receipt.next - receipt.received);
}

}  // namespace

double RateMeter::Update(std::uint64_t count, SteadyTime now) {
  double rate = 0.0;
  if (last_time_ && now > *last_time_) {
    rate = static_cast<double>(count - last_count_) / ToSeconds(now - *last_time_);
  }
  last_time_ = now;
  last_count_ = count;
  return rate;
}

StreamStatus ToStreamStatus(const SensorAccount& account, double rate_hz) {
  StreamStatus status;
  status.captured = account.captured;
  status.published = account.published;
  status.rate_hz = rate_hz;
  status.queue_frames = static_cast<std::uint32_t>(account.OnTheWayToGround());
  status.dropped = {{"rejected", account.rejected},
                    {"queue full", account.publish_queue_full},
                    {"publish failed", account.publish_failed}};
  return status;
}

void AddHostStatus(const HostStatus& host, EdgeStatus& status) {
  status.disk_free_bytes = host.disk_free_bytes;
  status.cpu_temperature_celsius = host.cpu_temperature_celsius;
  status.clock_offset_s = host.clock_offset_s;
  status.clock_error_s = host.clock_error_s;
}

std::string StatusLine(const EdgeStatus& status, const FrameAccount& account, bool ground_present,
                       const std::optional<Feedback>& feedback) {
  const SensorAccount depth = account.Get(Sensor::kDepth);
  const SensorAccount thermal = account.Get(Sensor::kThermal);
  return fmt::format(
      "depth {:.1f}/s  thermal {:.1f}/s  recorded {}  published {}  dropped {}  NUC {}  ground: {}",
      status.depth.rate_hz, status.thermal.rate_hz, depth.recorded + thermal.recorded,
      depth.published + thermal.published, Dropped(depth) + Dropped(thermal),
      ToText(status.nuc_state),
      !ground_present ? "absent"
      : feedback      ? FeedbackText(*feedback)
                      : "no feedback yet");
}

std::string Summary(const FrameAccount& account, bool recording,
                    const std::optional<Receipt>& receipt) {
  std::string text;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const bool is_depth = sensor == Sensor::kDepth;
    const SensorAccount counts = account.Get(sensor);
    const std::string_view name = is_depth ? "depth  " : "thermal";
    if (recording) {
      text += fmt::format("{}  {}\n", name,
                          Equation("recorded", counts, counts.recorded, counts.record_queue_full,
                                   counts.record_failed, counts.OnTheWayToDisk()));
    }
    text += fmt::format("{}  {}\n", name,
                        Equation("published", counts, counts.published, counts.publish_queue_full,
                                 counts.publish_failed, counts.OnTheWayToGround()));
    if (receipt) {
      text +=
          fmt::format("{}  {}\n", name, ReceiptText(is_depth ? receipt->depth : receipt->thermal));
    }
  }
  return text;
}

}  // namespace isotherm
