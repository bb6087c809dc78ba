#include "edge/publisher/piece_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <random>
#include <utility>
#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// A rig with both cameras whose pieces go one behind the other over a link of a certain rate, with
/// a buffer before it that holds so much time of that rate, and a ground that says twenty times a
/// second what it has. Frames wait at the rig while others are being sent.
class PacedPieces {
 public:
  static constexpr double kDepth_bits = 0.9e6, kThermal_bits = 0.4e6;  // 43 Mbit/s.
  static constexpr std::size_t kPieceBytes = 1'400;

  explicit PacedPieces(double rate_bit_s, Nanoseconds buffer = 100ms)
      : rate_bit_s_(rate_bit_s), buffer_(buffer) {}

  void set_rate(double rate_bit_s) { rate_bit_s_ = rate_bit_s; }
  void set_loss(double loss) { loss_ = loss; }
  void set_jitter(Nanoseconds jitter) { jitter_ = jitter; }
  /// The depth camera is unplugged.
  void TakeDepth() { next_[0] = SteadyTime::max(); }
  void set_depth_bits(double bits) { depth_bits_ = bits; }
  /// Nothing gets through in either direction.
  void set_cut(bool is_cut) { is_cut_ = is_cut; }
  void Forget() {
    delays_s_.clear();
    sent_pieces_ = lost_pieces_ = captured_ = 0;
    since_ = now_;
  }

  void Run(Nanoseconds duration) {
    const SteadyTime end = now_ + duration;
    for (; now_ < end; now_ += 100us) {
      if (now_ >= next_[0]) Capture(Sensor::kDepth, depth_bits_, 33333us);
      if (now_ >= next_[1]) Capture(Sensor::kThermal, kThermal_bits, 25ms);
      Send();
      Arrive();
      if (now_ < report_due_) continue;
      report_due_ = now_ + 50ms;
      report_.queued = std::exchange(slowest_, Nanoseconds(0));
      if (!is_cut_) reports_.push_back({now_ + kDelay, report_});
    }
  }

  PiecePace& pace() { return pace_; }
  std::size_t frames() const { return delays_s_.size(); }
  std::size_t captured() const { return captured_; }
  /// From a frame's capture until its last piece is there.
  double DelayQuantile_s(double quantile) const {
    std::vector<double> sorted = delays_s_;
    std::ranges::sort(sorted);
    return sorted.at(static_cast<std::size_t>(quantile * static_cast<double>(sorted.size() - 1)));
  }
  std::size_t sent_pieces() const { return sent_pieces_; }
  double lost() const {
    return static_cast<double>(lost_pieces_) / static_cast<double>(sent_pieces_);
  }
  /// Returns what arrived, bit/s.
  double arrived_bit_s() const {
    return static_cast<double>(sent_pieces_ - lost_pieces_) * kPieceBytes * 8.0 /
           ToSeconds(now_ - since_);
  }

 private:
  static constexpr Nanoseconds kDelay = 20ms;

  struct Frame {
    Sensor sensor;
    SteadyTime captured;
    std::size_t pieces, left;
  };

