// Orders to one of several rigs, over the real transport on loopback. The rigs are fake: they tell
// their status and answer commands.

#include "ground/subscriber/rig_commander.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "common/transport/testing/test_domain.h"
#include "common/transport/transport_environment.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr Nanoseconds kPatience = 20s;
/// For what must not come: far longer than a message takes here.
constexpr Nanoseconds kShort = 1s;

class FakeRig {
 public:
  FakeRig(const TransportEnvironment& environment, int domain, std::string edge_id,
          ScanState state = ScanState::kScanning)
      : edge_id_(std::move(edge_id)), participant_(*Participant::Create(environment, domain)) {
    EXPECT_TRUE(statuses_.Open(*participant_).ok());
    EXPECT_TRUE(results_.Open(*participant_).ok());
    EdgeStatus status;
    status.scan_state = state;
    EXPECT_TRUE(statuses_.Write(edge_id_, status).ok());
  }

  /// Takes commands from here on.
  void Listen(CommandOutcome outcome = CommandOutcome::kDone, std::string text = "") {
    thread_ = std::jthread([this, outcome, text = std::move(text)](const std::stop_token& stop) {
      Reader<Command> commands;
      WaitSet wait_set;
      EXPECT_TRUE(commands.Open(*participant_, &refusals_).ok());
      EXPECT_TRUE(wait_set.Open(*participant_).ok());
      EXPECT_TRUE(wait_set.Attach(commands).ok());
      while (!stop.stop_requested()) {
        wait_set.Wait(20ms);
        commands.Take([&](Received<Command>&& received) {
          if (received.edge_id != edge_id_) return;
          ++executed_;
          EXPECT_TRUE(results_.Write(edge_id_, {received.message.number, outcome, text}).ok());
        });
      }
    });
  }
  int executed() const { return executed_; }

 private:
  const std::string edge_id_;
  RefusalCounter refusals_;
  std::unique_ptr<Participant> participant_;
  Writer<EdgeStatus> statuses_;
  Writer<CommandResult> results_;
  std::atomic<int> executed_{0};
  std::jthread thread_;
};

class RigCommanderTest : public ::testing::Test {
 protected:
  std::unique_ptr<FakeRig> Rig(const std::string& edge_id,
                               ScanState state = ScanState::kScanning) const {
    return std::make_unique<FakeRig>(environment_, domain_.number(), edge_id, state);
  }
  std::unique_ptr<RigCommander> Commander(const std::string& edge_id) const {
    return *RigCommander::Create(*ground_, clock_, edge_id);
  }
  /// Returns what becomes of an order to `edge_id`.
  Result<CommandResult> Order(const std::string& edge_id) const {
    const std::unique_ptr<RigCommander> commander = Commander(edge_id);
    const Result<EdgeStatus> status = commander->AwaitStatus(kPatience);
    if (!status) return Err(status.error());
    return commander->Send({.kind = CommandKind::kTriggerNuc}, kPatience);
  }

  const SystemClock clock_{};
  const TransportEnvironment environment_{clock_};
  const TestDomain domain_;
  const std::unique_ptr<Participant> ground_ = *Participant::Create(environment_, domain_.number());
};

TEST_F(RigCommanderTest, TheOnlyRigNeedsNoName) {
  const auto rig = Rig("alpha");
  rig->Listen(CommandOutcome::kRefused, "its shutter is glued");
  const auto commander = Commander("");
  ASSERT_TRUE(commander->AwaitStatus(kPatience).has_value());
  EXPECT_EQ(commander->edge_id(), "alpha");
  const Result<CommandResult> answer = commander->Send({}, kPatience);
  ASSERT_TRUE(answer.has_value()) << answer.error().message();
  EXPECT_EQ(answer->outcome, CommandOutcome::kRefused);
  EXPECT_EQ(answer->text, "its shutter is glued");
}

TEST_F(RigCommanderTest, OfTwoRigsTheOneThatIsNamedGetsTheOrder) {
  const auto alpha = Rig("alpha");
  const auto beta = Rig("beta");
  alpha->Listen(CommandOutcome::kDone, "by alpha");
  beta->Listen(CommandOutcome::kDone, "by beta");
  for (const std::string name : {"beta", "alpha"}) {
    const Result<CommandResult> answer = Order(name);
    ASSERT_TRUE(answer.has_value()) << answer.error().message();
    EXPECT_EQ(answer->text, "by " + name);
  }
  EXPECT_EQ(alpha->executed(), 1);
  EXPECT_EQ(beta->executed(), 1);
}

TEST_F(RigCommanderTest, AnOrderWaitsForTheReaderOfTheRigThatIsNamed) {
  const auto alpha = Rig("alpha");
  const auto beta = Rig("beta");
  alpha->Listen();
  const auto commander = Commander("beta");
  ASSERT_TRUE(commander->AwaitStatus(kPatience).has_value());
  const Result<CommandResult> nobody = commander->Send({}, kShort);
  ASSERT_FALSE(nobody.has_value());
  EXPECT_THAT(nobody.error().message(), HasSubstr("rig \"beta\" takes no commands"))
      << "alpha's reader is not the one";
  beta->Listen();
  EXPECT_TRUE(commander->Send({}, kPatience).has_value());
  EXPECT_EQ(beta->executed(), 1) << "the order that had no reader was not sent";
}

TEST_F(RigCommanderTest, WithoutANameSeveralRigsAreNamedInsteadOfOneTaken) {
  const auto alpha = Rig("alpha");
  const auto beta = Rig("beta");
  const Result<EdgeStatus> status = Commander("")->AwaitStatus(kPatience);
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.error().message(),
              AllOf(HasSubstr("several rigs"), HasSubstr("--edge-id): \"alpha\", \"beta\"")));
}

TEST_F(RigCommanderTest, AWrongNameIsAnsweredWithTheRigsThatAreThere) {
  const auto alpha = Rig("alpha");
  const auto beta = Rig("beta");
  const Result<EdgeStatus> status = Commander("gamma")->AwaitStatus(kShort);
  ASSERT_FALSE(status.has_value());
  EXPECT_EQ(status.error().code(), StatusCode::kUnavailable);
  EXPECT_THAT(status.error().message(),
              AllOf(HasSubstr("no status from rig \"gamma\" within 1.0 s"),
                    HasSubstr("\"alpha\", \"beta\"")));
}

TEST_F(RigCommanderTest, ARigWhoseScanHasEndedTakesTheOrderToStartTheNextOne) {
  const auto alpha = Rig("alpha", ScanState::kEnded);
  alpha->Listen();
  const auto commander = Commander("");
  const Result<EdgeStatus> status = commander->AwaitStatus(kPatience);
  ASSERT_TRUE(status.has_value()) << status.error().message();
  EXPECT_EQ(status->scan_state, ScanState::kEnded);
  const Result<CommandResult> answer =
      commander->Send({.kind = CommandKind::kStartScan}, kPatience);
  ASSERT_TRUE(answer.has_value()) << answer.error().message();
  EXPECT_EQ(alpha->executed(), 1);
}

TEST_F(RigCommanderTest, ARigThatHasLeftIsNotThere) {
  Rig("alpha", ScanState::kEnded).reset();
  const Result<EdgeStatus> status = Commander("")->AwaitStatus(kShort);
  ASSERT_FALSE(status.has_value());
  EXPECT_THAT(status.error().message(), HasSubstr("is isotherm-edge running"));
}

}  // namespace
}  // namespace isotherm
