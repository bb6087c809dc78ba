// One side of the interoperability test: writes recordings for check_ours.mjs, reads those of
// write_theirs.mjs.
//   mcap_fixture write FOLDER | read FILE
#include <fmt/format.h>

#include <cstdio>
#include <string_view>

#include "common/codec/codec.h"
#include "common/recording/recording.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

// The recordings contain this; contents.mjs has the same.
constexpr CaptureTime kStart{std::chrono::seconds(1'700'000'000)};

struct Stream {
  int frames;
  Nanoseconds period;
  int width;
  int height;

  CaptureTime Time(int n) const { return kStart + n * period; }
  Image<std::uint16_t> Pixels(int n) const {
    Image<std::uint16_t> image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        image.At(x, y) = static_cast<std::uint16_t>(1000 * n + 7 * x + 13 * y);
      }
    }
    return image;
  }
};
constexpr Stream kDepth{.frames = 30, .period = Nanoseconds(33'333'333), .width = 16, .height = 12};
constexpr Stream kThermal{.frames = 40, .period = 25ms, .width = 12, .height = 10};

FrameHeader MakeHeader(const Stream& stream, int n) {
  return {.session = 42,
          .frame_number = static_cast<std::uint64_t>(n),
          .device_ticks = DeviceTicks(std::chrono::microseconds(1000 * n)),
          .capture_time = stream.Time(n),
          .capture_sigma = Nanoseconds(777)};
}

Rig MakeRig() {
  Rig rig;
  rig.depth = CameraModel{.width = 16, .height = 12, .fx = 580, .fy = 581, .cx = 8, .cy = 6};
  rig.thermal = CameraModel{.width = 12,
                            .height = 10,
                            .fx = 600,
                            .fy = 601,
                            .cx = 6,
                            .cy = 5,
                            .k1 = -0.25,
                            .k2 = 0.1,
                            .p1 = 0.001,
                            .p2 = -0.002,
                            .k3 = 0.01};
  rig.T_thermal_depth = MakeTransform({0.05, 0, 0}, Eigen::Quaterniond::Identity());
  rig.thermal_delay_s = -0.0427;
  return rig;
}

Status WriteDepth(RecordingWriter& writer, DepthEncoder& encoder, int n) {
  const EncodedDepthFrame frame{.header = MakeHeader(kDepth, n),
                                .image = encoder.Encode(kDepth.Pixels(n)),
                                .depth_scale = 5000};
  return writer.Write(frame, kDepth.Time(n) + 5ms);
}

Status WriteThermal(RecordingWriter& writer, ThermalEncoder& encoder, int n) {
  EncodedThermalFrame frame;
  frame.header = MakeHeader(kThermal, n);
  frame.image = encoder.Encode(kThermal.Pixels(n), frame.scale);
  frame.nuc_state = NucState::kSettling;
  frame.nuc_source = NucSource::kPolled;
  frame.seconds_since_nuc = 0.25;
  frame.housekeeping.fpa_celsius = 31.5F;
  frame.valid = true;
  return writer.Write(frame, kThermal.Time(n) + 5ms);
}

Status WriteFrames(RecordingWriter& writer) {
  DepthEncoder depth_encoder;
  ThermalEncoder thermal_encoder;
  int depth = 0;
  int thermal = 0;
  while (depth < kDepth.frames || thermal < kThermal.frames) {
    const bool depth_is_next =
        thermal == kThermal.frames ||
        (depth < kDepth.frames && kDepth.Time(depth) <= kThermal.Time(thermal));
    ISOTHERM_RETURN_IF_ERROR(depth_is_next ? WriteDepth(writer, depth_encoder, depth++)
                                           : WriteThermal(writer, thermal_encoder, thermal++));
  }
  return OkStatus();
}

Status WriteFile(const std::filesystem::path& path, ImageStorage storage) {
  auto writer = RecordingWriter::Create(path, {.image_storage = storage, .flush_interval = 300ms});
  if (!writer) return writer.error();
  RecordingWriter& file = **writer;
  ISOTHERM_RETURN_IF_ERROR(file.Write(MakeRig()));
  ISOTHERM_RETURN_IF_ERROR(file.WriteMetadata("origin", {{"folder", "scan"}, {"unit", "µK"}}));
  ISOTHERM_RETURN_IF_ERROR(WriteFrames(file));
  ISOTHERM_RETURN_IF_ERROR(file.Write(
      NucEvent{.start = kStart + 100ms, .end = kStart + 400ms, .source = NucSource::kCommanded}));
  ISOTHERM_RETURN_IF_ERROR(file.WritePose(
      "groundtruth", {.time = kStart + 200ms,
                      .T_world_depth = MakeTransform({1, 2, 3}, Eigen::Quaterniond::Identity())}));
  ISOTHERM_RETURN_IF_ERROR(file.WriteLog(kStart + 300ms, "warning", "closer"));
  return file.Close();
}

/// Frames of one stream as they are read.
struct Check {
  const Stream& stream;
  int next = 0;

  Status Add(const FrameHeader& header, const EncodedImage& encoded) {
    const auto pixels = Decode(encoded);
    if (!pixels) return pixels.error();
    if (header.frame_number != static_cast<std::uint64_t>(next) ||
        header.capture_time != stream.Time(next) || *pixels != stream.Pixels(next)) {
      return DataLoss(fmt::format("frame {} is not what was written", next));
    }
    ++next;
    return OkStatus();
  }
};

Status ReadFile(const std::filesystem::path& path) {
  auto reader = RecordingReader::Open(path);
  if (!reader) return reader.error();
  if ((*reader)->info().metadata.at("origin").at("unit") != "µK")
    return DataLoss("metadata differ");
  Check depth{.stream = kDepth};
  Check thermal{.stream = kThermal};
  CaptureTime last{};
  while (true) {
    auto item = (*reader)->Next();
    if (!item) return item.error();
    if (!*item) break;
    const auto* const depth_frame = std::get_if<RecordedDepth>(&**item);
    const auto* const thermal_frame = std::get_if<RecordedThermal>(&**item);
    if (depth_frame == nullptr && thermal_frame == nullptr) return DataLoss("unexpected item");
    const FrameHeader& header =
        depth_frame != nullptr ? depth_frame->frame.header : thermal_frame->frame.header;
    if (header.capture_time < last) return DataLoss("frames are not in the order of time");
    last = header.capture_time;
    ISOTHERM_RETURN_IF_ERROR(depth_frame != nullptr
                                 ? depth.Add(header, depth_frame->frame.image)
                                 : thermal.Add(header, thermal_frame->frame.image));
  }
  if (depth.next != kDepth.frames || thermal.next != kThermal.frames) {
    return DataLoss(fmt::format("{} depth and {} thermal frames", depth.next, thermal.next));
  }
  return OkStatus();
}

Status Run(std::string_view command, const std::filesystem::path& path) {
  if (command == "read") return ReadFile(path);
  ISOTHERM_RETURN_IF_ERROR(WriteFile(path / "viewable.mcap", ImageStorage::kViewable));
  return WriteFile(path / "compact.mcap", ImageStorage::kCompact);
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 3) return isotherm::kExitUsage;
  const isotherm::Status status = isotherm::Run(argv[1], argv[2]);
  fmt::print("{} {}: {}\n", argv[1], argv[2], status.ok() ? "ok" : status.message());
  return isotherm::ExitCode(status);
}
