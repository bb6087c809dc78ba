#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "common/time/clock.h"
#include "ground/console/console_inbox.h"
#include "ground/console/group_codec.h"
#include "ground/console/group_schedule.h"
#include "ground/console/live_message.h"
#include "ground/console/measure_board.h"
#include "ground/console/rig_path.h"
#include "ground/mesh/part_mesher.h"
#include "ground/options/ground_options.pb.h"
#include "ground/snapshot/model_copy.h"

namespace isotherm {

/// Says what the console needs of the rest of the service. Called on the console's threads.
struct ConsoleServices {
  /// Sends an order to the rig and returns the number under which the result comes back. Empty:
  /// there is no rig.
  std::function<Result<std::uint64_t>(const Command&)> send;
  /// Fills in how all goes. Empty: nothing to tell.
  std::function<void(live::State&)> describe;
  /// A recording that is played back: what is to be done, and where it is. Empty: there is none.
  std::function<void(const live::PlaybackControl&)> play;
  std::function<live::Playback()> playback;
};

/// Makes of what the console's inbox gets the messages that clients see: takes copies of the model
/// in, makes the surface of what has changed a group at a time, answers questions. Owns no thread
/// and no socket. Thread-bound to the console's thread.
class Presenter {
 public:
  using Publish = std::function<void(LiveMessagePtr)>;

  /// `clock` and `inbox` must outlive it. `publish` may be called in each Turn.
  Presenter(const GroundOptions& options, const Clock& clock, ConsoleInbox& inbox,
            ConsoleServices services, Publish publish);

  /// Tells that there is no scan yet. Before the first Turn.
  void Begin() { PublishScan(); }
  /// Does what is to be done now, a small part at a time. Returns how long to wait for more.
  Nanoseconds Turn();

 private:
  void Handle(const ScanBegun& begun);
  void Handle(const FramePose& pose);
  void Handle(ScanEnded& ended);
  void Handle(const Feedback& feedback);
  void Handle(const CommandResult& result);
  void Handle(const ClientQuery& query);
  void SendOrder(const ClientQuery& query);
  void ChangeShapes(const ClientQuery& query);
  void AnswerPick(const ClientQuery& query);
  void ControlPlayback(const ClientQuery& query);
  void ShowMeasurements();

  void TakeBatches();
  void TakeBatch(const BlockBatch& batch);
  void PublishScan();
  void PublishMaps();
  void PublishPath();
  void SetVolume(const VoxelGrid& grid);
  void BeginModel();
  /// Makes one group if one is due and there is time for it. Returns how long to wait for the next.
  Nanoseconds MakeGroup();
  void MakeGroup(const DueGroup& due);
  void ShowImages(SteadyTime now);
  void ShowRawImages(const DepthFramePtr& depth, const ThermalFramePtr& thermal);
  void ShowState(SteadyTime now);
  void ShowPlayback();
  void ForgetOrders(SteadyTime now);
  void Send(LiveSlot slot, const live::ServerMessage& message, bool is_kept = true);
  std::vector<std::int32_t> BlocksOf(const GroupKey& key) const;

  struct Ordered {
    std::uint64_t client_number = 0;
    SteadyTime sent;
    std::function<void(live::Answer)> reply;
  };

  const GroundOptions options_;
  const Clock& clock_;
  ConsoleInbox& inbox_;
  const ConsoleServices services_;
  const Publish publish_;
  ModelCopy model_;
  std::uint64_t model_number_ = 0;
  live::Scan scan_;
  std::vector<CopiedMap> shown_maps_;
  GroupSchedule schedule_;
  MeasureBoard measures_;
  PartMesher mesher_;
  std::map<GroupKey, std::uint32_t> versions_;  ///< Newest that was made of each.
  RigPath path_;
  FramePose pose_;
  std::uint64_t newest_capture_ns_ = 0;
  SteadyTime next_group_, next_image_, next_state_, next_path_;
  std::map<std::uint64_t, Ordered> orders_;  ///< By the number of the command.
};

}  // namespace isotherm
