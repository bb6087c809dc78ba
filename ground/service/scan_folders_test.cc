#include "ground/service/scan_folders.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "common/recording/recording.h"
#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// 2026-01-02 03:04:05 UTC.
constexpr CaptureTime kNow = CaptureTimeFromNanoseconds(1'767'323'045'000'000'000);
constexpr std::uint64_t kSession = 0x0123'4567'89ab'cdef;
constexpr const char* kNewName = "scan-20260102T030405Z-89abcdef";

class ScanFoldersTest : public ::testing::Test {
 protected:
  ScanFoldersTest() { options_.mutable_live()->set_output_dir(folder_.path().string()); }
  void MakeFile(const std::string& name) const {
    const std::filesystem::path path = folder_.path() / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "content";
  }
  static std::vector<std::string> Names(const ScanFolder& folder) {
    std::vector<std::string> names;
    for (const auto& file : folder.earlier_files) {
      EXPECT_EQ(file.parent_path(), folder.path);
      names.push_back(file.filename().string());
    }
    return names;
  }

  const testing::TemporaryDirectory folder_;
  GroundOptions options_;
};

TEST_F(ScanFoldersTest, ANewSessionHasAFolderOfItsTime) {
  MakeFile("scan-20260101T120000Z-89abcdee/scan.mcap");
  const ScanFolder folder = ScanFolders(options_, false).Begin(kSession, kNow);
  EXPECT_EQ(folder.path, folder_.path() / kNewName);
  EXPECT_THAT(folder.earlier_files, IsEmpty());
}

TEST_F(ScanFoldersTest, F32AScanThatWasUnderWayGoesOnInItsFolderOnce) {
  const std::string name = "scan-20260101T120000Z-89abcdef";
  for (const char* file : {"scan-10.mcap", "scan-2.mcap", "scan-late-2.mcap", "scan-late.mcap",
                           "scan.mcap", "scan-late.mcap.part", "scanned.mcap", "scan-1.mcap",
                           "scan-x.mcap", "stats.json", "scan-late-late.mcap"})
    MakeFile(name + "/" + file);
  MakeFile("scan-20251231T120000Z-89abcdef/scan.mcap");
  MakeFile(name + "/.scan.mcap.77.partial");  // A process was killed when it made one file.
  MakeFile("notes-89abcdef/scan.mcap");
  MakeFile("scan-89abcdef");
  ScanFolders folders(options_, false);
  const ScanFolder folder = folders.Begin(kSession, kNow);
  EXPECT_EQ(folder.path, folder_.path() / name);
  EXPECT_THAT(Names(folder), ElementsAre("scan.mcap", "scan-2.mcap", "scan-10.mcap",
                                         "scan-late.mcap", "scan-late-2.mcap"));
  EXPECT_FALSE(folder.is_complete);
  EXPECT_FALSE(std::filesystem::exists(folder.path / ".scan.mcap.77.partial"));
  EXPECT_EQ(folders.Begin(kSession, kNow).path, folder_.path() / kNewName);
}

TEST_F(ScanFoldersTest, F32AScanThatHasEndedAndIsCompleteIsNotMadeAgain) {
  const std::string name = "scan-20260101T120000Z-89abcdef";
  const auto is_complete = [&](const std::string& stats) {
    std::ofstream(folder_.path() / name / "stats.json") << stats;
    return ScanFolders(options_, false).Begin(kSession, kNow).is_complete;
  };
  MakeFile(name + "/scan.mcap");
  const std::string session = std::to_string(kSession);
  EXPECT_TRUE(
      is_complete(R"({"link": {"final": true, "closed": true, "session": )" + session + "}}"));
  EXPECT_FALSE(
      is_complete(R"({"link": {"final": false, "closed": true, "session": )" + session + "}}"));
  EXPECT_FALSE(is_complete(R"({"link": {"final": true, "closed": true, "session": 7}}")"));
  EXPECT_FALSE(is_complete(R"({"link": 3})"));
  EXPECT_FALSE(is_complete("{"));
  MakeFile(name + "/scan-late.mcap");
  EXPECT_FALSE(
      is_complete(R"({"link": {"final": true, "closed": true, "session": )" + session + "}}"))
      << "it is in parts";
}

TEST_F(ScanFoldersTest, AFolderThatAnotherProcessHasIsPassedOver) {
  MakeFile("scan-20260101T120000Z-89abcdef/scan.mcap");
  MakeFile("scan-20260101T130000Z-89abcdef/scan.mcap");
  FolderLock other;
  ASSERT_TRUE(other.Take(folder_.path() / "scan-20260101T130000Z-89abcdef"));
  const ScanFolder own = ScanFolders(options_, false).Begin(kSession, kNow);
  EXPECT_EQ(own.path, folder_.path() / "scan-20260101T120000Z-89abcdef");
  EXPECT_EQ(ScanFolders(options_, false).Begin(kSession, kNow).path, folder_.path() / kNewName)
      << "both are taken";
}

TEST_F(ScanFoldersTest, WhatAnotherProcessWritesIsLeftAlone) {
  const std::filesystem::path folder = folder_.path() / "scan-20260101T120000Z-89abcdef";
  const auto writer = RecordingWriter::Create(folder / "scan.mcap", {});
  ASSERT_TRUE(writer.has_value());
  const ScanFolder begun = ScanFolders(options_, false).Begin(kSession, kNow);
  EXPECT_EQ(begun.path, folder_.path() / kNewName);
  EXPECT_THAT(begun.earlier_files, IsEmpty());
}

TEST_F(ScanFoldersTest, ASingleScanHasTheFolderItselfAndWhatWasThereAtItsBeginning) {
  MakeFile("scan.mcap");
  ScanFolders folders(options_, true);
  const ScanFolder first = folders.Begin(kSession, kNow);
  EXPECT_EQ(first.path, folder_.path());
  EXPECT_THAT(Names(first), ElementsAre("scan.mcap"));
  EXPECT_THAT(folders.Begin(kSession, kNow).earlier_files, IsEmpty());
}

TEST_F(ScanFoldersTest, ItCanBeTurnedOffAndNeedsARecording) {
  MakeFile("scan-20260101T120000Z-89abcdef/scan.mcap");
  options_.mutable_live()->mutable_expert()->set_resume(false);
  EXPECT_EQ(ScanFolders(options_, false).Begin(kSession, kNow).path, folder_.path() / kNewName);
  options_.mutable_live()->mutable_expert()->set_resume(true);
  options_.mutable_live()->set_record(false);
  EXPECT_EQ(ScanFolders(options_, false).Begin(kSession, kNow).path, folder_.path() / kNewName);
}

TEST_F(ScanFoldersTest, WithoutAnOutputFolderAllIsNew) {
  options_.mutable_live()->set_output_dir((folder_.path() / "missing").string());
  EXPECT_EQ(ScanFolders(options_, false).Begin(kSession, kNow).path,
            folder_.path() / "missing" / kNewName);
}

}  // namespace
}  // namespace isotherm
