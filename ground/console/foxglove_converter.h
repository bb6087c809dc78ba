#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "ground/console/foxglove_protocol.h"
#include "ground/console/live.pb.h"
#include "ground/console/live_message.h"

namespace isotherm {

/// The channels of /foxglove.
enum class FoxgloveTopic : std::uint32_t {
  kDepth = 1,
  kThermal,
  kDepthCalibration,
  kThermalCalibration,
  kTransforms,
  kPath,
  kCloud,
  kSurface,
  kGuidance,
  kLog,
};

/// All channels with their schemas.
std::vector<FoxgloveChannel> FoxgloveChannels();

/// A message for a channel.
struct FoxgloveData {
  FoxgloveTopic topic = FoxgloveTopic::kLog;
  std::uint64_t time_ns = 0;
  std::string payload;
};

/// Turns what pages get into what Foxglove's viewers understand: a group of the surface into an
/// entity of coloured triangles, and all of them, now and then, into one cloud. Keeps where
/// sub-maps are and what of the cloud is known. Thread-bound to its session.
class FoxgloveConverter {
 public:
  /// The messages for a topic that somebody has subscribed to.
  using Wants = std::function<bool(FoxgloveTopic)>;

  std::vector<FoxgloveData> Convert(const LiveMessage& message, const Wants& wants);
  /// The whole cloud, if it has changed since the last time.
  std::optional<FoxgloveData> TakeCloud();
  std::size_t cloud_bytes() const { return cloud_bytes_; }

 private:
  void Begin(const live::Scan& scan, const Wants& wants, std::vector<FoxgloveData>& data);
  void ConvertGroup(const live::SurfaceGroup& group, const Wants& wants,
                    std::vector<FoxgloveData>& data);
  void ConvertPose(const live::RigPose& pose, std::vector<FoxgloveData>& data) const;
  void ConvertPath(const live::Path& path, std::vector<FoxgloveData>& data) const;
  void ConvertGuidance(const live::Guidance& guidance, const Wants& wants,
                       std::vector<FoxgloveData>& data);

  live::Scan scan_;
  live::Maps maps_;
  std::map<GroupKey, std::string> cloud_;  ///< Points of each group, in the coordinates of its map.
  std::size_t cloud_bytes_ = 0;
  bool is_cloud_new_ = false;
  std::uint64_t time_ns_ = 0;  ///< Capture time of the newest frame.
  std::string told_;
  float coldest_celsius_ = 1e9F, hottest_celsius_ = -1e9F;  ///< For colours.
};

}  // namespace isotherm