  void Capture(Sensor sensor, double bits, Nanoseconds period) {
    next_.at(static_cast<std::size_t>(sensor)) += period;
    ++captured_;
    const auto pieces = static_cast<std::size_t>(bits / 8.0 / kPieceBytes) + 1;
    queue_.push_back({sensor, now_, pieces, pieces});
  }
  void Send() {
    while (!sending_ && !queue_.empty()) {
      const Frame frame = queue_.front();
      queue_.pop_front();
      if (pace_.TakesNext(frame.sensor, queue_.size(), now_)) sending_ = frame;
    }
    while (sending_ && turn_ <= now_) {
      turn_ = std::max(turn_, now_) + FromSeconds(8.0 * kPieceBytes / pace_.rate_bit_s());
      SendPiece(*sending_);
      if (--sending_->left > 0) continue;
      pace_.OnSent(sending_->sensor, sending_->pieces, kPieceBytes, now_);
      sending_.reset();
    }
  }
  void SendPiece(const Frame& frame) {
    ++order_;
    ++sent_pieces_;
    link_free_ = std::max(link_free_, now_);
    const bool lost = is_cut_ || link_free_ - now_ > buffer_ || chance_(random_) < loss_;
    if (lost) {
      ++lost_pieces_;
      return;
    }
    link_free_ += FromSeconds(8.0 * kPieceBytes / rate_bit_s_);
    const Nanoseconds late = FromSeconds(chance_(random_) * ToSeconds(jitter_));
    const auto captured = frame.left == 1 ? std::optional(frame.captured) : std::nullopt;
    under_way_.emplace(link_free_ + kDelay + late, Piece{now_, order_, captured});
  }
  void Arrive() {
    while (!under_way_.empty() && under_way_.begin()->first <= now_) {
      const auto& [there, piece] = *under_way_.begin();
      report_.next_order = std::max(report_.next_order, piece.order);
      ++report_.received;
      const Nanoseconds took = there - piece.sent;
      quickest_ = std::min(quickest_, took);
      of_run_ = std::min(of_run_, took);
      if (report_.received % 16 == 0) {
        slowest_ = std::max(slowest_, std::exchange(of_run_, Nanoseconds::max()) - quickest_);
      }
      if (piece.captured) delays_s_.push_back(ToSeconds(there - *piece.captured));
      under_way_.erase(under_way_.begin());
    }
    while (!reports_.empty() && reports_.front().first <= now_) {
      pace_.OnReport(reports_.front().second, now_);
      reports_.pop_front();
    }
  }

  struct Piece {
    SteadyTime sent;
    std::uint64_t order;
    std::optional<SteadyTime> captured;  ///< A frame's last one has it.
  };

  PiecePace pace_;
  double rate_bit_s_;
  Nanoseconds buffer_;
  double depth_bits_ = kDepth_bits;
  double loss_ = 0.0;
  Nanoseconds jitter_{};
  bool is_cut_ = false;
  SteadyTime now_{1s}, turn_{}, link_free_{}, report_due_{}, since_{1s};
  std::array<SteadyTime, 2> next_{};
  std::deque<Frame> queue_;
  std::optional<Frame> sending_;
  std::multimap<SteadyTime, Piece> under_way_;  ///< By arrival.
  std::deque<std::pair<SteadyTime, PieceReport>> reports_;
  PieceReport report_;
  std::uint64_t order_ = 0;
  Nanoseconds quickest_ = Nanoseconds::max(), of_run_ = Nanoseconds::max(), slowest_{};
  std::vector<double> delays_s_;
  std::size_t sent_pieces_ = 0, lost_pieces_ = 0, captured_ = 0;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> chance_{0.0, 1.0};
};

TEST(PiecePaceTest, AWideLinkCarriesEveryFrame) {
  PacedPieces link(100e6);
  link.Run(1s);
  link.Forget();
  link.Run(10s);
  EXPECT_GE(link.frames() + 8, link.captured()) << "but those under way";
  EXPECT_LT(link.DelayQuantile_s(0.99), 0.08);
  EXPECT_FALSE(link.pace().leaves_frames());
}

TEST(PiecePaceTest, ANarrowLinkIsUsedAndNotFilled) {
  for (const double rate_bit_s : {4e6, 8e6, 16e6, 24e6}) {
    PacedPieces link(rate_bit_s);
    link.Run(3s);
    link.Forget();
    link.Run(20s);
    EXPECT_GT(link.arrived_bit_s(), 0.6 * rate_bit_s) << rate_bit_s;
    EXPECT_LT(link.lost(), 0.005) << rate_bit_s;
    // A depth frame alone takes 0.9 Mbit.
    EXPECT_LT(link.DelayQuantile_s(0.99), 0.25 + 0.9e6 / rate_bit_s) << rate_bit_s;
    EXPECT_TRUE(link.pace().leaves_frames()) << rate_bit_s;
  }
}

