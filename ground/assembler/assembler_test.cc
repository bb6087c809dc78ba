#include "ground/assembler/assembler.h"

#include <gtest/gtest.h>

#include <string>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

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

  Assembler assembler_{100ms};
};

TEST_F(AssemblerTest, ReleasesInCaptureTimeOrderWhateverTheOrderOfArrival) {
  Depth(0);
  Depth(33);
  EXPECT_EQ(PopAll(), "");  // A thermal frame could still belong before them.
  Thermal(7);
  EXPECT_EQ(PopAll(), "d0 t7");
  Thermal(32);
  Thermal(57);
  EXPECT_EQ(PopAll(), "t32 d33 t57");
}

TEST_F(AssemblerTest, DepthComesFirstAtEqualTimes) {
  Thermal(10);
  Depth(10);
  EXPECT_EQ(PopAll(), "d10");
  Depth(20);
  EXPECT_EQ(PopAll(), "t10");
}

TEST_F(AssemblerTest, AStreamThatStopsHoldsTheOtherUpOnlyForTheLongestWait) {
  for (int ms = 0; ms <= 200; ms += 50) Depth(ms);
  EXPECT_EQ(PopAll(), "d0 d50");  // 100 ms and less are still waiting.
  EXPECT_EQ(assembler_.waiting(), 3U);
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
