#include "ground/feedback/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <vector>

#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Between messages at 10 Hz.
constexpr Nanoseconds kPeriod = 100ms;

class AdviceTest : public ::testing::Test {
 protected:
  AdviceTest() {
    view_.surface = 0.8;
    view_.never_measured = 1.0;
    situation_.max_speed_m_s = 0.3;
    situation_.max_rotation_rate_deg_s = 18.0;
  }

  OperatorAdvice Next() {
    now_ += kPeriod;
    return adviser_.Update(now_, view_, situation_);
  }
  /// Returns what is said when nothing changes for two seconds.
  OperatorAdvice Settled() {
    OperatorAdvice advice;
    for (int i = 0; i < 20; ++i) advice = Next();
    return advice;
  }
  /// Kinds of the next `count` messages, `change` being called before each.
  template <typename Change>
  std::vector<AdviceKind> Messages(int count, const Change& change) {
    std::vector<AdviceKind> kinds;
    for (int i = 0; i < count; ++i) {
      change();
      kinds.push_back(Next().kind);
    }
    return kinds;
  }
  static int Changes(const std::vector<AdviceKind>& kinds) {
    int changes = 0;
    for (std::size_t i = 1; i < kinds.size(); ++i) changes += kinds[i] != kinds[i - 1] ? 1 : 0;
    return changes;
  }

  FeedbackOptions options_;
  CoverageSummary view_;
  ScanSituation situation_;
  CaptureTime now_{1h};
  OperatorAdviser adviser_{options_, WithAnglesOfMaterial(ThermalOptions())};
};

TEST_F(AdviceTest, EachHindranceHasItsAdviceAndItsNumbers) {
  view_.too_far = 0.4;
  EXPECT_EQ(Settled().kind, AdviceKind::kCloser);
  EXPECT_EQ(Settled().reason, "40 % of the surface is farther than 0.60 m");
  view_.too_far = 0.0;
  view_.too_near = 0.3;
  EXPECT_EQ(Settled().kind, AdviceKind::kFarther);
  EXPECT_THAT(Settled().reason, HasSubstr("nearer than 0.30 m"));
  view_.too_near = 0.0;
  view_.too_oblique = 0.3;
  EXPECT_EQ(Settled().kind, AdviceKind::kLessOblique);
  EXPECT_THAT(Settled().reason, HasSubstr("more than 38.5 deg"));
  view_.too_oblique = 0.0;
  view_.too_frontal = 0.3;
  EXPECT_EQ(Settled().kind, AdviceKind::kMoreOblique);
  EXPECT_THAT(Settled().reason, HasSubstr("reflects you"));
  view_.too_frontal = 0.0;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
  EXPECT_THAT(Settled().reason, IsEmpty());
}

TEST_F(AdviceTest, WhatHindersMostIsSaid) {
  view_.too_far = 0.3;
  view_.too_oblique = 0.5;
  EXPECT_EQ(Settled().kind, AdviceKind::kLessOblique);
}

TEST_F(AdviceTest, WhatMakesTheRestPointlessComesFirst) {
  view_.too_far = 0.4;
  situation_.speed_m_s = 0.5;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower);
  EXPECT_EQ(Settled().reason, "0.50 m/s, the model follows up to 0.30 m/s");
  situation_.model_good = 0.9;
  EXPECT_EQ(Settled().kind, AdviceKind::kDone);
  situation_.nuc_running = true;
  EXPECT_EQ(Next().kind, AdviceKind::kHoldForNuc);
  situation_.tracking_lost = true;
  EXPECT_EQ(Next().kind, AdviceKind::kGoBack);
  EXPECT_THAT(Next().reason, HasSubstr("tracking is lost"));
}

TEST_F(AdviceTest, WhereTheViewSlidesNothingIsAddedAndThatIsSaid) {
  situation_.slides = true;
  EXPECT_EQ(Next().kind, AdviceKind::kGoBack);
  EXPECT_THAT(Next().reason, HasSubstr("the view slides on itself, nothing is added to the model"));
  situation_.tracking_lost = true;
  EXPECT_THAT(Next().reason, HasSubstr("tracking is lost"));
  situation_ = {};
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
}

