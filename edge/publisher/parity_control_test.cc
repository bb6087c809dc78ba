#include "edge/publisher/parity_control.h"

#include <gtest/gtest.h>

#include <random>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// A ground that reports twenty times a second, and a link that says of each piece whether it is
/// lost.
class Reports {
 public:
  template <typename IsLost>
  void Run(int reports, int pieces, const IsLost& is_lost, bool is_full = false) {
    for (int i = 0; i < reports; ++i) {
      now_ += 50ms;
      for (int piece = 0; piece < pieces; ++piece) {
        ++report_.next_order;
        if (!is_lost()) ++report_.received;
      }
      report_.frames += 4;
      control_.OnReport(report_, is_full, now_);
    }
  }
  void Break(std::uint64_t frames) { report_.broken += frames; }

  ParityControl& control() { return control_; }

 private:
  ParityControl control_;
  PieceReport report_;
  SteadyTime now_{1s};
};

/// Returns of how many frames in a million more than `parity` of all pieces are lost.
double BrokenPerMillion(int data, int parity, double loss, std::mt19937* random) {
  std::binomial_distribution<int> lost(data + parity, loss);
  int broken = 0;
  constexpr int kFrames = 1'000'000;
  for (int i = 0; i < kFrames; ++i) broken += lost(*random) > parity ? 1 : 0;
  return broken;
}

TEST(ParityControlTest, OneFrameInAThousandIsNotWhole) {
  std::mt19937 random(1);
  for (const double loss : {0.01, 0.05, 0.2, 0.3}) {
    Reports reports;
    // Every so many pieces: the measured loss is the true one.
    int piece = 0;
    reports.Run(40, 300, [&] { return ++piece % static_cast<int>(1.0 / loss) == 0; });
    const double measured = 1.0 / static_cast<int>(1.0 / loss);
    EXPECT_NEAR(reports.control().loss(), measured, 0.01);
    for (const int data : {10, 65, 128}) {
      const int parity = reports.control().PiecesFor(data);
      EXPECT_LE(BrokenPerMillion(data, parity, measured, &random), 1'100) << loss << " " << data;
      EXPECT_GT(BrokenPerMillion(data, parity - 1, measured, &random), 900) << loss << " " << data;
    }
  }
}

TEST(ParityControlTest, AFirstLossCostsNoFrame) {
  ParityControl control;
  EXPECT_GE(control.PiecesFor(65), 5);
  Reports reports;
  reports.Run(40, 300, [] { return false; });
  EXPECT_GE(reports.control().PiecesFor(65), 2);
  EXPECT_LE(reports.control().PiecesFor(65), 4);
}

TEST(ParityControlTest, WhatAFullLinkLosesIsNoReasonForMore) {
  Reports reports;
  reports.Run(40, 300, [] { return false; });
  const int before = reports.control().PiecesFor(65);
  int piece = 0;
  const auto every_second = [&] { return ++piece % 2 == 0; };
  reports.Run(20, 300, every_second, true);
  EXPECT_EQ(reports.control().PiecesFor(65), before);
  reports.Run(2, 300, [] { return false; });
  EXPECT_EQ(reports.control().PiecesFor(65), before) << "nor is it remembered";
  reports.Run(20, 300, every_second);
  EXPECT_GT(reports.control().PiecesFor(65), 40) << "the same losses, and nothing waits";
}

TEST(ParityControlTest, FramesThatBreakAllTheSameGetMore) {
  Reports reports;
  reports.Run(40, 300, [] { return false; });
  const int before = reports.control().PiecesFor(65);
  for (int i = 0; i < 60; ++i) {
    reports.Break(1);
    reports.Run(1, 300, [] { return false; });
  }
  EXPECT_GE(reports.control().PiecesFor(65), 2 * before);
  EXPECT_LE(reports.control().PiecesFor(65), 3 * before);
  reports.Run(400, 300, [] { return false; });
  EXPECT_EQ(reports.control().PiecesFor(65), before);
}

TEST(ParityControlTest, HopelessLossesAreNotPaidForWithoutEnd) {
  Reports reports;
  for (int i = 0; i < 200; ++i) {
    reports.Break(4);
    reports.Run(1, 300, [] { return true; });
  }
  EXPECT_EQ(reports.control().loss(), 1.0);
  EXPECT_EQ(reports.control().PiecesFor(65), 65);
}

TEST(ParityControlTest, AGroundThatBeginsAnewOrWasNotHeardSaysNothingOfTheTimeBetween) {
  Reports reports;
  reports.Run(40, 300, [] { return false; });
  ParityControl& control = reports.control();
  const int before = control.PiecesFor(65);
  // Pieces count on, and the ground has nothing of those before.
  control.OnReport({.next_order = 20'000, .received = 300}, false, SteadyTime(4s));
  control.OnReport({.next_order = 20'300, .received = 600}, false, SteadyTime(4s + 50ms));
  EXPECT_EQ(control.loss(), 0.0);
  EXPECT_EQ(control.PiecesFor(65), before);
  control.OnReport({.next_order = 30'300, .received = 900}, false, SteadyTime(10s));
  control.OnReport({.next_order = 30'600, .received = 1'200}, false, SteadyTime(10s + 50ms));
  EXPECT_EQ(control.PiecesFor(65), before);
}

}  // namespace
}  // namespace isotherm
