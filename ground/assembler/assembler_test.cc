#include "ground/assembler/assembler.h"

#include <gtest/gtest.h>

#include <string>

namespace isotherm {
namespace {

class AssemblerTest : public ::testing::Test {
 protected:
  void Depth(std::int64_t ms) {
    auto frame = std::make_shared<DepthFrame>();
    frame->header.capture_time = CaptureTime(std::chrono::milliseconds(ms));
    assembler_.Add(DepthFramePtr(frame));
  }
  void Thermal(std::int64_t ms) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = CaptureTime(std::chrono::milliseconds(ms));
    assembler_.Add(ThermalFramePtr(frame));
  }
  static std::string Name(const Assembler::Frame& frame) {
    return std::visit(
        [](const auto& pointer) {
          const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(
              pointer->header.capture_time.time_since_epoch());
          return (std::is_same_v<std::decay_t<decltype(pointer)>, DepthFramePtr> ? "d" : "t") +
                 std::to_string(ms.count());
        },
        frame);
  }
  /// Names of all frames that can be popped, e.g. "d0 t7".
  std::string PopAll() {
    std::string names;
    while (const auto frame = assembler_.Pop()) names += (names.empty() ? "" : " ") + Name(*frame);
    return names;
  }

  static constexpr std::size_t kMaxHeld = 3;
  Assembler assembler_{true, kMaxHeld};
};

TEST_F(AssemblerTest, ReleasesInCaptureTimeOrderWhateverTheOrderOfArrival) {
  Depth(0);
  Depth(33);
  EXPECT_EQ(PopAll(), "");  // A thermal frame could still belong before them.
  Thermal(7);
  EXPECT_EQ(PopAll(), "d0 t7");
  Thermal(32);
  Thermal(57);
  EXPECT_EQ(PopAll(), "t32 d33");  // A depth frame could still come before 57.
}

TEST_F(AssemblerTest, DepthComesFirstAtEqualTimes) {
  Thermal(10);
  Depth(10);
  EXPECT_EQ(PopAll(), "d10");
  Depth(20);
  EXPECT_EQ(PopAll(), "t10");
}

TEST_F(AssemblerTest, F04AStreamThatStopsIsNotWaitedForAnyMore) {
  for (int ms = 0; ms <= 150; ms += 50) Depth(ms);
  EXPECT_EQ(PopAll(), "d0 d50 d100 d150");  // One more than may be held.
  Depth(200);
  EXPECT_EQ(PopAll(), "d200");
}

TEST_F(AssemblerTest, AStreamThatDeliversAgainIsWaitedForAgain) {
  for (int ms = 0; ms <= 150; ms += 50) Depth(ms);
  PopAll();
  Thermal(160);
  Depth(200);
  EXPECT_EQ(PopAll(), "t160");
  EXPECT_EQ(assembler_.waiting(), 1U);
}

TEST_F(AssemblerTest, StreamsFarApartInTimeAreNotTakenForStalled) {
  Depth(0);
  Depth(5000);
  Thermal(7);
  Thermal(4990);
  EXPECT_EQ(PopAll(), "d0 t7 t4990");
  EXPECT_EQ(assembler_.refused_late(), 0U);
}

TEST(AssemblerWithoutThermalTest, HoldsNothingBack) {
  Assembler assembler(false);
  assembler.Add(std::make_shared<const DepthFrame>());
  EXPECT_TRUE(assembler.Pop().has_value());
}

TEST_F(AssemblerTest, F21SwappedFramesAreSortedAndTooLateOnesCounted) {
  Depth(33);
  Depth(0);
  Thermal(40);
  EXPECT_EQ(PopAll(), "d0 d33");
  Depth(20);
  EXPECT_EQ(assembler_.refused_late(), 1U);
}

TEST_F(AssemblerTest, FlushGivesAllThatIsLeftInOrder) {
  Depth(33);
  Thermal(7);
  Depth(0);
  std::string names;
  while (const auto frame = assembler_.Flush()) names += Name(*frame) + " ";
  EXPECT_EQ(names, "d0 t7 d33 ");
}

}  // namespace
}  // namespace isotherm
