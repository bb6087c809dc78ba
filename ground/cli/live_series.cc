#include "ground/cli/live_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "common/base/service.h"
#include "common/transport/participant.h"
#include "common/transport/transport_environment.h"
#include "ground/camera_calibration/coach.h"
#include "ground/cli/command.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {
namespace {

/// Each keeps a few images: 200 poses of both cameras are some 800 MB.
constexpr std::size_t kMaxPoses = 200;

/// Keeps the poses of some streams. Belongs to the thread that receives.
class PoseKeeper {
 public:
  PoseKeeper(const CalibrationTarget& target, const std::vector<CalibratedStream>& streams,
             const std::vector<LensKind>& lenses)
      : coach_(target, Names(streams), lenses) {
    for (const CalibratedStream stream : streams) {
      CalibrationStream read;
      read.stream = stream;
      read.target = target;
      streams_.emplace_back(std::move(read));
    }
  }

  /// `make_image` is called only if the stream is wanted.
  void Take(CalibratedStream stream, const FrameHeader& header, const auto& make_image) {
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      if (streams_[i].read.stream != stream) continue;
      const double time_s = ToSeconds(header.capture_time.time_since_epoch());
      Keep(i, streams_[i].finder.Add(time_s, make_image()));
    }
  }

  void Take(const RigDescription& rig) {
    for (Stream& stream : streams_)
      stream.series.serial =
          stream.read.stream == CalibratedStream::kThermal ? rig.thermal.serial : rig.depth.serial;
  }

  bool is_full() const {
    return std::ranges::any_of(streams_,
                               [](const Stream& s) { return s.series.images.size() >= kMaxPoses; });
  }

  Result<std::vector<ImageSeries>> Finish() {
    std::vector<ImageSeries> all;
    for (std::size_t i = 0; i < streams_.size(); ++i) {
      Keep(i, streams_[i].finder.Finish());
      if (streams_[i].series.images.empty()) {
        return Err(FailedPrecondition(fmt::format(
            "no pose was kept of the {} images: hold the target still for a second in each pose, "
            "best on a stand",
            ToString(streams_[i].read.stream))));
      }
      all.push_back(std::move(streams_[i].series));
    }
    return all;
  }

 private:
  struct Stream {
    explicit Stream(CalibrationStream what)
        : read(std::move(what)), finder(StillPosesOf(read.stream)) {
      series.source = "live";
    }

    CalibrationStream read;
    StillPoseFinder finder;
    ImageSeries series;
    int refused = 0;  ///< Poses of which that was said.
  };

  static std::vector<std::string> Names(const std::vector<CalibratedStream>& streams) {
    std::vector<std::string> names;
    for (const CalibratedStream stream : streams) names.emplace_back(ToString(stream));
    return names;
  }

  void Keep(std::size_t index, std::optional<StillPose> pose) {
    if (!pose) return;
    Stream& stream = streams_[index];
    std::string name = fmt::format("pose {}", stream.series.images.size() + 1);
    stream.series.images.push_back(NamedImageOf(std::move(*pose), std::move(name), stream.read));
    coach_.Add(static_cast<int>(index), stream.series.images.back().image);
    const CoachStatus& status = coach_.status()[index];
    std::string line = status.Line();
    if (status.refused > stream.refused) {
      stream.refused = status.refused;
      line += fmt::format(" (this pose does not count: {})", status.last_refusal);
    }
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  CalibrationCoach coach_;
  std::vector<Stream> streams_;
};

}  // namespace

Result<std::vector<ImageSeries>> TakeLiveSeries(const RigAddress& address,
                                                const CalibrationTarget& target,
                                                const std::vector<CalibratedStream>& streams,
                                                const std::vector<LensKind>& lenses) {
  StopSignal signal;  // Before any other thread.
  SubscriberOptions options;
  options.ground_id = "calibrate";
  options.software_version = SoftwareName();
  // It knows what to check if no rig is there, or several are.
  Status found = WithRig(address, [&](RigCommander& rig, const EdgeStatus&) {
    options.edge_id = rig.edge_id();
    return OkStatus();
  });
  if (!found.ok()) return Err(found);
  PoseKeeper poses(target, streams, lenses);
  SubscriberHandlers handlers;
  handlers.thermal = [&](const ReceivedThermal& thermal) {
    if (thermal.frame->valid)
      poses.Take(CalibratedStream::kThermal, thermal.frame->header,
                 [&] { return CalibrationImage(thermal.frame->temperature_raw); });
  };
  handlers.depth = [&](const ReceivedDepth& depth) {
    poses.Take(CalibratedStream::kDepth, depth.frame->header,
               [&] { return CalibrationImage(depth.frame->depth_raw, depth.frame->depth_scale); });
  };
  handlers.rig = [&](const RigDescription& rig) { poses.Take(rig); };
  handlers.turn = [&] {
    if (poses.is_full()) signal.Request();
  };
  handlers.session_end = [&](const SessionCounters&) { signal.Request(); };
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const auto participant = Participant::Create(environment, address.domain);
  if (!participant) return Err(participant.error());
  const auto subscriber = Subscriber::Create(**participant, clock, options, handlers);
  if (!subscriber) return Err(subscriber.error());
  fmt::print(
      "{}: show the target, hold it still for a second in each pose; Ctrl-C when nothing is "
      "missing\n",
      options.edge_id);
  (*subscriber)->Run(signal.token());
  return poses.Finish();
}

}  // namespace isotherm
