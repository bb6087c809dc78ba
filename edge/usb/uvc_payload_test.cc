#include "edge/usb/uvc_payload.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace isotherm {
namespace {

using Data = std::vector<std::uint8_t>;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr std::uint8_t kId = 0x01;
constexpr std::uint8_t kEnd = 0x02;
constexpr std::uint8_t kError = 0x40;

HostStamp At(int ms) {
  return {CaptureTime(std::chrono::milliseconds(ms)), SteadyTime(std::chrono::milliseconds(ms))};
}

Data Payload(std::uint8_t flags, const Data& data) {
  Data payload(2 + data.size());
  payload[0] = 2;
  payload[1] = flags;
  std::copy(data.begin(), data.end(), payload.begin() + 2);
  return payload;
}

/// Frames of 4 bytes; the first one was whole.
class UvcAssemblerTest : public testing::Test {
 protected:
  UvcAssemblerTest() {
    Add(kEnd, {9, 9, 9, 9});
    EXPECT_TRUE(assembler_.Pop().has_value());
  }
  void Add(std::uint8_t flags, const Data& data, int ms = 0) {
    assembler_.AddPayload(Payload(flags, data), At(ms));
  }
  UvcAssembler assembler_{4};
};

TEST(UvcPayloadHeaderTest, ReadsStampsOfTwelveByteHeaders) {
  const Data payload = {12, 0x8F, 1, 2, 3, 4, 5, 6, 7, 8, 0x34, 0xFA, 99};
  const auto header = ParseUvcPayloadHeader(payload);
  ASSERT_TRUE(header.has_value());
  EXPECT_EQ(header->length, 12U);
  EXPECT_TRUE(header->frame_id);
  EXPECT_TRUE(header->end_of_frame);
  EXPECT_EQ(header->presentation_time, 0x04030201U);
  EXPECT_EQ(header->source_clock, 0x08070605U);
  EXPECT_EQ(header->usb_frame, 0x234);  // 11 bits.
}

TEST(UvcPayloadHeaderTest, EveryTruncationAndEveryLengthIsSurvived) {
  const Data payload = {12, 0x8F, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  for (std::size_t length = 0; length < payload.size(); ++length) {
    EXPECT_FALSE(ParseUvcPayloadHeader(Bytes(payload).first(length)).has_value()) << length;
  }
  for (int said = 0; said < 256; ++said) {
    Data hostile = payload;
    hostile[0] = static_cast<std::uint8_t>(said);
    EXPECT_EQ(ParseUvcPayloadHeader(hostile).has_value(), said == 12) << said;
  }
}

/// Transfers of 4 bytes, payloads of at most 10.
class UvcBulkJoinerTest : public testing::Test {
 protected:
  /// The payload that is completed by `transfer`; empty if none is.
  Data Add(const Data& transfer, int ms = 0) {
    if (!joiner_.Add(transfer, At(ms))) return {};
    return {joiner_.payload().begin(), joiner_.payload().end()};
  }
  UvcBulkJoiner joiner_{4, 10};
};

TEST_F(UvcBulkJoinerTest, PayloadEndsWithATransferThatIsNotFull) {
  EXPECT_THAT(Add({1, 2, 3}), ElementsAre(1, 2, 3));
  EXPECT_THAT(Add({4, 5, 6, 7}, 10), IsEmpty());
  EXPECT_THAT(Add({8}, 20), ElementsAre(4, 5, 6, 7, 8));
  // Stamped by its first bytes.
  EXPECT_EQ(joiner_.first_stamp().steady, At(10).steady);
  EXPECT_EQ(joiner_.first_stamp().wall, At(10).wall);
}

TEST_F(UvcBulkJoinerTest, PayloadThatFillsItsTransfersEndsWithOneWithoutBytes) {
  EXPECT_THAT(Add({1, 2, 3, 4}), IsEmpty());
  EXPECT_THAT(Add({}), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(Add({}), IsEmpty());  // Nothing was sent.
  EXPECT_THAT(Add({5}), ElementsAre(5));
}

TEST_F(UvcBulkJoinerTest, PayloadOfTheAgreedSizeNeedsNoMark) {
  UvcBulkJoiner joiner(4, 8);
  EXPECT_FALSE(joiner.Add(Data{1, 2, 3, 4}, At(0)));
  EXPECT_TRUE(joiner.Add(Data{5, 6, 7, 8}, At(0)));
  EXPECT_THAT(joiner.payload(), ElementsAre(1, 2, 3, 4, 5, 6, 7, 8));
  UvcBulkJoiner whole(4, 4);
  EXPECT_TRUE(whole.Add(Data{1, 2, 3, 4}, At(0)));
  EXPECT_TRUE(whole.Add(Data{5, 6, 7, 8}, At(0)));
  EXPECT_THAT(whole.payload(), ElementsAre(5, 6, 7, 8));
}

TEST_F(UvcBulkJoinerTest, RestOfALostPayloadIsNotTakenForOne) {
  EXPECT_THAT(Add({1, 2, 3, 4}), IsEmpty());
  joiner_.NoteLost();
  EXPECT_THAT(Add({9}), IsEmpty());
  EXPECT_THAT(Add({5, 6}), ElementsAre(5, 6));
  joiner_.NoteLost();  // The first part, this time.
  EXPECT_THAT(Add({7, 7, 7, 7}), IsEmpty());
  EXPECT_THAT(Add({7, 7}), IsEmpty());  // Ten bytes: the agreed size.
  EXPECT_THAT(Add({8}), ElementsAre(8));
}

TEST_F(UvcBulkJoinerTest, LostTransferThatWasAPayloadCostsOnlyThat) {
  UvcBulkJoiner joiner(4, 4);
  joiner.NoteLost();
  EXPECT_TRUE(joiner.Add(Data{1, 2, 3, 4}, At(0)));
}

TEST_F(UvcAssemblerTest, JoinsPacketsAndStampsTheFirst) {
  Add(kId, {}, 10);
  Add(kId, {1, 2}, 11);
  Add(kId, {}, 12);
  Add(kId | kEnd, {3, 4}, 13);
  const auto frame = assembler_.Pop();
  ASSERT_TRUE(frame.has_value());
  EXPECT_THAT(frame->bytes, ElementsAre(1, 2, 3, 4));
  EXPECT_FALSE(frame->incomplete);
  EXPECT_EQ(frame->first_packet.wall, At(11).wall);
  EXPECT_EQ(frame->last_packet.steady, At(13).steady);
}

TEST_F(UvcAssemblerTest, EndsAtTheToggleWithoutEndOfFrame) {
  Add(kId, {1, 2, 3, 4});
  EXPECT_FALSE(assembler_.Pop().has_value());
  Add(0, {5, 6, 7, 8});
  const auto frame = assembler_.Pop();
  ASSERT_TRUE(frame.has_value());
  EXPECT_THAT(frame->bytes, ElementsAre(1, 2, 3, 4));
  EXPECT_FALSE(frame->incomplete);
}

TEST_F(UvcAssemblerTest, F11ShortFrameIsIncomplete) {
  Add(kId | kEnd, {1, 2, 3});
  const auto frame = assembler_.Pop();
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(frame->incomplete);
  EXPECT_EQ(frame->received, 3U);
}

TEST_F(UvcAssemblerTest, F11LongFrameIsIncompleteAndStaysInItsBounds) {
  Add(kId, {1, 2, 3, 4});
  Add(kId | kEnd, {5});
  const auto frame = assembler_.Pop();
  ASSERT_TRUE(frame.has_value());
  EXPECT_TRUE(frame->incomplete);
  EXPECT_THAT(frame->bytes, ElementsAre(1, 2, 3, 4));
}

TEST_F(UvcAssemblerTest, F11ErrorBitMakesItIncomplete) {
  Add(kId, {1, 2});
  Add(kId | kEnd | kError, {3, 4});
  EXPECT_TRUE(assembler_.Pop()->incomplete);
}

TEST_F(UvcAssemblerTest, F11DamagedHeaderMakesItIncomplete) {
  Add(kId, {1, 2});
  assembler_.AddPayload(Data{0xFF, kId, 3, 4}, At(0));
  Add(kId | kEnd, {3, 4});
  EXPECT_TRUE(assembler_.Pop()->incomplete);
  EXPECT_EQ(assembler_.bad_payloads(), 1U);
}

TEST_F(UvcAssemblerTest, F11LostPacketMakesItIncomplete) {
  Add(kId, {1, 2});
  assembler_.NoteLostPacket();
  Add(kId | kEnd, {3, 4});
  EXPECT_TRUE(assembler_.Pop()->incomplete);
  // The next frame is whole again.
  Add(kEnd, {1, 2, 3, 4});
  EXPECT_FALSE(assembler_.Pop()->incomplete);
}

TEST_F(UvcAssemblerTest, StraysAfterTheEndAreLeftOut) {
  Add(kId | kEnd, {1, 2, 3, 4});
  Add(kId, {7, 7});
  Add(kEnd, {5, 6, 7, 8});
  EXPECT_THAT(assembler_.Pop()->bytes, ElementsAre(1, 2, 3, 4));
  const auto frame = assembler_.Pop();
  EXPECT_THAT(frame->bytes, ElementsAre(5, 6, 7, 8));
  EXPECT_FALSE(frame->incomplete);
}

TEST(UvcAssemblerStartTest, HalfAFrameAtTheStartIsLeftOut) {
  UvcAssembler assembler(4);
  assembler.AddPayload(Payload(kEnd, {3, 4}), At(0));
  EXPECT_FALSE(assembler.Pop().has_value());
  assembler.AddPayload(Payload(kId | kEnd, {3, 4}), At(0));
  EXPECT_TRUE(assembler.Pop()->incomplete);
}

TEST_F(UvcAssemblerTest, WaitingFramesAreBounded) {
  for (std::uint8_t i = 0; i < WaitingFrames::kMax + 2; ++i) {
    Add(static_cast<std::uint8_t>(i % 2 == 0 ? kId | kEnd : kEnd), {i, i, i, i});
  }
  const auto next = assembler_.Pop();
  EXPECT_THAT(next->bytes, ElementsAre(2, 2, 2, 2));
  EXPECT_EQ(next->dropped_before, 2U);
  EXPECT_EQ(assembler_.Pop()->dropped_before, 0U);
}

}  // namespace
}  // namespace isotherm
