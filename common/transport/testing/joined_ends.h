#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "common/time/clock.h"
#include "common/transport/endpoints.h"
#include "common/transport/participant.h"
#include "common/transport/refusal.h"
#include "common/transport/testing/test_domain.h"
#include "common/transport/transport_environment.h"
#include "common/transport/wait_set.h"

namespace isotherm {

/// Two participants in one process, which the middleware joins without the network; two processes
/// are tested by link_test.
class JoinedEndsTest : public ::testing::Test {
 protected:
  /// Far above anything measured; only a failure waits this long.
  static constexpr std::chrono::seconds kPatience{10};

  std::unique_ptr<Participant> Join() {
    auto participant = Participant::Create(environment_, domain_.number());
    EXPECT_TRUE(participant.has_value());
    return std::move(*participant);
  }

  template <typename Message>
  void AwaitMatch(const Writer<Message>& writer, int readers) {
    // Waiting for discovery has no event in this interface: tests only, and bounded.
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (writer.matched_readers() < readers && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    ASSERT_EQ(writer.matched_readers(), readers);
  }

  template <typename Message>
  std::optional<Received<Message>> TakeOne(Reader<Message>& reader) {
    WaitSet waiter;
    EXPECT_TRUE(waiter.Open(*ground_).ok());
    EXPECT_TRUE(waiter.Attach(reader).ok());
    std::optional<Received<Message>> result;
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!result && std::chrono::steady_clock::now() < deadline) {
      waiter.Wait(std::chrono::milliseconds(100));
      reader.Take([&](Received<Message>&& received) { result = std::move(received); }, 1);
    }
    return result;
  }

  /// Writes `message` and returns what arrives at the other side.
  template <typename Message>
  std::optional<Received<Message>> RoundTrip(const Message& message) {
    Reader<Message> reader;
    EXPECT_TRUE(reader.Open(*ground_, &refusals_).ok());
    Writer<Message> writer;
    EXPECT_TRUE(writer.Open(*edge_).ok());
    AwaitMatch(writer, 1);
    // The other side, too: nobody sends again what is written with best effort.
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (reader.matched_writers() < 1 && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    EXPECT_TRUE(writer.Write("edge-1", message).ok());
    return TakeOne(reader);
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  RefusalCounter refusals_;
  std::unique_ptr<Participant> edge_ = Join();
  std::unique_ptr<Participant> ground_ = Join();
};

}  // namespace isotherm
