#include "common/base/standard_error.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>

namespace isotherm {
namespace {

/// Both ends of a way for text; the reading end never waits.
class UnblockedOutputTest : public testing::Test {
 protected:
  ~UnblockedOutputTest() override {
    for (const int end : ends_) {
      if (end >= 0) close(end);
    }
  }
  void Pipe() {
    ASSERT_EQ(pipe2(ends_.data(), O_CLOEXEC), 0);
    ASSERT_EQ(fcntl(ends_[0], F_SETFL, O_NONBLOCK), 0);
  }
  void Socket() {
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends_.data()), 0);
    ASSERT_EQ(fcntl(ends_[0], F_SETFL, O_NONBLOCK), 0);
  }
  std::string ReadAll() const {
    std::string text;
    std::array<char, 4096> buffer{};
    for (ssize_t count = 0; (count = read(ends_[0], buffer.data(), buffer.size())) > 0;)
      text.append(buffer.data(), static_cast<std::size_t>(count));
    return text;
  }
  /// Writes far more than fits while nobody reads, then reads with one more line: all lines that
  /// were taken come in order and whole, and the rest is counted.
  void ExpectThatNobodyWaits() {
    UnblockedOutput output(ends_[1]);
    constexpr int kLines = 40'000;
    for (int i = 0; i < kLines; ++i) output.Write(std::to_string(i) + " of a line\n");
    EXPECT_EQ(output.TakeLeftOut(), 0U) << "there is no room for saying so";
    std::string expected;
    std::string received = ReadAll();
    const std::uint64_t left_out = output.TakeLeftOut();
    EXPECT_GT(left_out, 0U);
    EXPECT_EQ(output.TakeLeftOut(), 0U) << "told once";
    received += ReadAll();
    output.Write("the end\n");
    received += ReadAll();
    for (int i = 0; i < kLines - static_cast<int>(left_out); ++i)
      expected += std::to_string(i) + " of a line\n";
    EXPECT_TRUE(received == expected + "the end\n") << received.size() << " bytes received";
  }

  std::array<int, 2> ends_ = {-1, -1};  ///< To read from, to write to.
};

TEST_F(UnblockedOutputTest, APipeThatNobodyReadsHoldsUpNobody) {
  Pipe();
  ExpectThatNobodyWaits();
}

TEST_F(UnblockedOutputTest, AJournalThatNobodyReadsHoldsUpNobody) {
  Socket();
  ExpectThatNobodyWaits();
}

TEST_F(UnblockedOutputTest, TheWritersOwnDescriptorStaysAsItWas) {
  Pipe();
  UnblockedOutput output(ends_[1]);
  output.Write("text\n");
  EXPECT_EQ(fcntl(ends_[1], F_GETFL) & O_NONBLOCK, 0);
  EXPECT_EQ(ReadAll(), "text\n");
}

TEST_F(UnblockedOutputTest, AReaderThatIsGoneCostsTheTextOnly) {
  struct sigaction before {};
  struct sigaction ignore {};
  ignore.sa_handler = SIG_IGN;
  ASSERT_EQ(sigaction(SIGPIPE, &ignore, &before), 0);
  Pipe();
  UnblockedOutput output(ends_[1]);
  close(ends_[0]);
  ends_[0] = -1;
  output.Write("to nobody\n");
  // What it leads to now counts, not what it led to then.
  std::array<int, 2> other{};
  ASSERT_EQ(pipe2(other.data(), O_CLOEXEC | O_NONBLOCK), 0);
  ASSERT_EQ(dup2(other[1], ends_[1]), ends_[1]);
  close(other[1]);
  ends_[0] = other[0];
  output.Write("to somebody\n");
  EXPECT_EQ(ReadAll(), "to somebody\n");
  ASSERT_EQ(sigaction(SIGPIPE, &before, nullptr), 0);
}

}  // namespace
}  // namespace isotherm
