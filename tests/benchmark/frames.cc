#include "tests/benchmark/frames.h"

#include <utility>
#include <variant>

#include "common/base/check.h"
#include "common/codec/codec.h"
#include "common/dataset/dataset.h"
#include "common/dataset/image_file.h"
#include "common/recording/recording.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr std::size_t kDepthFrames = 24;
constexpr std::size_t kThermalFrames = 32;

BenchmarkFrames Render() {
  const Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(SimulationOptions());
  CHECK(scan.has_value());
  SimulatedScan::Scratch scratch;
  BenchmarkFrames frames;
  frames.rig = (*scan)->rig();
  for (std::size_t i = 0; i < kDepthFrames; ++i) {
    RawFrame raw = (*scan)->RenderDepth(i, scratch);
    DepthFrame& frame = frames.depth.emplace_back();
    frame.header.frame_number = i;
    frame.header.capture_time = (*scan)->depth_times()[i].exposure;
    frame.depth_raw = std::move(raw.pixels);
    frame.depth_scale = raw.depth_scale;
    frames.truth.push_back({frame.header.capture_time, (*scan)->PoseAt(frame.header.capture_time)});
  }
  for (std::size_t i = 0; i < kThermalFrames; ++i) {
    RawFrame raw = (*scan)->RenderThermal(i, scratch);
    ThermalFrame& frame = frames.thermal.emplace_back();
    frame.header.frame_number = i;
    frame.header.capture_time = (*scan)->thermal_times()[i].exposure;
    frame.temperature_raw = std::move(raw.pixels);
    frame.valid = true;
  }
  return frames;
}

bool IsFull(const BenchmarkFrames& frames, std::size_t max_frames) {
  return max_frames > 0 && frames.depth.size() >= max_frames;
}

Result<BenchmarkFrames> LoadDataset(const std::filesystem::path& folder, std::size_t max_frames) {
  Result<Dataset> dataset = OpenDataset({.folder = folder, .thermal_list = {}, .rig = {}});
  if (!dataset) return Err(dataset.error());
  if (!dataset->rig.depth) return Err(FailedPrecondition(folder.string() + ": no depth camera"));
  BenchmarkFrames frames;
  frames.rig = dataset->rig;
  frames.truth = std::move(dataset->groundtruth);
  for (const ImageEntry& entry : dataset->depth) {
    if (IsFull(frames, max_frames)) break;
    Result<Image<std::uint16_t>> pixels =
        ReadGrey16(entry.path, frames.rig.depth->width, frames.rig.depth->height);
    if (!pixels) return Err(pixels.error());
    DepthFrame& frame = frames.depth.emplace_back();
    frame.header.frame_number = frames.depth.size() - 1;
    frame.header.capture_time = entry.time;
    frame.depth_raw = std::move(*pixels);
    frame.depth_scale = frames.rig.depth_scale;
  }
  return frames;
}

Result<BenchmarkFrames> LoadRecording(const std::filesystem::path& path, std::size_t max_frames) {
  Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(path);
  if (!reader) return Err(reader.error());
  const Result<Rig> rig = (*reader)->ReadRig();
  if (!rig) return Err(rig.error());
  BenchmarkFrames frames;
  frames.rig = *rig;
  while (!IsFull(frames, max_frames)) {
    Result<std::optional<RecordedItem>> item = (*reader)->Next();
    if (!item) return Err(item.error());
    if (!*item) break;
    if (const auto* pose = std::get_if<RecordedPose>(&**item)) {
      if (pose->stream == "groundtruth") frames.truth.push_back(pose->pose);
    } else if (const auto* depth = std::get_if<RecordedDepth>(&**item)) {
      Result<Image<std::uint16_t>> pixels = Decode(depth->frame.image);
      if (!pixels) return Err(pixels.error());
      frames.depth.push_back({depth->frame.header, std::move(*pixels), depth->frame.depth_scale});
    }
  }
  return frames;
}

}  // namespace

const BenchmarkFrames& FurnaceDoorFrames() {
  static const BenchmarkFrames frames = Render();
  return frames;
}

Result<BenchmarkFrames> LoadDepthFrames(const std::filesystem::path& scan, std::size_t max_frames) {
  Result<BenchmarkFrames> frames = std::filesystem::is_directory(scan)
                                       ? LoadDataset(scan, max_frames)
                                       : LoadRecording(scan, max_frames);
  if (frames && frames->depth.empty())
    return Err(FailedPrecondition(scan.string() + ": there are no depth frames"));
  return frames;
}

}  // namespace isotherm
