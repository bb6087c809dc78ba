#include "ground/console/presenter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr std::uint64_t kShownScan = 1;
const Eigen::Vector3d kBall(0.13, 0.13, 0.13);

VoxelGrid ShownGrid() {
  VoxelGrid grid;
  grid.voxel_size_m = 0.004;
  grid.blocks = GridIndex::Constant(8);  // Two groups along each axis.
  return grid;
}

class PresenterTest : public ::testing::Test {
 protected:
  PresenterTest() : tsdf_(ShownGrid(), 0.016, 512), thermal_(512) {
    testing::FillSphere(tsdf_, kBall, 0.06);
    testing::FillThermal(tsdf_, thermal_, [](const Eigen::Vector3d&) {
      return ThermalVoxel::Make(55.0F, ConditionClass::kGood, ConditionClass::kGood);
    });
    options_.mutable_console()->mutable_expert()->set_mesh_cores(1.0);
  }

  Presenter MakePresenter(ConsoleServices services = {}) {
    Presenter presenter(options_, clock_, inbox_, std::move(services),
                        [this](const LiveMessagePtr& message) {
                          messages_.push_back(message);
                          newest_[message->slot] = message;
                        });
    presenter.Begin();
    return presenter;
  }
  void BeginScan() {
    ScanBegun begun;
    begun.scan = kShownScan;
    begun.description.set_phase(live::Scan::RUNNING);
    begun.description.set_name("scan-1");
    inbox_.Add(begun);
  }
  void SendBlocks() {
    std::unique_ptr<BlockBatch> batch = inbox_.TakeEmpty();
    ASSERT_NE(batch, nullptr);
    batch->Clear();
    batch->scan = kShownScan;
    batch->grid = tsdf_.grid();
    batch->truncation_distance_m = tsdf_.truncation_distance_m();
    batch->max_blocks = 512;
    batch->maps = {{RigidTransform::Identity(), true}};
    for (std::int32_t block = 0; block < tsdf_.block_count(); ++block) {
      batch->blocks.push_back({.coordinates = tsdf_.block_coordinates(block)});
      const auto voxels = tsdf_.voxels(block);
      batch->tsdf.insert(batch->tsdf.end(), voxels.begin(), voxels.end());
      const auto thermal = thermal_.voxels(block);
      batch->thermal.insert(batch->thermal.end(), thermal.begin(), thermal.end());
    }
    inbox_.GiveBack(std::move(batch), true);
  }
  void Turn(Presenter& presenter, int turns = 100) {
    for (int i = 0; i < turns; ++i) {
      presenter.Turn();
      clock_.Advance(10ms);
    }
  }
  live::ServerMessage Newest(LiveKind kind) const {
    live::ServerMessage message;
    const auto found = newest_.find({kind, {}});
    if (found != newest_.end()) message.ParseFromString(found->second->bytes);
    return message;
  }
  std::size_t GroupMessages() const {
    return static_cast<std::size_t>(std::ranges::count_if(
        messages_, [](const auto& m) { return m->slot.kind == LiveKind::kGroup; }));
  }
  /// Asks and returns the answer.
  live::Answer Ask(Presenter& presenter, live::ClientMessage question) {
    live::Answer answer;
    question.set_number(77);
    inbox_.Add(ClientQuery{std::move(question), [&](live::Answer a) { answer = std::move(a); }});
    presenter.Turn();
    return answer;
  }

  GroundOptions options_;
  FakeClock clock_;
  ConsoleInbox inbox_;
  TsdfVolume tsdf_;
  ThermalVolume thermal_;
  std::vector<LiveMessagePtr> messages_;
  std::map<LiveSlot, LiveMessagePtr> newest_;
};

TEST_F(PresenterTest, BeforeAnyScanItSaysThatThereIsNone) {
  MakePresenter();
  EXPECT_EQ(Newest(LiveKind::kScan).scan().model(), 0U);
  EXPECT_EQ(Newest(LiveKind::kScan).scan().phase(), live::Scan::WAITING);
}

