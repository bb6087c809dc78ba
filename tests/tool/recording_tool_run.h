#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "tests/support/tool.h"

namespace isotherm::testing {

/// Everything of a recording that must survive a conversion.
struct Content {
  std::vector<std::vector<std::uint16_t>> pixels;
  std::vector<std::pair<std::uint64_t, std::int64_t>> frames;  ///< Number and time.
  std::map<std::string, std::vector<StampedPose>> poses;
  std::string rig;
  RecordingInfo info;
};

/// Runs the tool on recordings and looks at what is in them.
class RecordingToolRun : public ToolRun {
 protected:
  void Simulate() const { RunWell("simulate --scene corner-sphere --duration 0.2 -o scan.mcap"); }

  template <typename Frame>
  static void Add(const Frame& frame, Content& content) {
    const auto pixels = Decode(frame.image);
    ASSERT_TRUE(pixels) << pixels.error().message();
    content.pixels.emplace_back(pixels->pixels().begin(), pixels->pixels().end());
    content.frames.emplace_back(frame.header.frame_number,
                                ToNanoseconds(frame.header.capture_time));
  }

  void Read(const std::string& name, Content& content) const {
    auto reader = RecordingReader::Open(folder_ / name);
    ASSERT_TRUE(reader) << reader.error().message();
    content.info = (*reader)->info();
    const Rig rig = (*reader)->ReadRig().value();
    content.rig = std::to_string(rig.thermal_delay_s) + std::to_string(rig.depth->fx);
    while (true) {
      const auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) return;
      if (const auto* depth = std::get_if<RecordedDepth>(&**item)) Add(depth->frame, content);
      if (const auto* thermal = std::get_if<RecordedThermal>(&**item)) Add(thermal->frame, content);
      if (const auto* pose = std::get_if<RecordedPose>(&**item))
        content.poses[pose->stream].push_back(pose->pose);
    }
  }
};

}  // namespace isotherm::testing
