#include "ground/subscriber/piece_collector.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <variant>
#include <vector>

#include "common/pieces/cut_frame.h"
#include "common/transport/frame_packet.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr PeerHandle kRig = 11, kOther = 12;
constexpr SteadyTime kBegin{100s};

EncodedDepthFrame MakeDepth(std::uint64_t number) {
  EncodedDepthFrame frame;
  frame.header = {
      .session = 7, .frame_number = number, .capture_time = CaptureTime(1'700'000'000s)};
  frame.depth_scale = 1000.0;
  frame.image = {.encoding = Encoding::kRaw16, .width = 64, .height = 48, .payload = {}};
  frame.image.payload.resize(64UL * 48 * 2, static_cast<std::uint8_t>(number));
  return frame;
}

/// Cuts frames as a rig does that sends them one after another.
class Cutter {
 public:
  std::vector<FramePiece> Cut(const EncodedDepthFrame& frame, int parity = 0) {
    std::vector<FramePiece> pieces = CutFrame(PackFrame(frame), [&](int) { return parity; });
    for (FramePiece& piece : pieces) {
      piece.session = frame.header.session;
      piece.frame_number = frame.header.frame_number;
      piece.order = order_++;
      piece.sent = sent;
    }
    return pieces;
  }
  Nanoseconds sent{5s};

 private:
  std::uint64_t order_ = 0;
};

class PieceCollectorTest : public ::testing::Test {
 protected:
  std::optional<decltype(RigSample::content)> AddAll(std::vector<FramePiece> pieces,
                                                     PeerHandle peer = kRig,
                                                     SteadyTime now = kBegin) {
    std::optional<decltype(RigSample::content)> whole;
    for (FramePiece& piece : pieces) {
      auto frame = collector_.Add(peer, kRig, std::move(piece), now);
      if (frame) whole = std::move(frame);
    }
    return whole;
  }
  std::uint64_t refused() const { return refusals_.depth.total(); }

  StreamRefusals refusals_;
  PieceCollector collector_{&refusals_};
  Cutter cutter_;
};

TEST_F(PieceCollectorTest, AFrameIsThereAsSoonAsItCanBe) {
  const EncodedDepthFrame sent = MakeDepth(3);
  std::vector<FramePiece> pieces = cutter_.Cut(sent, 2);
  pieces.erase(pieces.begin());  // One is lost.
  pieces.pop_back();             // One is too many.
  const auto whole = AddAll(pieces);
  ASSERT_TRUE(whole.has_value());
  const auto& frame = std::get<EncodedDepthFrame>(*whole);
  EXPECT_EQ(frame.header.frame_number, 3U);
  EXPECT_EQ(frame.header.capture_time, sent.header.capture_time);
  EXPECT_EQ(frame.image.payload, sent.image.payload);
  const auto report = collector_.TakeReport(kRig);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(report->session, 7U);
  EXPECT_EQ(report->next_order, pieces.size() + 1);
  EXPECT_EQ(report->received, pieces.size());
  EXPECT_EQ(report->frames, 1U);
  EXPECT_EQ(report->broken, 0U);
}

TEST_F(PieceCollectorTest, WhatAnotherProcessSendsDoesNotGetInBetween) {
  std::vector<FramePiece> pieces = cutter_.Cut(MakeDepth(3));
  std::vector<FramePiece> others = pieces;
  for (FramePiece& piece : others) std::ranges::fill(piece.bytes, 0);
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) {
    EXPECT_FALSE(collector_.Add(kOther, kRig, FramePiece(others[i]), kBegin));
    EXPECT_FALSE(collector_.Add(kRig, kRig, FramePiece(pieces[i]), kBegin));
  }
  EXPECT_TRUE(collector_.Add(kRig, kRig, std::move(pieces.back()), kBegin));
  EXPECT_FALSE(collector_.Add(kOther, kRig, std::move(others.back()), kBegin));
  EXPECT_EQ(collector_.TakeReport(kRig)->frames, 1U);
  EXPECT_EQ(collector_.TakeReport(kOther)->frames, 0U);
}

TEST_F(PieceCollectorTest, ManyProcessesDoNotCostMoreThanAFew) {
  for (PeerHandle peer = 100; peer < 200; ++peer) {
    static_cast<void>(
        collector_.Add(peer, kRig, FramePiece(cutter_.Cut(MakeDepth(1)).front()), kBegin));
  }
  EXPECT_FALSE(collector_.Add(0, kRig, FramePiece(cutter_.Cut(MakeDepth(1)).front()), kBegin));
  std::vector<PeerHandle> kept;
  for (PeerHandle peer = 0; peer < 200; ++peer) {
    if (collector_.TakeReport(peer)) kept.push_back(peer);
  }
  EXPECT_EQ(kept, (std::vector<PeerHandle>{196, 197, 198, 199})) << "the newest";
}

TEST_F(PieceCollectorTest, NobodyDrivesTheRigOut) {
  std::vector<FramePiece> pieces = cutter_.Cut(MakeDepth(3));
  std::optional<decltype(RigSample::content)> whole;
  for (FramePiece& piece : pieces) {
    for (PeerHandle peer = 100; peer < 110; ++peer) {
      static_cast<void>(collector_.Add(peer, kRig, FramePiece(piece), kBegin));
    }
    whole = collector_.Add(kRig, kRig, std::move(piece), kBegin);
  }
  EXPECT_TRUE(whole);
}

TEST_F(PieceCollectorTest, AFrameThatIsAnotherThanItsPiecesSayIsRefused) {
  std::vector<FramePiece> pieces = cutter_.Cut(MakeDepth(3));
  for (FramePiece& piece : pieces) piece.frame_number = 4;
  EXPECT_FALSE(AddAll(pieces));
  EXPECT_EQ(refused(), 1U);
}

TEST_F(PieceCollectorTest, BytesThatAreNoFrameAreRefused) {
  std::mt19937 random(1);
  const std::vector<std::uint8_t> good = PackFrame(MakeDepth(3));
  std::uint64_t whole = 0;
  constexpr std::uint64_t kInputs = 3'000;
  for (std::uint64_t i = 0; i < kInputs; ++i) {
    std::vector<std::uint8_t> bytes = good;
    for (int changes = 0; changes < 3; ++changes) {
      bytes[random() % (i % 2 == 0 ? 40 : bytes.size())] = static_cast<std::uint8_t>(random());
    }
    if (i % 5 == 0) bytes.resize(1 + random() % bytes.size());
    std::vector<FramePiece> pieces = CutFrame(bytes, [](int) { return 0; });
    for (FramePiece& piece : pieces) {
      piece.session = 7 + i;
      piece.frame_number = 3;
    }
    whole += AddAll(pieces) ? 1 : 0;
  }
  EXPECT_EQ(refused(), kInputs - whole);
  EXPECT_GT(refused(), kInputs / 2) << "of another session, at least";
}

TEST_F(PieceCollectorTest, ANewSessionIsCountedAnew) {
  static_cast<void>(AddAll(cutter_.Cut(MakeDepth(0))));
  EncodedDepthFrame next = MakeDepth(0);
  next.header.session = 8;
  const std::vector<FramePiece> pieces = cutter_.Cut(next);
  static_cast<void>(AddAll(pieces));
  const auto report = collector_.TakeReport(kRig);
  EXPECT_EQ(report->session, 8U);
  EXPECT_EQ(report->received, pieces.size());
  EXPECT_EQ(report->frames, 1U);
}

TEST_F(PieceCollectorTest, PiecesThatWaitBeforeTheLinkShow) {
  // Six pieces of a frame, so that runs of sixteen go across frames.
  const auto send = [&](Nanoseconds took, int frames, int slow_every) {
    int piece = 0;
    for (int i = 0; i < frames; ++i) {
      for (FramePiece& each : cutter_.Cut(MakeDepth(1))) {
        const Nanoseconds more = slow_every > 0 && ++piece % slow_every == 0 ? 300ms : 0ms;
        static_cast<void>(
            collector_.Add(kRig, kRig, std::move(each), SteadyTime(cutter_.sent + took + more)));
      }
      cutter_.sent += 33ms;
    }
    return collector_.TakeReport(kRig)->queued;
  };
  // The clocks differ by a day.
  EXPECT_EQ(send(24h + 30ms, 20, 0), 0ms);
  EXPECT_EQ(send(24h + 110ms, 20, 0), 80ms);
  EXPECT_EQ(send(24h + 30ms, 2, 0), 0ms) << "of the time since the last report";
  EXPECT_EQ(send(24h + 30ms, 40, 3), 0ms) << "single ones are late";
  EXPECT_FALSE(collector_.TakeReport(kRig)) << "nothing came since";
  // A way that has become longer is no queue for long, and neither are clocks that ran apart.
  static_cast<void>(send(24h + 130ms, 400, 0));
  EXPECT_EQ(send(24h + 130ms, 20, 0), 0ms);
  cutter_.sent += 1h;
  EXPECT_EQ(send(24h + 310ms, 20, 0), 0ms);
}

}  // namespace
}  // namespace isotherm