TEST_F(PresenterTest, AllGroupsOfTheSurfaceAreMadeWhileSomebodyLooks) {
  Presenter presenter = MakePresenter();
  inbox_.viewers = 1;
  BeginScan();
  presenter.Turn();
  SendBlocks();
  Turn(presenter);
  std::uint32_t triangles = 0;
  for (const auto& [slot, message] : newest_) {
    if (slot.kind != LiveKind::kGroup) continue;
    live::ServerMessage group;
    ASSERT_TRUE(group.ParseFromString(message->bytes));
    triangles += group.group().index_count() / 3;
  }
  // The surface of the ball in triangles of half a voxel's face each: 4 pi r^2 / (h^2 / 2) and
  // some.
  EXPECT_GT(triangles, 5000U);
  EXPECT_EQ(Newest(LiveKind::kScan).scan().name(), "scan-1");
  EXPECT_NEAR(Newest(LiveKind::kScan).scan().volume_max().x(), 8 * 0.032, 1e-9);
  EXPECT_EQ(Newest(LiveKind::kMaps).maps().maps_size(), 1);
}

TEST_F(PresenterTest, TheFirstSurfaceOfAPlaceDoesNotWaitForItsShareOfTheProcessor) {
  options_.mutable_console()->mutable_expert()->set_mesh_cores(0.01);
  Presenter presenter = MakePresenter();
  inbox_.viewers = 1;
  BeginScan();
  presenter.Turn();
  SendBlocks();
  constexpr std::size_t kGroups = 8;
  Turn(presenter, kGroups + 1);
  EXPECT_EQ(GroupMessages(), kGroups);
}

TEST_F(PresenterTest, NothingIsMadeForNobody) {
  Presenter presenter = MakePresenter();
  BeginScan();
  presenter.Turn();
  SendBlocks();
  Turn(presenter);
  EXPECT_EQ(GroupMessages(), 0U);
  inbox_.viewers = 1;
  Turn(presenter);
  EXPECT_GT(GroupMessages(), 0U);
}

TEST_F(PresenterTest, SurfaceThatGoesIsTakenBack) {
  Presenter presenter = MakePresenter();
  inbox_.viewers = 1;
  BeginScan();
  presenter.Turn();
  SendBlocks();
  Turn(presenter);
  for (std::int32_t block = 0; block < tsdf_.block_count(); ++block)
    std::ranges::fill(tsdf_.voxels(block), TsdfVoxel());
  clock_.Advance(5s);
  SendBlocks();
  Turn(presenter);
  for (const auto& [slot, message] : newest_) {
    if (slot.kind != LiveKind::kGroup) continue;
    live::ServerMessage group;
    ASSERT_TRUE(group.ParseFromString(message->bytes));
    EXPECT_EQ(group.group().vertex_count(), 0U);
  }
}

TEST_F(PresenterTest, BlocksOfAnEarlierScanAreNotShown) {
  Presenter presenter = MakePresenter();
  inbox_.viewers = 1;
  BeginScan();
  presenter.Turn();
  SendBlocks();
  ScanBegun next;
  next.scan = kShownScan + 1;
  inbox_.Add(next);
  Turn(presenter);
  EXPECT_EQ(GroupMessages(), 0U);
  EXPECT_EQ(Newest(LiveKind::kScan).scan().model(), 2U);
}

TEST_F(PresenterTest, PosesMakeAPath) {
  Presenter presenter = MakePresenter();
  BeginScan();
  for (int i = 0; i < 5; ++i) {
    FramePose pose;
    pose.scan = kShownScan;
    pose.frame_number = static_cast<std::uint64_t>(i);
    pose.tracking = TrackingState::kTracked;
    pose.T_map_depth.translation().x() = 0.1 * i;
    inbox_.Add(pose);
    Turn(presenter, 120);
  }
  EXPECT_EQ(Newest(LiveKind::kPose).pose().frame_number(), 4U);
  EXPECT_EQ(Newest(LiveKind::kPose).pose().tracking(), live::TRACKED);
  EXPECT_EQ(Newest(LiveKind::kPath).path().parts(0).positions_size(), 15);
}

TEST_F(PresenterTest, AnOrderGetsTheRigsAnswer) {
  std::vector<Command> sent;
  ConsoleServices services;
  services.send = [&](const Command& command) -> Result<std::uint64_t> {
    sent.push_back(command);
    return 5;
  };
  Presenter presenter = MakePresenter(services);
  live::ClientMessage order;
  order.mutable_order()->set_kind(live::Order::HOLD_NUC);
  order.mutable_order()->set_hold_s(30.0);
  live::Answer answer;
  order.set_number(9);
  inbox_.Add(ClientQuery{order, [&](live::Answer a) { answer = std::move(a); }});
  presenter.Turn();
  ASSERT_EQ(sent.size(), 1U);
  EXPECT_EQ(sent[0].kind, CommandKind::kHoldNuc);
  EXPECT_EQ(sent[0].hold_s, 30.0);
  EXPECT_EQ(answer.number(), 0U);
  inbox_.Add(CommandResult{.number = 5, .outcome = CommandOutcome::kRefused, .text = "too long"});
  presenter.Turn();
  EXPECT_EQ(answer.number(), 9U);
  EXPECT_FALSE(answer.done());
  EXPECT_EQ(answer.text(), "too long");
}

