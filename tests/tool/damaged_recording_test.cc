// Recordings that are damaged, hostile or lack their calibration, as a user of the tool meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

#include "common/recording/recording.h"
#include "common/rig/rig_calibration.h"
#include "tests/support/tool.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;
using isotherm::testing::Outcome;
using isotherm::testing::ReadAll;
using ::testing::HasSubstr;
using ::testing::Not;

class DamagedRecordingTest : public isotherm::testing::ToolRun {
 protected:
  /// Overwrites some bytes, as a bad block of a disk would.
  void Damage(const std::string& name, std::uintmax_t offset, std::size_t bytes) const {
    std::fstream file(folder_ / name, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(static_cast<std::streamoff>(offset));
    file << std::string(bytes, 'Z');
    ASSERT_TRUE(file.good());
  }
  /// The number in the first match of a pattern; -1 if there is none.
  static long Number(const std::string& text, const std::string& pattern) {
    std::smatch found;
    return std::regex_search(text, found, std::regex(pattern)) ? std::stol(found[1]) : -1;
  }
  /// Copies the frames of scan.mcap to bare.mcap, and its calibration to rig.textproto.
  void CopyWithoutRig() const {
    auto reader = RecordingReader::Open(folder_ / "scan.mcap");
    ASSERT_TRUE(reader) << reader.error().message();
    Write("rig.textproto", ToText((*reader)->ReadRig().value()));
    auto writer = RecordingWriter::Create(folder_ / "bare.mcap", {});
    ASSERT_TRUE(writer) << writer.error().message();
    while (true) {
      auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) break;
      if (const auto* depth = std::get_if<RecordedDepth>(&**item)) {
        ASSERT_TRUE((*writer)->Write(depth->frame, depth->arrival).ok());
      } else if (const auto* thermal = std::get_if<RecordedThermal>(&**item)) {
        ASSERT_TRUE((*writer)->Write(thermal->frame, thermal->arrival).ok());
      }
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }
};

TEST_F(DamagedRecordingTest, F45InspectSaysThatItIsDamagedWhereHowManyBytesAndFrames) {
  ASSERT_EQ(Run("simulate --scene corner-sphere --duration 1 -o scan.mcap").status, 0);
  const std::string before = Run("inspect scan.mcap").out;
  EXPECT_THAT(before, Not(HasSubstr("DAMAGED")));
  const auto frames_of = [](const std::string& text, const std::string& stream) {
    return Number(text, stream + R"(\s+(\d+) frames)");
  };
  const long depth = frames_of(before, "depth");
  const long thermal = frames_of(before, "thermal");
  ASSERT_GT(depth, 20);
  ASSERT_GT(thermal, 20);
  const std::uintmax_t place = fs::file_size(folder_ / "scan.mcap") / 2;
  Damage("scan.mcap", place, 3);
  const Outcome inspect = Run("inspect scan.mcap");
  EXPECT_THAT(inspect.out, HasSubstr("DAMAGED"));
  const long depth_lost = Number(inspect.out, R"(lost\s+(\d+) depth and)");
  const long thermal_lost = Number(inspect.out, R"(depth and (\d+) thermal frames)");
  EXPECT_GT(depth_lost + thermal_lost, 0) << inspect.out;
  EXPECT_EQ(frames_of(inspect.out, "depth") + depth_lost, depth) << inspect.out;
  EXPECT_EQ(frames_of(inspect.out, "thermal") + thermal_lost, thermal) << inspect.out;
  const long from = Number(inspect.out, R"(bytes from byte (\d+))");
  const long bytes = Number(inspect.out, R"((\d+) bytes from byte)");
  EXPECT_LE(from, static_cast<long>(place)) << inspect.out;
  EXPECT_GT(from + bytes, static_cast<long>(place)) << inspect.out;
}

TEST_F(DamagedRecordingTest, F65WhatARecordingSaysOfItselfIsPrintedWithoutControlCharacters) {
  {
    auto writer = RecordingWriter::Create(folder_ / "scan.mcap", {});
    ASSERT_TRUE(writer) << writer.error().message();
    const std::string evil = "\x1b]0;owned\x07\x1b[31mred\r\x08";
    ASSERT_TRUE(
        (*writer)
            ->WriteMetadata("cameras", {{"depth", evil}, {"depth_serial", evil}, {evil, evil}})
            .ok());
    ASSERT_TRUE((*writer)->WriteMetadata(evil, {{"x", evil}}).ok());
    ASSERT_TRUE((*writer)->Close().ok());
  }
  for (const char* arguments : {"inspect scan.mcap", "inspect scan.mcap --json",
                                "reconstruct scan.mcap -o out", "convert scan.mcap -o view.mcap"}) {
    const Outcome outcome = Run(arguments);
    for (const std::string& text : {outcome.out, outcome.err}) {
      EXPECT_TRUE(std::none_of(text.begin(), text.end(),
                               [](unsigned char c) { return c < ' ' && c != '\n'; }))
          << arguments << ": " << text;
    }
  }
  EXPECT_THAT(Run("inspect scan.mcap").out, HasSubstr("owned")) << "the rest is shown";
}

TEST_F(DamagedRecordingTest, F45ARecordingWithoutItsCalibrationTakesAnotherOne) {
  ASSERT_EQ(Run("simulate --scene corner-sphere --duration 0.3 -o scan.mcap").status, 0);
  CopyWithoutRig();
  const std::string quick = " --voxel 0.006 --set delay_check.enabled=false";
  const Outcome without = Run("reconstruct bare.mcap -o none" + quick);
  EXPECT_EQ(without.status, 66);
  EXPECT_THAT(without.err, HasSubstr("--rig"));
  const Outcome with = Run("reconstruct bare.mcap -o out --rig rig.textproto" + quick);
  EXPECT_EQ(with.status, 0) << with.err;
  ASSERT_EQ(Run("reconstruct scan.mcap -o expected" + quick).status, 0);
  EXPECT_TRUE(ReadAll(folder_ / "out/cloud.ply") == ReadAll(folder_ / "expected/cloud.ply"))
      << "as if it had been in the recording";
}

}  // namespace
}  // namespace isotherm
