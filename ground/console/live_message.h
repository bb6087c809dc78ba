#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <memory>
#include <string>

#include "ground/console/group_key.h"

namespace isotherm {

/// Says what a message shows. A newer message of the same kind (and group) replaces an older one
/// that was not sent.
enum class LiveKind : std::uint8_t {
  // In the order in which they are sent.
  kScan,
  kMaps,
  kMeasurements,
  kPlayback,
  kPose,
  kGuidance,
  kState,
  kGroup,
  kDetails,
  kPath,
  kDepthImage,
  kThermalImage,
  kRawDepth,  ///< A foxglove.RawImage, for /foxglove only, as the next.
  kRawThermal,
};

/// The place of a message among those that a client still has to get.
struct LiveSlot {
  LiveKind kind = LiveKind::kState;
  GroupKey group;  ///< For kGroup and kDetails.

  // clang-tidy 14 sees a null pointer in it. NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const LiveSlot&, const LiveSlot&) = default;
};

/// A message as all clients get it: made once, shared.
struct LiveMessage {
  LiveSlot slot;
  std::uint64_t model = 0;    ///< For kScan: a new one voids everything sent before.
  std::uint32_t version = 0;  ///< For kGroup and kDetails.
  /// For kGroup and kDetails, metres: what is near is sent first.
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  std::uint64_t time_ns = 0;  ///< For kRawDepth and kRawThermal: capture time.
  bool is_kept = true;        ///< Who comes later gets it, too.
  std::string bytes;          ///< A ServerMessage.
};
using LiveMessagePtr = std::shared_ptr<const LiveMessage>;

}  // namespace isotherm
