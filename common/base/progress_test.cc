#include "common/base/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

namespace isotherm {
namespace {

using std::chrono::steady_clock;
using ::testing::HasSubstr;
using ::testing::Not;

class ProgressBarTest : public ::testing::Test {
 protected:
  ProgressBarTest() : file_(std::tmpfile()) {}
  ~ProgressBarTest() override { std::fclose(file_); }

  std::unique_ptr<ProgressBar> Make(bool terminal) {
    return std::make_unique<ProgressBar>("rendering", 200, "frames", file_, terminal,
                                         [this] { return now_; });
  }
  std::string Output() {
    std::fflush(file_);
    std::string text(static_cast<std::size_t>(std::ftell(file_)), ' ');
    std::rewind(file_);
    EXPECT_EQ(std::fread(text.data(), 1, text.size(), file_), text.size());
    return text;
  }

  std::FILE* file_;
  steady_clock::time_point now_{};
};

TEST_F(ProgressBarTest, WritesOneLineAtEachTenthWhenNotOnATerminal) {
  auto bar = Make(false);
  for (int i = 0; i <= 200; ++i) bar->Update(i / 200.0);
  bar->Finish();
  const std::string text = Output();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 12);  // 0, 10, ... 100 % and the end.
  EXPECT_THAT(text, Not(HasSubstr("\r")));
  EXPECT_THAT(text, HasSubstr("100/200 frames"));
}

TEST_F(ProgressBarTest, StaysOnOneLineOfATerminal) {
  auto bar = Make(true);
  for (int i = 0; i <= 200; ++i) bar->Update(i / 200.0);
  bar->Finish();
  const std::string text = Output();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.back(), '\n');
}

TEST_F(ProgressBarTest, EstimatesTheTimeLeft) {
  auto bar = Make(true);
  now_ += std::chrono::seconds(10);
  bar->Update(0.25);
  EXPECT_THAT(Output(), HasSubstr("30 s left"));
}

TEST_F(ProgressBarTest, AnInterruptedBarEndsItsLine) {
  auto bar = Make(true);
  bar->Update(0.5);
  bar.reset();
  EXPECT_EQ(Output().back(), '\n');
}

}  // namespace
}  // namespace isotherm
