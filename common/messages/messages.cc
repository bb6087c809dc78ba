#include "common/messages/messages.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"

namespace isotherm {
namespace {

std::string_view NameOf(Role role) { return role == Role::kEdge ? "edge" : "ground"; }

std::string Describe(const Hello& hello) {
  return fmt::format("the {} on {} (version {}) speaks wire {}.{}", NameOf(hello.role),
                     hello.host.empty() ? "an unnamed computer" : hello.host,
                     hello.software_version.empty() ? "unknown" : hello.software_version,
                     hello.wire_major, hello.wire_minor);
}

}  // namespace

std::string_view ToString(TrackingState state) {
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

std::string_view ToString(Advice advice) {
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
      return "wait for NUC";
    case Advice::kGoBackToRelocalise:
      return "go back";
    case Advice::kDone:
      return "done";
  }
  return "?";
}

std::string ModeText(const StreamMode& mode) {
  return fmt::format("{}x{}@{:g}", mode.width, mode.height, mode.rate_hz);
}

std::string_view ToString(NucPolicy policy) {
  switch (policy) {
    case NucPolicy::kAutomatic:
      return "automatic";
    case NucPolicy::kManual:
      return "manual";
    case NucPolicy::kCamera:
      return "camera";
  }
  return "?";
}

std::string_view ToString(NucState state) {
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

std::string_view ToString(NucSource source) {
  switch (source) {
    case NucSource::kUnknown:
      return "nothing";
    case NucSource::kInBand:
      return "its frames";
    case NucSource::kPolled:
      return "asking the camera";
    case NucSource::kCommanded:
      return "our order alone";
    case NucSource::kInferred:
      return "its images";
  }
  return "?";
}

ClockReport ToReport(const KernelClock& clock) {
  return {.synchronised = clock.synchronised,
          .offset_s = clock.offset_s,
          .estimated_error_s = clock.estimated_error_s,
          .max_error_s = clock.max_error_s};
}

std::string ToText(const ClockReport& clock) {
  std::string text = "not synchronised";
  if (clock.synchronised) {
    text = "synchronised";
    if (!std::isnan(clock.estimated_error_s)) {
      text += fmt::format(", off by about {:.2f} ms", kMsPerS * clock.estimated_error_s);
    }
    if (!std::isnan(clock.max_error_s)) {
      text += fmt::format(", at most {:.1f} ms", kMsPerS * clock.max_error_s);
    }
  }
  if (clock.steps > 0) {
    // Signed: capture times do not follow such steps, so this is what UTC differs by.
    text += fmt::format(", set {} time{} by {:+.3f} s in all", clock.steps,
                        clock.steps == 1 ? "" : "s", clock.step_sum_s);
  }
  return text;
}

std::string StampText(const CameraReport& depth, const CameraReport& thermal) {
  std::string text;
  const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  // 0 stands for not estimated yet.
  if (depth.stamp_sigma_s > 0.0)
    add(fmt::format("+-{:.3f} ms depth", kMsPerS * depth.stamp_sigma_s));
  if (thermal.stamp_sigma_s > 0.0) {
    add(fmt::format("+-{:.3f} ms thermal", kMsPerS * thermal.stamp_sigma_s));
  }
  if (depth.unsynchronised_frames + thermal.unsynchronised_frames > 0) {
    add(fmt::format("UNSYNCHRONISED frames {} depth, {} thermal", depth.unsynchronised_frames,
                    thermal.unsynchronised_frames));
  }
  return text;
}

Status CheckCompatible(const Hello& own, const Hello& peer) {
  if (own.wire_major == peer.wire_major) return OkStatus();
  // The older side is the one to be updated, whichever of them says this.
  const Hello& old = own.wire_major < peer.wire_major ? own : peer;
  return FailedPrecondition(
      fmt::format("{}, {}: update the {}", Describe(own), Describe(peer), NameOf(old.role)));
}

}  // namespace isotherm
