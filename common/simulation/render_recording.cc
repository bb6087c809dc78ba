#include "common/simulation/render_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "common/codec/codec.h"
#include "common/options/text_proto.h"
#include "common/recording/recording.h"
#include "common/simulation/options.h"
#include "common/simulation/simulated_odometry.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSession = 1;

/// One thing to write, in the order of true time.
struct ScheduledMessage {
  enum class Kind { kNuc, kOdometry, kDepth, kThermal };  // Order at equal times.
  CaptureTime time;
  Kind kind;
  std::uint64_t number;
};

std::vector<ScheduledMessage> InOrderOfTime(const SimulatedScan& scan,
                                            const std::vector<ExternalOdometry>& odometry) {
  std::vector<ScheduledMessage> items;
  for (std::size_t i = 0; i < odometry.size(); ++i)
    items.push_back({odometry[i].time, ScheduledMessage::Kind::kOdometry, i});
  for (std::size_t i = 0; i < scan.nuc_events().size(); ++i) {
    items.push_back({scan.nuc_events()[i].start, ScheduledMessage::Kind::kNuc, i});
  }
  for (std::size_t i = 0; i < scan.depth_times().size(); ++i) {
    items.push_back({scan.depth_times()[i].exposure, ScheduledMessage::Kind::kDepth, i});
  }
  for (std::size_t i = 0; i < scan.thermal_times().size(); ++i) {
    items.push_back({scan.thermal_times()[i].exposure, ScheduledMessage::Kind::kThermal, i});
  }
  std::sort(items.begin(), items.end(), [](const ScheduledMessage& a, const ScheduledMessage& b) {
    return std::tie(a.time, a.kind, a.number) < std::tie(b.time, b.kind, b.number);
  });
  return items;
}

FrameHeader MakeHeader(std::uint64_t number, const SimulatedFrameTime& time) {
  FrameHeader header;
  header.session = kSession;
  header.frame_number = number;
  header.device_ticks = time.device_ticks;
  header.capture_time = time.exposure;
  return header;
}

/// Renders and encodes one item at a time; each thread's work has its own.
struct Worker {
  SimulatedScan::Scratch scratch;
  DepthEncoder depth_encoder;
  ThermalEncoder thermal_encoder;
  EncodedDepthFrame depth;
  EncodedThermalFrame thermal;

  void Render(const SimulatedScan& scan, const ScheduledMessage& item) {
    if (item.kind == ScheduledMessage::Kind::kDepth) RenderDepth(scan, item.number);
    if (item.kind == ScheduledMessage::Kind::kThermal) RenderThermal(scan, item.number);
  }

  void RenderDepth(const SimulatedScan& scan, std::uint64_t number) {
    const RawFrame raw = scan.RenderDepth(number, scratch);
    depth.header = MakeHeader(number, scan.depth_times()[number]);
    depth.depth_scale = raw.depth_scale;
    depth.image = depth_encoder.Encode(raw.pixels);
  }

  void RenderThermal(const SimulatedScan& scan, std::uint64_t number) {
    const RawFrame raw = scan.RenderThermal(number, scratch);
    thermal.header = MakeHeader(number, scan.thermal_times()[number]);
    thermal.housekeeping = raw.housekeeping;
    thermal.nuc_state = raw.shutter_closed ? NucState::kInProgress : NucState::kIdle;
    thermal.nuc_source = NucSource::kInBand;
    thermal.valid = !raw.shutter_closed;
    const CaptureTime time = thermal.header.capture_time;
    const std::optional<CaptureTime> opening = scan.LastOpening(time);
    // The worker's frame is used again.
    thermal.seconds_since_nuc.reset();
    if (opening) thermal.seconds_since_nuc = ToSeconds(time - *opening);
    thermal.scale = raw.thermal_scale;
    thermal.image = thermal_encoder.Encode(raw.pixels, raw.thermal_scale);
  }
};

Status WriteMessage(const SimulatedScan& scan, const std::vector<ExternalOdometry>& odometry,
                    const ScheduledMessage& item, const Worker& worker, RecordingWriter& writer) {
  switch (item.kind) {
    case ScheduledMessage::Kind::kNuc:
      return writer.Write(scan.nuc_events()[item.number]);
    case ScheduledMessage::Kind::kOdometry:
      return writer.Write(odometry[item.number]);
    case ScheduledMessage::Kind::kDepth:
      ISOTHERM_RETURN_IF_ERROR(
          writer.WritePose("groundtruth", {item.time, scan.PoseAt(item.time)}));
      return writer.Write(worker.depth, scan.depth_times()[item.number].arrival);
    case ScheduledMessage::Kind::kThermal:
      break;
  }
  return writer.Write(worker.thermal, scan.thermal_times()[item.number].arrival);
}

/// Returns what a calibration of the camera's constant delay would find: added to filtered
/// arrivals, it gives the exposure. The edge stamps by the frames that were held up least.
std::string KnownDelay(const ClockOptions& clock) {
  return fmt::format("{:.6f}", -clock.delay_s());
}

Status WriteStart(const SimulationOptions& options, const SimulatedScan& scan,
                  RecordingWriter& writer) {
  ISOTHERM_RETURN_IF_ERROR(
      writer.WriteMetadata("simulation", {{"scene", scan.scene().name()},
                                          {"seed", std::to_string(options.seed())},
                                          {"version", ISOTHERM_VERSION},
                                          {"options", ToTextProto(Resolved(options))}}));
  const SimulationOptions resolved = Resolved(options);
  ISOTHERM_RETURN_IF_ERROR(
      writer.WriteMetadata("timing", {{"depth_delay_s", KnownDelay(resolved.depth_clock())},
                                      {"thermal_delay_s", KnownDelay(resolved.thermal_clock())}}));
  return writer.Write(scan.rig());
}

}  // namespace

Status RenderRecording(const SimulationOptions& options, const std::filesystem::path& path,
                       ThreadPool& pool, const SimulationProgress& progress, std::stop_token stop,
                       ImageStorage storage) {
  const Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(options);
  if (!scan) return scan.error();
  RecordingOptions recording_options;
  recording_options.image_storage = storage;
  recording_options.sync = false;  // Can be rendered again.
  Result<std::unique_ptr<RecordingWriter>> writer =
      RecordingWriter::Create(path, recording_options);
  if (!writer) return writer.error();
  ISOTHERM_RETURN_IF_ERROR(WriteStart(options, **scan, **writer));

  // Threads render whole frames; a batch is written in order when all of it is done.
  constexpr int kFramesPerThread = 6;
  std::vector<Worker> workers(static_cast<std::size_t>(pool.threads() * kFramesPerThread));
  const std::vector<ExternalOdometry> odometry =
      SimulateOdometry(options.odometry(), **scan, options.seed());
  const std::vector<ScheduledMessage> items = InOrderOfTime(**scan, odometry);
  for (std::size_t done = 0; done < items.size();) {
    if (stop.stop_requested()) return Unavailable("rendering the simulated scan was interrupted");
    const std::size_t count = std::min(workers.size(), items.size() - done);
    pool.ParallelFor(static_cast<int>(count), [&](int i) {
      const auto index = static_cast<std::size_t>(i);
      workers[index].Render(**scan, items[done + index]);
    });
    for (std::size_t i = 0; i < count; ++i) {
      ISOTHERM_RETURN_IF_ERROR(
          WriteMessage(**scan, odometry, items[done + i], workers[i], **writer));
    }
    done += count;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(items.size()));
  }
  return (*writer)->Close();
}

}  // namespace isotherm
