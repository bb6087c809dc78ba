#include "ground/subscriber/stream_refusals.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

template <typename Frame>
RigSample MakeFrame() {
  Frame frame;
  frame.header.session = 7;
  return {.content = frame};
}

TEST(StreamRefusalsTest, AFrameCountsForItsStreamAndForTheWhole) {
  StreamRefusals refusals;
  refusals.Add(MakeFrame<EncodedDepthFrame>(), RefusalCause::kOtherSession);
  refusals.Add(MakeFrame<EncodedDepthFrame>(), RefusalCause::kOtherWriter);
  refusals.Add(MakeFrame<EncodedThermalFrame>(), RefusalCause::kOtherWriter);
  EXPECT_EQ(refusals.depth.total(), 2U);
  EXPECT_EQ(refusals.thermal.total(), 1U);
  EXPECT_EQ(refusals.all.total(), 3U);
  EXPECT_EQ(refusals.depth.count(RefusalCause::kOtherSession), 1U);
  EXPECT_EQ(refusals.thermal.count(RefusalCause::kOtherSession), 0U);
  EXPECT_EQ(refusals.all.count(RefusalCause::kOtherWriter), 2U);
}

TEST(StreamRefusalsTest, WhatIsNoFrameIsOfNoStream) {
  StreamRefusals refusals;
  refusals.Add({.content = RigDescription{}}, RefusalCause::kOtherWriter);
  refusals.Add({.content = EdgeStatus{}}, RefusalCause::kOtherWriter);
  refusals.Add({.content = ExternalOdometrySample{}}, RefusalCause::kUnannounced);
  refusals.Add({.content = CommandResult{}}, RefusalCause::kOtherWriter);
  EXPECT_EQ(refusals.all.total(), 4U);
  EXPECT_EQ(refusals.depth.total(), 0U);
  EXPECT_EQ(refusals.thermal.total(), 0U);
}

}  // namespace
}  // namespace isotherm