TEST_F(PresenterTest, ARigThatDoesNotAnswerIsSaidSo) {
  ConsoleServices services;
  services.send = [](const Command&) -> Result<std::uint64_t> { return 5; };
  Presenter presenter = MakePresenter(services);
  live::ClientMessage order;
  order.mutable_order()->set_kind(live::Order::NUC_NOW);
  order.set_number(9);
  live::Answer answer;
  inbox_.Add(ClientQuery{order, [&](live::Answer a) { answer = std::move(a); }});
  presenter.Turn();
  clock_.Advance(6s);
  presenter.Turn();
  EXPECT_EQ(answer.number(), 9U);
  EXPECT_THAT(answer.text(), HasSubstr("does not answer"));
}

TEST_F(PresenterTest, WithoutARigOrdersAreRefused) {
  Presenter presenter = MakePresenter();
  live::ClientMessage order;
  order.mutable_order()->set_kind(live::Order::START_SCAN);
  const live::Answer answer = Ask(presenter, order);
  EXPECT_FALSE(answer.done());
  EXPECT_THAT(answer.text(), HasSubstr("no rig"));
}

TEST_F(PresenterTest, APickReadsTheRecordUnderTheRay) {
  Presenter presenter = MakePresenter();
  BeginScan();
  presenter.Turn();
  SendBlocks();
  presenter.Turn();
  live::ClientMessage question;
  measuring::Anchor& ray = *question.mutable_pick()->mutable_ray();
  ray.mutable_origin()->set_x(kBall.x());
  ray.mutable_origin()->set_y(kBall.y());
  ray.mutable_origin()->set_z(-1.0);
  ray.mutable_direction()->set_z(1.0);
  const live::Answer answer = Ask(presenter, question);
  EXPECT_EQ(answer.number(), 77U);
  ASSERT_TRUE(answer.record().hit());
  EXPECT_NEAR(answer.record().point().z(), kBall.z() - 0.06, 2e-4);
  EXPECT_NEAR(answer.record().apparent_celsius(), 55.0, 0.02);
}

TEST_F(PresenterTest, ShapesAreMeasuredForAll) {
  Presenter presenter = MakePresenter();
  BeginScan();
  presenter.Turn();
  SendBlocks();
  presenter.Turn();
  live::ClientMessage edit;
  measuring::Shape& shape = *edit.mutable_edit()->mutable_put();
  shape.set_id("s");
  measuring::Anchor& anchor = *shape.add_anchors();
  anchor.mutable_origin()->set_x(kBall.x());
  anchor.mutable_origin()->set_y(kBall.y());
  anchor.mutable_direction()->set_z(1.0);
  EXPECT_TRUE(Ask(presenter, edit).done());
  const measuring::Measurements shown = Newest(LiveKind::kMeasurements).measurements();
  ASSERT_EQ(shown.measured_size(), 1);
  EXPECT_NEAR(shown.measured(0).record().object_celsius(), 55.0, 0.02);
  EXPECT_EQ(shown.undoable(), 1U);
}

TEST_F(PresenterTest, AnEndedScanGoesOnToBeShown) {
  Presenter presenter = MakePresenter();
  inbox_.viewers = 1;
  BeginScan();
  presenter.Turn();
  ScanEnded ended{.scan = kShownScan, .maps = {}};
  ended.maps.push_back({.tsdf = std::shared_ptr<const TsdfVolume>(&tsdf_, [](auto*) {}),
                        .thermal = std::shared_ptr<const ThermalVolume>(&thermal_, [](auto*) {}),
                        .place = {RigidTransform::Identity(), true}});
  inbox_.Add(std::move(ended));
  Turn(presenter);
  EXPECT_EQ(Newest(LiveKind::kScan).scan().phase(), live::Scan::ENDED);
  EXPECT_GT(GroupMessages(), 0U);
}

}  // namespace
}  // namespace isotherm