TEST_F(AdviceTest, TurningTooFastIsTooFast) {
  situation_.rotation_rate_deg_s = 30.0;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower);
  EXPECT_EQ(Settled().reason, "turning at 30 deg/s, the model follows up to 18 deg/s");
}

TEST_F(AdviceTest, OnTheWayToANextViewSmearDoesNotMatterButHurryDoes) {
  view_.too_fast = 0.4;
  view_.smear_px = 1.5;
  situation_.speed_m_s = 0.25;
  situation_.is_on_the_way = true;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
  situation_.speed_m_s = 0.31;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower) << "the model does not follow";
  situation_.speed_m_s = 0.2;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
  situation_.is_on_the_way = false;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower) << "it has arrived, and is not at rest";
}

TEST_F(AdviceTest, MotionThatSmearsTheThermalImageIsTooFast) {
  view_.too_fast = 0.4;
  view_.smear_px = 1.25;
  situation_.speed_m_s = 0.2;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower);
  EXPECT_EQ(Settled().reason, "0.20 m/s smears 1.2 px, 0.5 px are good: 0.08 m/s");
  situation_.speed_m_s = 0.01;
  situation_.rotation_rate_deg_s = 15.0;
  EXPECT_EQ(Settled().reason, "turning at 15 deg/s smears 1.2 px, 0.5 px are good: 6 deg/s");
  view_.too_fast = 0.05;
  situation_ = {};
  EXPECT_EQ(Settled().kind, AdviceKind::kNone) << "nothing much would be gained";
}

TEST_F(AdviceTest, AGroundThatIsBehindIsWaitedFor) {
  situation_.ground_is_behind = true;
  EXPECT_EQ(Settled().kind, AdviceKind::kSlower);
  EXPECT_THAT(Settled().reason, HasSubstr("hold still"));
  situation_.ground_is_behind = false;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
}

TEST_F(AdviceTest, AViewWithoutTheObjectIsSaid) {
  view_ = {};
  EXPECT_EQ(Settled().kind, AdviceKind::kGoBack);
  EXPECT_THAT(Settled().reason, HasSubstr("point at the object"));
}

TEST_F(AdviceTest, AViewThatIsMeasuredWellSendsOn) {
  view_.good = 0.92;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
  EXPECT_EQ(Settled().reason, "92 % in view is measured well: go on");
}

TEST_F(AdviceTest, TheScanIsDoneFromTheAskedFractionOnAndNotBefore) {
  situation_.model_good = options_.done_fraction() - 0.001;
  EXPECT_NE(Settled().kind, AdviceKind::kDone);
  EXPECT_FALSE(adviser_.done());
  situation_.model_good = options_.done_fraction();
  EXPECT_EQ(Settled().kind, AdviceKind::kDone);
  EXPECT_TRUE(adviser_.done());
  situation_.model_good = options_.done_fraction() - 0.02;  // A little more surface came into view.
  EXPECT_EQ(Settled().kind, AdviceKind::kDone);
  situation_.model_good = options_.done_fraction() - 0.04;
  EXPECT_NE(Settled().kind, AdviceKind::kDone);
  EXPECT_FALSE(adviser_.done());
}

TEST_F(AdviceTest, WhileTheModelIsNotCountedTheScanIsNotDone) {
  view_.good = 1.0;
  EXPECT_NE(Settled().kind, AdviceKind::kDone);
}

