// A ground station, a peer that sends frames that cannot be, and one whose samples are of the right
// type but not of the rig.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "common/transport/endpoints.h"
#include "common/transport/testing/test_domain.h"
#include "tests/link/edge_side.h"
#include "tests/link/ground_side.h"
#include "tests/support/process.h"

namespace isotherm {
namespace {

int Count(const std::string& text, std::string_view part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

template <typename Condition>
bool Await(Condition condition) {
  const auto deadline = std::chrono::steady_clock::now() + kLinkPatience;
  while (!condition() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  return condition();
}

constexpr std::uint64_t kRepeats = 3;  // As in hostile_peer.

void ExpectEachCauseIsCounted(const RefusalCounter& refusals) {
  EXPECT_EQ(refusals.count(RefusalCause::kImpossibleSize), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kUnknownEncoding), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kEmptyPayload), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kOversizePayload), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kNegativeTime), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kNotFinite), 3 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kImpossibleNumber), 2 * kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kOtherSession), kRepeats);
  EXPECT_EQ(refusals.count(RefusalCause::kUnknownValue), 2 * kRepeats);
  // The undecodable one has the number of a frame that is here: a duplicate, not even looked at.
  EXPECT_EQ(refusals.count(RefusalCause::kUndecodable), 0U);
}

TEST(HostileTest, F60WhatCannotBeIsRefusedCountedAndLoggedOncePerCause) {
  const SystemClock clock{};
  const TransportEnvironment environment(clock);
  const TestDomain domain;
  const auto participant = std::move(*Participant::Create(environment, domain.number()));
  std::vector<std::uint64_t> depth_sessions;
  std::uint64_t thermal_frames = 0;
  SubscriberHandlers handlers;
  handlers.depth = [&](const ReceivedDepth& item) {
    depth_sessions.push_back(item.frame->header.session);
    EXPECT_EQ(item.frame->depth_raw.At(0, 0), 0x0707);
  };
  handlers.thermal = [&](const ReceivedThermal&) { ++thermal_frames; };
  SubscriberOptions options;
  options.edge_id = "test-edge";
  const auto subscriber = std::move(*Subscriber::Create(*participant, clock, options, handlers));

  ::testing::internal::CaptureStderr();
  {
    const std::jthread receiver([&](const std::stop_token& stop) { subscriber->Run(stop); });
    system_test::Process peer({.program = HOSTILE_PEER,
                               .arguments = {std::to_string(domain.number())},
                               .environment = {}});
    EXPECT_TRUE(peer.WaitForOutput("second session", kLinkPatience)) << peer.output();
    EXPECT_TRUE(Await([&] { return subscriber->stats().counters.session == 2; }));
    peer.Signal(SIGUSR1);
    EXPECT_TRUE(peer.WaitForOutput("sent", kLinkPatience)) << peer.output();
    EXPECT_TRUE(Await(
        [&] { return subscriber->refusals().count(RefusalCause::kNotFinite) >= 3 * kRepeats; }));
  }
  const std::string log = ::testing::internal::GetCapturedStderr();

  // The good ones came through, each once; also the newer version's, whose extra member is ignored.
  EXPECT_THAT(depth_sessions, ::testing::ElementsAre(1, 2, 2));
  EXPECT_EQ(thermal_frames, 1U);
  ExpectEachCauseIsCounted(subscriber->refusals());
  const SessionCounters counters = subscriber->stats().counters;
  EXPECT_EQ(counters.depth.received, 2U);
  EXPECT_EQ(counters.depth.missing, 0U);
  // Each good one was sent kRepeats times; in the second session the frames of the first, too.
  EXPECT_EQ(counters.depth.received + counters.depth.duplicates + counters.depth.refused,
            3 * kRepeats);

  EXPECT_EQ(environment.refused().malformed, kRepeats);  // Beyond the bound of the type.
  EXPECT_EQ(environment.refused().oversize, kRepeats);   // Beyond MaxSampleSize.

  EXPECT_EQ(Count(log, "sample refused"), 9) << log;  // One line per cause.
  EXPECT_EQ(Count(log, "warning: Dds:"), 2) << log;
}

