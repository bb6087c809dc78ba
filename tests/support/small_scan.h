#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>

#include "common/codec/codec.h"
#include "common/recording/recording.h"

namespace isotherm {

inline constexpr int kSmallScanFrames = 30;

/// Something that does not compress to nothing.
inline Image<std::uint16_t> SmallNoise(int width, int height, std::uint16_t base) {
  Image<std::uint16_t> image(width, height);
  std::uint32_t state = 1;
  for (std::uint16_t& pixel : image.pixels()) {
    state = state * 1664525U + 1013904223U;
    pixel = static_cast<std::uint16_t>(base + (state >> 24U));
  }
  return image;
}

/// Writes a second of both cameras, in small images (or some times as wide and high), for an edge
/// to replay.
inline void WriteSmallScan(const std::filesystem::path& path, int scale = 1) {
  using std::chrono::milliseconds;
  const Result<std::unique_ptr<RecordingWriter>> writer = RecordingWriter::Create(path, {});
  ASSERT_TRUE(writer.has_value()) << writer.error().message();
  for (int i = 0; i < kSmallScanFrames; ++i) {
    const CaptureTime time =
        CaptureTime(std::chrono::seconds(1'600'000'000)) + i * milliseconds(33);
    EncodedDepthFrame depth;
    depth.header.frame_number = static_cast<std::uint64_t>(i);
    depth.header.capture_time = time;
    depth.image = DepthEncoder().Encode(SmallNoise(scale * 64, scale * 48, 700));
    ASSERT_TRUE((*writer)->Write(depth, std::nullopt).ok());
    EncodedThermalFrame thermal;
    thermal.header = depth.header;
    thermal.header.capture_time = time + milliseconds(7);
    thermal.image =
        ThermalEncoder().Encode(SmallNoise(scale * 38, scale * 28, 29'815), thermal.scale);
    ASSERT_TRUE((*writer)->Write(thermal, std::nullopt).ok());
  }
  ASSERT_TRUE((*writer)->Close().ok());
}

/// Writes the rig file of those cameras.
inline void WriteSmallRig(const std::filesystem::path& path, int scale = 1) {
  const auto camera = [scale](int width, int height, int focal_length_px) {
    std::ostringstream text;
    text << "{ width: " << scale * width << " height: " << scale * height
         << " fx: " << scale * focal_length_px << " fy: " << scale * focal_length_px
         << " cx: " << (scale * width - 1) / 2.0 << " cy: " << (scale * height - 1) / 2.0 << " }\n";
    return text.str();
  };
  std::ofstream(path) << "depth " << camera(64, 48, 60) << "thermal " << camera(38, 28, 40)
                      << "T_thermal_depth { tx: 0.05 ty: 0 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 }\n";
}

}  // namespace isotherm
