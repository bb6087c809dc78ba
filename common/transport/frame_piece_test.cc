// Pieces of frames, and reports of them, arrive at the other side as they were written.
#include <gtest/gtest.h>

#include "common/transport/endpoints.h"
#include "common/transport/testing/example_messages.h"
#include "common/transport/testing/joined_ends.h"

namespace isotherm {
namespace {

using FramePieceTest = JoinedEndsTest;

TEST_F(FramePieceTest, APieceOfAFrameArrivesAsItWasWritten) {
  FramePiece sent = Good<FramePiece>();
  sent.bytes.assign(kMaxFramePieceBytes, 0xAB);
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const FramePiece& piece = received->message;
  EXPECT_EQ(piece.session, sent.session);
  EXPECT_EQ(piece.sensor, sent.sensor);
  EXPECT_EQ(piece.frame_number, sent.frame_number);
  EXPECT_EQ(piece.sent, sent.sent);
  EXPECT_EQ(piece.order, sent.order);
  EXPECT_EQ(piece.frame_bytes, sent.frame_bytes);
  EXPECT_EQ(piece.frame_crc, sent.frame_crc);
  EXPECT_EQ(piece.index, sent.index);
  EXPECT_EQ(piece.bytes, sent.bytes);
}

TEST_F(FramePieceTest, AReportOfPiecesArrivesAsItWasWritten) {
  const PieceReport sent = Good<PieceReport>();
  const auto received = RoundTrip(sent);
  ASSERT_TRUE(received.has_value());
  const PieceReport& report = received->message;
  EXPECT_EQ(report.session, sent.session);
  EXPECT_EQ(report.next_order, sent.next_order);
  EXPECT_EQ(report.received, sent.received);
  EXPECT_EQ(report.frames, sent.frames);
  EXPECT_EQ(report.broken, sent.broken);
  EXPECT_EQ(report.queued, sent.queued);
}

}  // namespace
}  // namespace isotherm