TEST_F(AdviceTest, NoiseAroundAThresholdDoesNotFlicker) {
  constexpr std::uint32_t kSeed = 5;
  std::cout << "seed " << kSeed << "\n";
  std::minstd_rand random(kSeed);
  // Within the two thresholds half of the time, beyond each of them a quarter.
  std::uniform_real_distribution<double> fraction(0.5 * (0.10 + 0.15) - 0.05,
                                                  0.5 * (0.10 + 0.15) + 0.05);
  std::vector<AdviceKind> raw;
  const std::vector<AdviceKind> said = Messages(600, [&] {  // One minute.
    view_.too_far = fraction(random);
    raw.push_back(view_.too_far > 0.125 ? AdviceKind::kCloser : AdviceKind::kNone);
  });
  EXPECT_GT(Changes(raw), 200) << "the sequence is meant to be hard";
  // What is due for settle_s on end, three messages, still changes: rarely, and never within
  // show_s.
  EXPECT_LE(Changes(said), 40);
  int last = 0;
  for (int i = 1; i < static_cast<int>(said.size()); ++i) {
    if (said[static_cast<std::size_t>(i)] == said[static_cast<std::size_t>(i - 1)]) continue;
    const bool withdrawn = said[static_cast<std::size_t>(i)] == AdviceKind::kNone;
    if (withdrawn) {
      EXPECT_GE((i - last) * kPeriod, FromSeconds(options_.expert().show_s()));
    }
    last = i;
  }
}

TEST_F(AdviceTest, SmallNoiseAroundAThresholdChangesNothing) {
  constexpr std::uint32_t kSeed = 6;
  std::cout << "seed " << kSeed << "\n";
  std::minstd_rand random(kSeed);
  std::uniform_real_distribution<double> noise(-0.02, 0.02);
  const std::vector<AdviceKind> closer =
      Messages(600, [&] { view_.too_far = options_.expert().advise_fraction() + noise(random); });
  EXPECT_LE(Changes(closer), 1);
  EXPECT_EQ(closer.back(), AdviceKind::kCloser);
  view_.too_far = 0.0;
  Settled();
  const std::vector<AdviceKind> slower = Messages(
      600, [&] { situation_.speed_m_s = situation_.max_speed_m_s * (1.0 + 5.0 * noise(random)); });
  EXPECT_LE(Changes(slower), 1);
  view_.too_oblique = view_.too_far = 0.0;
  situation_.speed_m_s = 0.0;
  Settled();
  const std::vector<AdviceKind> equals = Messages(600, [&] {
    view_.too_far = 0.4 + noise(random);
    view_.too_oblique = 0.4 + noise(random);
  });
  EXPECT_LE(Changes(equals), 1) << "of two hindrances of the same size one is said";
}

TEST_F(AdviceTest, ABriefCauseIsNotSaid) {
  Settled();
  view_.too_far = 0.5;
  EXPECT_EQ(Next().kind, AdviceKind::kNone);
  EXPECT_EQ(Next().kind, AdviceKind::kNone);
  view_.too_far = 0.0;
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
}

TEST_F(AdviceTest, AnAlarmIsSaidAtOnceAndStaysForAWhileWithItsReason) {
  Settled();
  situation_.tracking_lost = true;
  EXPECT_EQ(Next().kind, AdviceKind::kGoBack);
  situation_.tracking_lost = false;
  const OperatorAdvice after = Next();
  EXPECT_EQ(after.kind, AdviceKind::kGoBack);
  EXPECT_THAT(after.reason, HasSubstr("tracking is lost"));
  EXPECT_EQ(Settled().kind, AdviceKind::kNone);
}

TEST(FeedbackOptionsTest, WhatMakesNoSenseIsSaid) {
  EXPECT_TRUE(Validate(FeedbackOptions()).ok());
  const auto message = [](const auto& set) {
    FeedbackOptions options;
    set(options);
    return Validate(options).message();
  };
  EXPECT_THAT(message([](auto& o) { o.set_done_fraction(1.5); }),
              HasSubstr("feedback.done_fraction"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_withdraw_fraction(0.5); }),
              HasSubstr("withdraw_fraction"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_settle_s(-1); }),
              HasSubstr("settle_s"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_blocks_per_message(0); }),
              HasSubstr("blocks"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_views_per_message(-1); }),
              HasSubstr("views"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_min_gain_m2(0); }),
              HasSubstr("min_gain_m2"));
  EXPECT_THAT(message([](auto& o) { o.mutable_expert()->set_image_width_px(10); }),
              HasSubstr("image_width_px"));
}

}  // namespace
}  // namespace isotherm