/// Writes what is of the right type under the name of the rig, from a process of its own.
class Impostor {
 public:
  Impostor(const TransportEnvironment& environment, int domain)
      : participant_(std::move(*Participant::Create(environment, domain))) {
    CHECK(depth_.Open(*participant_).ok() && thermal_.Open(*participant_).ok() &&
          rig_.Open(*participant_).ok() && status_.Open(*participant_).ok() &&
          pose_.Open(*participant_).ok());
    while (depth_.matched_readers() == 0 || thermal_.matched_readers() == 0 ||
           rig_.matched_readers() == 0 || status_.matched_readers() == 0 ||
           pose_.matched_readers() == 0) {
      std::this_thread::yield();
    }
  }

  void Frame(std::uint64_t session, std::uint64_t number, Nanoseconds ahead = Nanoseconds(0)) {
    auto frame = MakeFrame<EncodedDepthFrame>(session, number, 64, 48);
    frame.header.capture_time += ahead;
    CHECK(depth_.Write(kName, frame).ok());
    auto thermal = MakeFrame<EncodedThermalFrame>(session, number, 64, 48);
    thermal.header.capture_time += ahead;
    CHECK(thermal_.Write(kName, thermal).ok());
    ++frames_;
  }
  void Rig(std::uint64_t session) {
    RigDescription rig;
    rig.session = session;
    rig.rig.depth_scale = 77.0;
    CHECK(rig_.Write(kName, rig).ok());
  }
  void Ended(std::uint64_t session) {
    EdgeStatus status;
    status.session = session;
    status.scan_state = ScanState::kEnded;
    CHECK(status_.Write(kName, status).ok());
  }
  void Pose(std::uint64_t session) {
    ExternalOdometrySample sample{.session = session, .number = poses_++, .pose = {}};
    sample.pose.source = "vio";
    CHECK(pose_.Write(kName, sample).ok());
  }
  bool Finish() {
    return depth_.WaitForAcknowledgments(kLinkPatience) &&
           thermal_.WaitForAcknowledgments(kLinkPatience) &&
           rig_.WaitForAcknowledgments(kLinkPatience) &&
           status_.WaitForAcknowledgments(kLinkPatience) &&
           pose_.WaitForAcknowledgments(kLinkPatience);
  }
  std::uint64_t frames() const { return frames_; }  ///< Frames of each stream.

 private:
  static constexpr const char* kName = "test-edge";
  std::unique_ptr<Participant> participant_;
  Writer<EncodedDepthFrame> depth_;
  Writer<EncodedThermalFrame> thermal_;
  Writer<RigDescription> rig_;
  Writer<EdgeStatus> status_;
  Writer<ExternalOdometrySample> pose_;
  std::uint64_t frames_ = 0;
  std::uint64_t poses_ = 0;
};

class ImpostorTest : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kFrames = 120;

  void SetUp() override {
    plan_.domain = domain_.number();
    plan_.depth_frames = plan_.thermal_frames = kFrames;
    ground_ = std::make_unique<GroundSide>(environment_, clock_, domain_.number());
    edge_ = std::make_unique<EdgeSide>(environment_, clock_, plan_);
    ASSERT_TRUE(edge_->publisher().WaitForGround(kLinkPatience, {}));
    edge_->Begin();
    edge_->SendFrames(0, kFrames / 2);
    // What is taken cannot be pushed out of the reader's history by another writer.
    ASSERT_TRUE(ground_->AwaitDepth(kFrames / 2));
    ASSERT_TRUE(Await([this] { return ground_->thermal().size() >= kFrames / 2; }));
  }
  /// A part of the scan beside the impostor, which then leaves.
  void SendBeside(std::unique_ptr<Impostor> impostor) {
    ASSERT_TRUE(impostor->Finish());
    edge_->SendFrames(kFrames / 2, kFrames - 20);
    impostor.reset();
    edge_->SendFrames(kFrames - 20, kFrames - 10);
  }
  /// The rest of the scan; then it must be as if nobody else had been there.
  void ExpectAWholeScan() {
    edge_->SendFrames(kFrames - 10, kFrames);
    EXPECT_TRUE(edge_->End());
    const auto counters = ground_->AwaitSessionEnd();
    ASSERT_TRUE(counters.has_value());
    EXPECT_EQ(counters->session, plan_.session);
    EXPECT_TRUE(counters->ended);
    for (const StreamCounters& stream : {counters->depth, counters->thermal}) {
      EXPECT_EQ(stream.published, kFrames);
      EXPECT_EQ(stream.received, kFrames);
      EXPECT_EQ(stream.missing, 0U);
      EXPECT_EQ(stream.late, 0U);
      EXPECT_EQ(stream.duplicates, 0U);
    }
    EXPECT_EQ(ground_->depth(), Range(0, kFrames));
    EXPECT_EQ(ground_->thermal(), Range(0, kFrames));
    EXPECT_EQ(ground_->corrupt(), 0);
    EXPECT_EQ(ground_->rig_session(), plan_.session);
    EXPECT_TRUE(ground_->AwaitExternalOdometry(0).empty());
    counters_ = *counters;
  }
  static std::uint64_t Refused(const StreamCounters& counters, RefusalCause cause) {
    return counters.refused_by_cause[static_cast<std::size_t>(cause)];
  }

  SystemClock clock_;
  TransportEnvironment environment_{clock_};
  TestDomain domain_;
  EdgePlan plan_;
  std::unique_ptr<GroundSide> ground_;
  std::unique_ptr<EdgeSide> edge_;
  SessionCounters counters_;
};

