#include "edge/spool/recorded_frame_reader.h"

#include <gtest/gtest.h>

#include "common/recording/recording.h"
#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr CaptureTime kStart{1'700'000'000s};

/// A recording that grows while it is read.
class RecordedFrameReaderTest : public ::testing::Test {
 protected:
  void Write(std::uint64_t number) {
    EncodedDepthFrame frame;
    frame.header = {.session = 5, .frame_number = number, .capture_time = kStart + 100ms * number};
    frame.depth_scale = 1000.0;
    frame.image = {.encoding = Encoding::kRaw16, .width = 2, .height = 1, .payload = {1, 2, 3, 4}};
    ASSERT_TRUE(writer_->Write(frame, std::nullopt).ok());
  }
  /// Returns the numbers of all frames up to the end of what is on the disk.
  std::vector<std::uint64_t> ReadAll() {
    std::vector<std::uint64_t> numbers;
    while (true) {
      const auto frame = reader_.Next();
      if (!frame || !*frame) return numbers;
      const auto& depth = std::get<EncodedDepthFrame>(**frame);
      EXPECT_EQ(depth.header.session, 5U);
      numbers.push_back(depth.header.frame_number);
    }
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_.path() / "scan.mcap";
  const std::unique_ptr<RecordingWriter> writer_ = RecordingWriter::Create(path_, {}).value();
  RecordedFrameReader reader_;
};

TEST_F(RecordedFrameReaderTest, ReadsWhatIsOnTheDiskAndMoreWhenItIsSentThereAgain) {
  for (std::uint64_t number = 0; number < 10; ++number) Write(number);
  ASSERT_TRUE(writer_->Flush().ok());
  ASSERT_TRUE(reader_.GoTo({path_, kStart + 450ms}).ok());
  EXPECT_EQ(ReadAll(), (std::vector<std::uint64_t>{5, 6, 7, 8, 9}));
  EXPECT_EQ(reader_.at()->time, kStart + 900ms);
  for (std::uint64_t number = 10; number < 13; ++number) Write(number);
  ASSERT_TRUE(writer_->Flush().ok());
  EXPECT_TRUE(ReadAll().empty()) << "it reads what was there when it was opened";
  ASSERT_TRUE(reader_.GoTo({path_, kStart + 900ms}).ok());
  EXPECT_EQ(ReadAll(), (std::vector<std::uint64_t>{9, 10, 11, 12}));
}

TEST_F(RecordedFrameReaderTest, AFileThatIsGoneIsAnErrorAndNothingIsRead) {
  Write(0);
  ASSERT_TRUE(writer_->Close().ok());
  ASSERT_TRUE(reader_.GoTo({path_, kStart}).ok());
  EXPECT_FALSE(reader_.GoTo({folder_.path() / "gone.mcap", kStart}).ok());
  EXPECT_EQ(reader_.at(), std::nullopt);
  EXPECT_TRUE(ReadAll().empty());
}

}  // namespace
}  // namespace isotherm
