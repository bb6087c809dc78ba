#include "edge/thermal_camera/p3_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace isotherm {
namespace {

using Data = std::vector<std::uint8_t>;

constexpr P3Layout kP3{256, 192};
/// Small, for the assembler: 2 x 2 pixels, 24 bytes between the markers.
constexpr P3Layout kSmall{2, 2};

Data Marker(std::uint8_t flags, std::uint32_t stamp) {
  Data marker(12);
  marker[0] = 12;
  marker[1] = flags;
  PutLe32(marker, 2, stamp);
  PutLe16(marker, 10, 0x7FF);
  return marker;
}
Data Start(std::uint32_t stamp, std::size_t data_bytes, std::uint8_t value) {
  const Data marker = Marker(0x8C, stamp);
  Data bytes(marker.size() + data_bytes, value);
  std::copy(marker.begin(), marker.end(), bytes.begin());
  return bytes;
}

class P3AssemblerTest : public testing::Test {
 protected:
  P3AssemblerTest() {
    Send(Start(1, 24, 9));
    Send(Marker(0x8E, 1));
    EXPECT_TRUE(assembler_.Pop().has_value());
  }
  void Send(const Data& transfer) { assembler_.AddTransfer(transfer, {}); }
  P3Assembler assembler_{kSmall};
};

TEST(P3ProtocolTest, RowsAndMetadata) {
  EXPECT_EQ(kP3.data_bytes(), 197'632U);
  Data data(kP3.data_bytes());
  const std::size_t metadata = 2 * 256 * 192;
  PutLe16(data, metadata + 2 * 64, 4711);
  PutLe16(data, metadata + 2 * 169, 1);
  PutLe16(data, metadata + 2 * 2 * 256, 19'082);
  PutLe16(data, data.size() - 2, 20'000);
  auto frame = ParseP3Frame(data, kP3);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->counts.At(0, 0), 19'082);
  EXPECT_EQ(frame->counts.At(255, 191), 20'000);
  EXPECT_EQ(frame->metadata.frame_counter, 4711);
  EXPECT_FALSE(frame->metadata.correcting);
  PutLe16(data, metadata + 2 * 169, 0);
  EXPECT_TRUE(ParseP3Frame(data, kP3)->metadata.correcting);
}

TEST(P3ProtocolTest, EveryTruncationIsRefused) {
  const Data data(kP3.data_bytes());
  for (std::size_t length = 0; length < data.size(); ++length) {
    ASSERT_FALSE(ParseP3Frame(Bytes(data).first(length), kP3).has_value()) << length;
  }
}

// Bytes on the wire, from captures in jvdillon/p3-ir-camera.
TEST(P3ProtocolTest, CommandsMatchCaptures) {
  const auto hex = [](const auto& command) {
    std::string text;
    for (const std::uint8_t byte : command) {
      constexpr char kDigits[] = "0123456789abcdef";
      text += kDigits[byte >> 4];
      text += kDigits[byte & 15];
    }
    return text;
  };
  EXPECT_EQ(hex(PackP3Command(0x0101, 0x81, 0x07, 64)),
            "0101810007000000000000004000"
            "0000104c");
  EXPECT_EQ(hex(PackP3Command(0x2F01, 0x81, 0, 1)), "012f81000000000000000000010000004930");
  EXPECT_EQ(hex(PackP3Command(0x2F01, 0x41, 1, 0)), "012f41000100000000000000000000004939");
  EXPECT_EQ(hex(PackP3Command(0x3601, 0x43, 0, 0)), "01364300000000000000000000000000cd0b");
}

TEST(P3ProtocolTest, TextEndsAtZero) {
  const Data text = {'P', '3', 0, 'x'};
  EXPECT_EQ(P3Text(text), "P3");
}

TEST_F(P3AssemblerTest, JoinsTransfersOfAnyLength) {
  Send(Start(2, 10, 5));
  Send(Data(14, 6));
  EXPECT_FALSE(assembler_.Pop().has_value());
  Send(Marker(0x8E, 2));
  const auto frame = assembler_.Pop();
  ASSERT_TRUE(frame.has_value());
  EXPECT_FALSE(frame->incomplete);
  EXPECT_EQ(frame->bytes.size(), 24U);
  EXPECT_EQ(frame->bytes[9], 5);
  EXPECT_EQ(frame->bytes[10], 6);
  EXPECT_EQ(frame->presentation_time, 2U);
}

TEST_F(P3AssemblerTest, F11PieceOfAFrameIsIncompleteAndTheNextIsWhole) {
  Send(Start(2, 10, 5));
  Send(Start(3, 24, 7));
  Send(Marker(0x8E, 3));
  EXPECT_TRUE(assembler_.Pop()->incomplete);
  const auto next = assembler_.Pop();
  EXPECT_FALSE(next->incomplete);
  EXPECT_EQ(next->bytes[0], 7);
}

TEST_F(P3AssemblerTest, F11DamagedMarkerLosesOnlyItsFrame) {
  Data damaged = Start(2, 24, 5);
  damaged[0] = 99;
  Send(damaged);
  Send(Marker(0x8E, 2));
  EXPECT_FALSE(assembler_.Pop().has_value());
  Send(Start(3, 24, 7));
  Send(Marker(0x8E, 3));
  EXPECT_FALSE(assembler_.Pop()->incomplete);
}

TEST_F(P3AssemblerTest, F11LongFrameStaysInItsBounds) {
  Send(Start(2, 25, 5));
  Send(Marker(0x8E, 2));
  const auto frame = assembler_.Pop();
  EXPECT_TRUE(frame->incomplete);
  EXPECT_EQ(frame->bytes.size(), 24U);
}

TEST_F(P3AssemblerTest, F11EndOfAnotherFrameIsIncomplete) {
  Send(Start(2, 24, 5));
  Send(Marker(0x8E, 7));
  EXPECT_TRUE(assembler_.Pop()->incomplete);
}

TEST_F(P3AssemblerTest, MissingEndMarkerCostsNothing) {
  Send(Start(2, 24, 5));
  Send(Start(3, 24, 6));
  Send(Marker(0x8E, 3));
  EXPECT_FALSE(assembler_.Pop()->incomplete);
  EXPECT_FALSE(assembler_.Pop()->incomplete);
}

TEST_F(P3AssemblerTest, EveryTruncationOfATransferIsSurvived) {
  const Data transfer = Start(2, 24, 5);
  for (std::size_t length = 0; length < transfer.size(); ++length) {
    P3Assembler assembler(kSmall);
    assembler.AddTransfer(Bytes(transfer).first(length), {});
    assembler.AddTransfer(Marker(0x8E, 2), {});
    const auto frame = assembler.Pop();
    EXPECT_FALSE(frame.has_value()) << length;  // The first frame, and not whole.
  }
}

}  // namespace
}  // namespace isotherm
