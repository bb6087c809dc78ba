#pragma once

#include <memory>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "common/recording/recording_streams.h"
#include "common/recording/testing/memory_stream.h"

/// Small scans for the tests of this folder.
namespace isotherm::testing {

inline constexpr CaptureTime kScanStart{std::chrono::seconds(1'700'000'000)};

inline Rig MakeRig() {
  Rig rig;
  rig.depth = CameraModel{.width = 640, .height = 480, .fx = 580, .fy = 581, .cx = 319, .cy = 239};
  rig.thermal = CameraModel{.width = 382,
                            .height = 288,
                            .fx = 600,
                            .fy = 601,
                            .cx = 190,
                            .cy = 143,
                            .k1 = -0.25,
                            .k2 = 0.1,
                            .p1 = 1e-3,
                            .p2 = -2e-3,
                            .k3 = 0.01};
  rig.depth_scale = 5000;
  rig.T_thermal_depth =
      MakeTransform({0.05, -0.01, 0.002}, Eigen::Quaterniond(0.99, 0.01, -0.1, 0.02));
  rig.thermal_delay_s = -0.0427;
  rig.serial = "A-7";
  return rig;
}

inline EncodedImage RandomRawImage(int width, int height, std::uint32_t seed) {
  EncodedImage image{.encoding = Encoding::kRaw16, .width = width, .height = height, .payload = {}};
  std::minstd_rand random(seed + 1);
  image.payload.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 2);
  for (std::uint8_t& byte : image.payload) byte = static_cast<std::uint8_t>(random() >> 8);
  return image;
}

inline EncodedDepthFrame MakeDepth(std::uint64_t number, CaptureTime time, int width = 8,
                                   int height = 6) {
  EncodedDepthFrame frame;
  frame.header = {.session = 42,
                  .frame_number = number,
                  .device_ticks = DeviceTicks(std::chrono::microseconds(33'333 * number)),
                  .capture_time = time,
                  .capture_sigma = Nanoseconds(1234)};
  frame.image = RandomRawImage(width, height, static_cast<std::uint32_t>(number));
  frame.depth_scale = 5000.0;
  return frame;
}

inline EncodedThermalFrame MakeThermal(std::uint64_t number, CaptureTime time, int width = 4,
                                       int height = 3) {
  EncodedThermalFrame frame;
  frame.header = {.session = 42,
                  .frame_number = number,
                  .device_ticks = DeviceTicks(std::chrono::microseconds(25'000 * number)),
                  .capture_time = time,
                  .capture_sigma = Nanoseconds(0)};
  frame.image = RandomRawImage(width, height, static_cast<std::uint32_t>(1000 + number));
  frame.nuc_state = NucState::kDesired;
  frame.nuc_source = NucSource::kInBand;
  frame.seconds_since_nuc = 12.5;
  frame.housekeeping.fpa_celsius = 31.25F;
  frame.valid = true;
  return frame;
}

/// Depth at 30 Hz and thermal at 40 Hz, as a camera pair delivers them.
struct Scan {
  std::vector<EncodedDepthFrame> depth;
  std::vector<EncodedThermalFrame> thermal;
};

inline Scan MakeScan(int milliseconds, int width = 8, int height = 6) {
  Scan scan;
  for (int i = 0; i * 100 < milliseconds * 3; ++i) {
    scan.depth.push_back(MakeDepth(static_cast<std::uint64_t>(i),
                                   kScanStart + Nanoseconds(33'333'333LL * i), width, height));
  }
  for (int i = 0; i * 25 < milliseconds; ++i) {
    scan.thermal.push_back(MakeThermal(static_cast<std::uint64_t>(i),
                                       kScanStart + Nanoseconds(25'000'000LL * i), width, height));
  }
  return scan;
}

/// Writes the frames in the order of time; returns how many calls failed.
inline int WriteScan(const Scan& scan, RecordingWriter& writer) {
  int failed = 0;
  auto depth = scan.depth.begin();
  auto thermal = scan.thermal.begin();
  while (depth != scan.depth.end() || thermal != scan.thermal.end()) {
    const bool take_depth =
        thermal == scan.thermal.end() ||
        (depth != scan.depth.end() && depth->header.capture_time <= thermal->header.capture_time);
    const Status status =
        take_depth ? writer.Write(*depth++, std::nullopt) : writer.Write(*thermal++, std::nullopt);
    failed += status.ok() ? 0 : 1;
  }
  return failed;
}

inline std::unique_ptr<RecordingWriter> WriterTo(const std::shared_ptr<MemorySink::Disk>& disk,
                                                 const RecordingOptions& options = {}) {
  auto writer = MakeRecordingWriter(std::make_unique<MemorySink>(disk), options);
  return writer ? std::move(*writer) : nullptr;
}

inline Result<std::unique_ptr<RecordingReader>> ReaderOf(std::vector<std::uint8_t> bytes) {
  return MakeRecordingReader(std::make_unique<MemorySource>(std::move(bytes)));
}

/// Everything that can be read, and how often reading failed on the way.
struct ReadBack {
  std::vector<RecordedItem> items;
  std::vector<Status> errors;

  template <typename T>
  std::vector<T> All() const {
    std::vector<T> found;
    for (const RecordedItem& item : items) {
      if (const T* value = std::get_if<T>(&item)) found.push_back(*value);
    }
    return found;
  }
};

inline ReadBack ReadAll(RecordingReader& reader) {
  ReadBack result;
  while (true) {
    auto item = reader.Next();
    if (!item) {
      result.errors.push_back(item.error());
    } else if (*item) {
      result.items.push_back(std::move(**item));
    } else {
      return result;
    }
  }
}

inline CaptureTime TimeOf(const RecordedItem& item) {
  /// Finds the time of each kind of item.
  struct Visitor {
    CaptureTime operator()(const RecordedDepth& depth) { return depth.frame.header.capture_time; }
    CaptureTime operator()(const RecordedThermal& thermal) {
      return thermal.frame.header.capture_time;
    }
    CaptureTime operator()(const NucEvent& event) { return event.start; }
    CaptureTime operator()(const RecordedPose& pose) { return pose.pose.time; }
    CaptureTime operator()(const ExternalOdometry& pose) { return pose.time; }
    CaptureTime operator()(const RecordedLog& log) { return log.time; }
    CaptureTime operator()(const ClockStep& step) { return step.time; }
  };
  return std::visit(Visitor{}, item);
}

}  // namespace isotherm::testing
