#include "common/recording/feedback_record.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/recording/feedback.pb.h"
#include "common/recording/mcap_message_stream.h"
#include "common/recording/testing/recording_data.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using testing::kScanStart;

class FeedbackRecordTest : public ::testing::Test {
 protected:
  FeedbackRecordTest() {
    writer_ = std::move(*MakeRecordingWriter(std::make_unique<MemorySink>(disk_), {}));
    feedback_.capture_time = kScanStart;
    feedback_.session = 3;
    feedback_.frame_number = 12;
  }

  /// The messages of a topic, parsed.
  template <typename Message>
  std::vector<Message> Messages(std::string_view topic) {
    EXPECT_TRUE(writer_->Close().ok());
    const MemorySource source(disk_->bytes);
    const auto index = mcap::ReadFileIndex(source);
    EXPECT_TRUE(index.has_value());
    std::vector<Message> messages;
    mcap::MessageStream stream(source, *index);
    for (auto next = stream.Next(); next && next->has_value(); next = stream.Next()) {
      if (index->definitions.channels.at((*next)->channel_id).topic != topic) continue;
      Message message;
      EXPECT_TRUE(
          message.ParseFromArray((*next)->data.data(), static_cast<int>((*next)->data.size())));
      messages.push_back(message);
    }
    return messages;
  }

  std::shared_ptr<MemorySink::Disk> disk_ = std::make_shared<MemorySink::Disk>();
  std::unique_ptr<RecordingWriter> writer_;
  Feedback feedback_;
};

TEST_F(FeedbackRecordTest, SaysWhatTheGroundSaid) {
  feedback_.tracking_state = TrackingState::kTracked;
  feedback_.view.good = 0.5F;
  feedback_.advice = {Advice::kSlower, Advice::kMoveCloser};
  feedback_.advice_reason = "0.50 m/s";
  feedback_.link = "link good";
  feedback_.T_depth_next = MakeTransform({1, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5));
  ASSERT_TRUE(WriteFeedback(feedback_, kScanStart + 70ms, *writer_).ok());
  const auto records = Messages<recording::FeedbackRecord>("/feedback");
  ASSERT_EQ(records.size(), 1U);
  const recording::FeedbackRecord& record = records[0];
  EXPECT_EQ(record.frame_number(), 12U);
  EXPECT_EQ(record.timestamp().seconds(), 1'700'000'000);
  EXPECT_EQ(record.arrival().nanos(), 70'000'000);
  EXPECT_EQ(record.tracking(), "tracked");
  EXPECT_EQ(record.view().good(), 0.5F);
  EXPECT_FALSE(record.has_model()) << "no surface yet";
  ASSERT_EQ(record.advice_size(), 2);
  EXPECT_EQ(record.advice(0), "slower");
  EXPECT_EQ(record.reason(), "0.50 m/s");
  EXPECT_EQ(record.link(), "link good");
  EXPECT_EQ(record.depth_from_next().translation().y(), 2.0);
  EXPECT_FALSE(record.has_world_from_next());
}

TEST_F(FeedbackRecordTest, AnImageIsOneThatViewersShow) {
  feedback_.image = {1, 2, 3};
  ASSERT_TRUE(WriteFeedback(feedback_, std::nullopt, *writer_).ok());
  feedback_.image.clear();
  ASSERT_TRUE(WriteFeedback(feedback_, std::nullopt, *writer_).ok());
  const auto images = Messages<foxglove::CompressedImage>("/feedback/image");
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].format(), "png");
  EXPECT_EQ(images[0].data(), std::string({1, 2, 3}));
}

TEST_F(FeedbackRecordTest, AScanWithFeedbackIsReadAsOneWithout) {
  for (std::uint64_t i = 0; i < 6; ++i) {
    const CaptureTime time = kScanStart + i * 33ms;
    ASSERT_TRUE(writer_->Write(testing::MakeDepth(i, time), time).ok());
    if (i < 2) continue;
    feedback_.capture_time = time - 66ms;  // It comes when later frames are there already.
    ASSERT_TRUE(WriteFeedback(feedback_, time, *writer_).ok());
  }
  ASSERT_TRUE(writer_->Close().ok());
  const auto reader = MakeRecordingReader(std::make_unique<MemorySource>(disk_->bytes));
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ((*reader)->info().messages_by_topic.at("/feedback"), 4U);
  for (std::uint64_t i = 0; i < 6; ++i) {
    const auto item = (*reader)->Next();
    ASSERT_TRUE(item.has_value() && item->has_value());
    EXPECT_EQ(std::get<RecordedDepth>(**item).frame.header.frame_number, i);
  }
  EXPECT_FALSE((*reader)->Next()->has_value());
}

}  // namespace
}  // namespace isotherm
