#include "common/base/processor_time.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <future>
#include <thread>

namespace isotherm {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;
using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

/// Returns the kernel's own measure of the calling thread, by another way than the code under test.
double RusageOfThread_s() {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

/// Computes until the kernel says that this thread has had so much of a processor.
void Burn(double seconds) {
  const double start_s = RusageOfThread_s();
  while (RusageOfThread_s() < start_s + seconds) {
  }
}

TEST(ProcessorTimeTest, WaitingIsNotCountedWorkIs) {
  const auto before = ThreadProcessorTime();
  const double start_s = RusageOfThread_s();
  std::this_thread::sleep_for(milliseconds(100));
  Burn(0.05);
  const double used_s = duration<double>(ThreadProcessorTime() - before).count();
  EXPECT_NEAR(used_s, RusageOfThread_s() - start_s, 0.02);
}

TEST(ProcessorTimeTest, HelpersCountForWhomTheyWorked) {
  const auto before = ThreadProcessorTime();
  AddProcessorTimeOfHelpers(milliseconds(500));
  EXPECT_GE(ThreadProcessorTime() - before, milliseconds(500));
  const auto elsewhere = std::async(std::launch::async, ThreadProcessorTime).get();
  EXPECT_LT(elsewhere, milliseconds(400));
}

TEST(ProcessorTimeTest, ThreadsAreToldApartByTheirNames) {
  const ProcessorTimes before = ReadProcessorTimes();
  std::promise<void> burnt, read;
  std::thread living([&] {
    NameThread("a-long-name-of-a-thread");
    Burn(0.08);
    burnt.set_value();
    read.get_future().wait();
  });
  std::thread([] {
    NameThread("short-lived");
    Burn(0.04);
  }).join();
  burnt.get_future().wait();
  const ProcessorTimes used = ReadProcessorTimes() - before;
  read.set_value();
  living.join();
  ASSERT_TRUE(used.by_thread_s.contains("a-long-name-of-"));
  EXPECT_THAT(used.by_thread_s.at("a-long-name-of-"), AllOf(Ge(0.06), Le(used.total_s)));
  ASSERT_TRUE(used.by_thread_s.contains("ended"));
  EXPECT_GE(used.by_thread_s.at("ended"), 0.02);
  EXPECT_FALSE(used.by_thread_s.contains("short-lived"));
  EXPECT_GE(used.total_s, 0.1);
}

TEST(ProcessorTimeTest, AThreadThatEndedTakesNothingFromTheOthers) {
  const ProcessorTimes before{.total_s = 1.0, .by_thread_s = {{"pool", 0.6}, {"main", 0.3}}};
  const ProcessorTimes after{.total_s = 1.5, .by_thread_s = {{"pool", 0.4}, {"main", 0.5}}};
  const ProcessorTimes used = after - before;
  EXPECT_DOUBLE_EQ(used.total_s, 0.5);
  EXPECT_DOUBLE_EQ(used.by_thread_s.at("main"), 0.2);
  EXPECT_DOUBLE_EQ(used.by_thread_s.at("ended"), 0.3);
  EXPECT_FALSE(used.by_thread_s.contains("pool"));
}

TEST(ProcessorTimeTest, TheTextNamesWhatIsWorthIt) {
  const ProcessorTimes used{.total_s = 4.2,
                            .by_thread_s = {{"codec", 2.2}, {"record", 1.0}, {"tev", 0.1}}};
  EXPECT_EQ(ToText(used, 20.0), "4.2 s, 0.21 of a core: codec 0.11, record 0.05, others 0.05");
  EXPECT_EQ(ToText(used, 0.0), "4.2 s");
}

}  // namespace
}  // namespace isotherm
