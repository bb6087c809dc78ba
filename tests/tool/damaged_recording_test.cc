// Recordings that are damaged, hostile or lack their calibration, as a user of the tool meets them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
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
  /// Returns the number that stands behind `words`; -1 if there is none.
  static long NumberAfter(const std::string& text, const std::string& words) {
    const std::size_t at = text.find(words);
    if (at == std::string::npos) return -1;
    std::istringstream rest(text.substr(at + words.size()));
    long number = -1;
    return rest >> number ? number : -1;
  }
  /// Returns the number that stands before the first `words`; -1 if there is none.
  static long NumberBefore(const std::string& text, const std::string& words) {
    const std::size_t end = text.find(words);
    if (end == std::string::npos) return -1;
    const std::size_t blank = text.find_last_of(" \n", end - 1);
    return NumberAfter(text.substr(0, end), text.substr(blank, end - blank));
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
    return NumberAfter(text, "\n" + stream);
  };
  const long depth = frames_of(before, "depth");
  const long thermal = frames_of(before, "thermal");
  ASSERT_GT(depth, 20);
  ASSERT_GT(thermal, 20);
  const std::uintmax_t place = fs::file_size(folder_ / "scan.mcap") / 2;
  Damage("scan.mcap", place, 3);
  const auto check = [&](const std::string& inspected) {
    EXPECT_THAT(inspected, HasSubstr("DAMAGED"));
    const long depth_lost = NumberAfter(inspected, "\nlost");
    const long thermal_lost = NumberAfter(inspected, "depth and");
    EXPECT_GT(depth_lost + thermal_lost, 0) << inspected;
    EXPECT_EQ(frames_of(inspected, "depth") + depth_lost, depth) << inspected;
    EXPECT_EQ(frames_of(inspected, "thermal") + thermal_lost, thermal) << inspected;
  };
  check(Run("inspect scan.mcap").out);
  // Without the index at its end the file is searched through.
  const std::uintmax_t whole = fs::file_size(folder_ / "scan.mcap");
  fs::resize_file(folder_ / "scan.mcap", whole - 40);
  const std::string searched = Run("inspect scan.mcap").out;
  check(searched);
  EXPECT_GE(NumberAfter(searched, "bytes from byte"), static_cast<long>(place)) << searched;
  EXPECT_LE(NumberBefore(searched, " bytes from byte"), static_cast<long>(whole - place));
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
  const std::string quick = " --voxel 0.006 --set calibration_check.expert.enabled=false";
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