TEST_F(ImpostorTest, F60SamplesOfAnotherProcessChangeNothingAndAreCounted) {
  auto impostor = std::make_unique<Impostor>(environment_, domain_.number());
  impostor->Rig(plan_.session);  // The same session, another calibration.
  impostor->Frame(plan_.session, kFrames / 2 + 1);
  impostor->Frame(plan_.session, kFrames / 2 + 2, std::chrono::hours(24));
  impostor->Frame(plan_.session, 1ULL << 39U);
  impostor->Rig(99);
  impostor->Frame(99, 0);
  impostor->Frame(100, 0);
  impostor->Pose(plan_.session);
  impostor->Ended(plan_.session);
  impostor->Ended(99);
  const std::uint64_t frames = impostor->frames();
  SendBeside(std::move(impostor));
  const RefusalCounter& refusals = ground_->subscriber().refusals();
  // And a pose. Of rigs and states only the newest may have been seen.
  EXPECT_TRUE(Await([&] { return refusals.count(RefusalCause::kOtherWriter) > 2 * frames; }))
      << refusals.count(RefusalCause::kOtherWriter);
  ExpectAWholeScan();
  for (const StreamCounters& stream : {counters_.depth, counters_.thermal}) {
    EXPECT_EQ(stream.refused, frames);
    EXPECT_EQ(Refused(stream, RefusalCause::kOtherWriter), frames);
  }
}

TEST_F(ImpostorTest, F60WildFramesOfTheRigItselfStopNoneBehindThem) {
  // From the edge's own process: a defect of it, not an attack.
  Writer<EncodedDepthFrame> writer;
  ASSERT_TRUE(writer.Open(edge_->participant()).ok());
  ASSERT_TRUE(Await([&] { return writer.matched_readers() > 0; }));
  auto wild = MakeFrame<EncodedDepthFrame>(plan_.session, kFrames / 2, 64, 48);
  wild.header.capture_time += std::chrono::hours(24);
  ASSERT_TRUE(writer.Write("test-edge", wild).ok());
  wild = MakeFrame<EncodedDepthFrame>(plan_.session, 5'600'000, 64, 48);
  ASSERT_TRUE(writer.Write("test-edge", wild).ok());
  ASSERT_TRUE(writer.WaitForAcknowledgments(kLinkPatience));
  edge_->SendFrames(kFrames / 2, kFrames - 10);
  ExpectAWholeScan();
  EXPECT_EQ(Refused(counters_.depth, RefusalCause::kImplausibleTime), 1U);
  EXPECT_EQ(Refused(counters_.depth, RefusalCause::kImpossibleNumber), 1U);
  EXPECT_EQ(counters_.depth.refused, 2U);
  EXPECT_EQ(counters_.thermal.refused, 0U);
}

TEST_F(ImpostorTest, F64AThousandFramesOfAnUnknownSessionWriteAFewLines) {
  ::testing::internal::CaptureStderr();
  auto impostor = std::make_unique<Impostor>(environment_, domain_.number());
  for (std::uint64_t i = 0; i < 1000; ++i) impostor->Frame(99, i);
  SendBeside(std::move(impostor));
  const RefusalCounter& refusals = ground_->subscriber().refusals();
  EXPECT_TRUE(Await([&] { return refusals.count(RefusalCause::kOtherWriter) > 0; }));
  ExpectAWholeScan();
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_LE(Count(log, "warning: "), 5) << log;
  EXPECT_GE(Count(log, "another process of the same name"), 1) << log;
  EXPECT_GT(counters_.depth.refused, 0U);
}

}  // namespace
}  // namespace isotherm