TEST(PiecePaceTest, ADeepBufferStaysEmpty) {
  PacedPieces link(8e6, 5s);
  link.Run(5s);
  link.Forget();
  link.Run(20s);
  EXPECT_LT(link.DelayQuantile_s(0.99), 0.4);
  EXPECT_GT(link.arrived_bit_s(), 0.6 * 8e6);
}

TEST(PiecePaceTest, LossesWithoutAQueueChangeNothing) {
  PacedPieces link(100e6);
  link.set_loss(0.2);
  link.Run(1s);
  link.Forget();
  link.Run(10s);
  EXPECT_FALSE(link.pace().leaves_frames());
  EXPECT_NEAR(link.lost(), 0.2, 0.01);
}

TEST(PiecePaceTest, NeitherDoesJitterOfSinglePieces) {
  PacedPieces link(100e6);
  link.set_jitter(80ms);
  link.Run(1s);
  link.Forget();
  link.Run(10s);
  EXPECT_FALSE(link.pace().leaves_frames());
}

TEST(PiecePaceTest, ALinkThatChangesIsFollowed) {
  PacedPieces link(100e6);
  link.Run(5s);
  link.set_rate(8e6);
  link.Run(2s);
  link.Forget();
  link.Run(10s);
  EXPECT_LT(link.lost(), 0.005);
  EXPECT_LT(link.DelayQuantile_s(0.99), 0.4);
  link.set_rate(100e6);
  link.Run(12s);
  EXPECT_FALSE(link.pace().leaves_frames());
}

TEST(PiecePaceTest, WhereNothingIsHeardAFrameNowAndThen) {
  PacedPieces link(100e6);
  link.Run(3s);
  link.set_cut(true);
  link.Run(2s);
  link.Forget();
  link.Run(10s);
  EXPECT_EQ(link.frames(), 0U);
  // Two each second of each stream, of some 80 and 36 pieces.
  EXPECT_GT(link.sent_pieces(), 1'800U);
  EXPECT_LT(link.sent_pieces(), 2'500U);
  link.set_cut(false);
  link.Run(2s);
  link.Forget();
  link.Run(5s);
  EXPECT_GE(link.frames() + 8, link.captured());
}

TEST(PiecePaceTest, ACameraThatIsGoneTakesNothing) {
  PacedPieces link(8e6);
  link.Run(10s);
  EXPECT_GE(link.pace().stride(Sensor::kThermal), 6);
  link.TakeDepth();
  link.Run(10s);
  EXPECT_LE(link.pace().stride(Sensor::kThermal), 4);
}

TEST(PiecePaceTest, ARateThatIsNotUsedIsNotTakenForTheLinks) {
  PacedPieces link(24e6);
  link.set_depth_bits(1e4);  // Little to see, for 16 Mbit/s in all.
  link.Run(20s);
  EXPECT_LT(link.pace().rate_bit_s(), 60e6);
  link.set_depth_bits(0.9e6);
  link.Forget();
  link.Run(3s);
  EXPECT_LT(link.lost(), 0.1);
}

TEST(PiecePaceTest, WithoutAGroundThatReportsAllAreSent) {
  PiecePace pace;
  SteadyTime now(1s);
  for (int i = 0; i < 100; ++i, now += 33ms) {
    // The first of what the cameras take: nothing is known of the link, and nothing says no.
    if (pace.TakesNext(Sensor::kDepth, 0, now)) pace.OnSent(Sensor::kDepth, 20, 1'400, now);
  }
  EXPECT_EQ(pace.rate_bit_s(), PiecePace::kFirstRate_bit_s);
  EXPECT_EQ(pace.stride(Sensor::kDepth), 1);
}

}  // namespace
}  // namespace isotherm
