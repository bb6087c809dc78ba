#include "ground/console/presenter.h"

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "common/base/processor_time.h"
#include "ground/console/camera_image.h"
#include "ground/console/live_convert.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kStateInterval = 500ms;
constexpr Nanoseconds kPathInterval = 1s;
/// A rig that has not answered an order by then is not there.
constexpr Nanoseconds kOrderPatience = 5s;
/// While groups wait for their turn.
constexpr Nanoseconds kMaxPause = 20ms;
/// With nothing to do.
constexpr Nanoseconds kMaxWait = 250ms;
/// Columns of the cameras' images.
constexpr int kImageWidth_px = 320;

SurfaceOptions MeshOptions(const GroundOptions& options) {
  SurfaceOptions mesh;
  mesh.min_weight = static_cast<float>(options.export_().expert().min_weight());
  return mesh;
}

/// Returns false if nothing in the group, or beside its upper ends, is behind a surface.
bool MayHaveSurface(const TsdfVolume& tsdf, const GroupKey& key) {
  constexpr int kSide = kGroupBlocks + 1;
  const GridIndex first = kGroupBlocks * GridIndex(key.x, key.y, key.z);
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const std::int32_t block =
        tsdf.Find(first + GridIndex(i % kSide, i / kSide % kSide, i / (kSide * kSide)));
    if (block != TsdfVolume::kNoBlock && tsdf.may_end_rays(block)) return true;
  }
  return false;
}

live::Answer AnswerTo(const live::ClientMessage& message, bool done, std::string text) {
  live::Answer answer;
  answer.set_number(message.number());
  answer.set_done(done);
  answer.set_text(std::move(text));
  return answer;
}

}  // namespace

Presenter::Presenter(const GroundOptions& options, const Clock& clock, ConsoleInbox& inbox,
                     ConsoleServices services, Publish publish)
    : options_(options),
      clock_(clock),
      inbox_(inbox),
      services_(std::move(services)),
      publish_(std::move(publish)),
      schedule_(FromSeconds(options.console().expert().refresh_s())),
      measures_(clock, model_),
      mesher_(MeshOptions(options)) {}

Nanoseconds Presenter::Turn() {
  for (ConsoleEvent& event : inbox_.TakeEvents())
    std::visit([this](auto& value) { Handle(value); }, event);
  TakeBatches();
  const SteadyTime now = clock_.SteadyNow();
  ShowImages(now);
  ShowState(now);
  ShowMeasurements();
  ForgetOrders(now);
  return MakeGroup();
}

void Presenter::Send(LiveSlot slot, const live::ServerMessage& message, bool is_kept) {
  auto sent = std::make_shared<LiveMessage>();
  sent->slot = slot;
  sent->model = model_number_;
  sent->is_kept = is_kept;
  sent->bytes = message.SerializeAsString();
  publish_(std::move(sent));
}

void Presenter::BeginModel() {
  ++model_number_;
  schedule_.Clear();
  versions_.clear();
  shown_maps_.clear();
  path_.Clear();
}

void Presenter::PublishScan() {
  live::ServerMessage message;
  *message.mutable_scan() = scan_;
  message.mutable_scan()->set_model(model_number_);
  Send({LiveKind::kScan, {}}, message);
}

void Presenter::PublishMaps() {
  live::ServerMessage message;
  live::Maps& maps = *message.mutable_maps();
  maps.set_active(static_cast<std::uint32_t>(model_.active_map()));
  for (int i = 0; i < model_.size(); ++i) {
    live::Maps::Map& map = *maps.add_maps();
    *map.mutable_t_world_map() = ToMessage(model_.map(i).place.T_world_map);
    map.set_joined(model_.map(i).place.joined);
  }
  Send({LiveKind::kMaps, {}}, message);
}

void Presenter::Handle(const ScanBegun& begun) {
  scan_ = begun.description;
  pose_ = {};
  pose_.scan = begun.scan;
  model_.Adopt(begun.scan, {});
  BeginModel();
  measures_.Begin(begun.folder, begun.measuring);
  PublishScan();
}

void Presenter::Handle(const FramePose& pose) {
  if (pose.scan != model_.scan()) return;
  pose_ = pose;
  newest_capture_ns_ = static_cast<std::uint64_t>(ToNanoseconds(pose.capture_time));
  live::ServerMessage message;
  live::RigPose& shown = *message.mutable_pose();
  shown.set_map(static_cast<std::uint32_t>(pose.map));
  *shown.mutable_t_map_depth() = ToMessage(pose.T_map_depth);
  shown.set_tracking(ToMessage(pose.tracking));
  shown.set_capture_time_ns(newest_capture_ns_);
  shown.set_frame_number(pose.frame_number);
  Send({LiveKind::kPose, {}}, message);
  if (pose.tracking == TrackingState::kLost) return path_.Break();
  const SteadyTime now = clock_.SteadyNow();
  if (!path_.Add(pose.map, pose.T_map_depth.translation()) || now < next_path_) return;
  next_path_ = now + kPathInterval;
  PublishPath();
}

void Presenter::PublishPath() {
  live::ServerMessage message;
  *message.mutable_path() = path_.ToMessage();
  Send({LiveKind::kPath, {}}, message);
}

void Presenter::SetVolume(const VoxelGrid& grid) {
  *scan_.mutable_volume_min() = ToMessage(grid.min_m);
  *scan_.mutable_volume_max() = ToMessage(grid.max_m());
  scan_.set_voxel_size_m(grid.voxel_size_m);
}

void Presenter::Handle(ScanEnded& ended) {
  if (ended.scan != model_.scan()) return;
  scan_.set_phase(ended.phase);
  if (!ended.maps.empty()) {
    // Sub-maps have become one model: their groups are others now.
    if (model_.size() > 1) BeginModel();
    model_.Adopt(ended.scan, std::move(ended.maps));
    for (int map = 0; map < model_.size(); ++map) {
      const TsdfVolume& tsdf = *model_.map(map).tsdf;
      for (std::int32_t block = 0; block < tsdf.block_count(); ++block)
        schedule_.NoteBlock(map, tsdf.block_coordinates(block), tsdf.grid().blocks, {});
    }
    measures_.NoteModel();
  }
  for (const RigidTransform& pose : ended.path) path_.Add(0, pose.translation());
  if (model_.size() > 0 && model_.map(0).tsdf && !scan_.has_volume_min())
    SetVolume(model_.map(0).tsdf->grid());
  PublishScan();
  PublishMaps();
  PublishPath();
}

void Presenter::Handle(const Feedback& feedback) {
  live::ServerMessage message;
  *message.mutable_guidance() = ToMessage(feedback, options_.feedback().done_fraction());
  Send({LiveKind::kGuidance, {}}, message);
}

void Presenter::Handle(const CommandResult& result) {
  const auto order = orders_.extract(result.number);
  if (!order) return;  // Of somebody else's order.
  live::Answer answer;
  answer.set_number(order.mapped().client_number);
  answer.set_done(result.outcome == CommandOutcome::kDone);
  answer.set_text(result.text.empty() && answer.done() ? "done" : result.text);
  order.mapped().reply(std::move(answer));
}

void Presenter::Handle(const ClientQuery& query) {
  if (query.message.has_order()) return SendOrder(query);
  if (query.message.has_pick()) return AnswerPick(query);
  if (query.message.has_edit()) return ChangeShapes(query);
  if (query.message.has_playback()) return ControlPlayback(query);
  query.reply(AnswerTo(query.message, false, "this service does not know that question"));
}

void Presenter::AnswerPick(const ClientQuery& query) {
  live::Answer answer = AnswerTo(query.message, true, "");
  *answer.mutable_record() = measures_.Answer(query.message.pick());
  query.reply(std::move(answer));
}

void Presenter::ChangeShapes(const ClientQuery& query) {
  const Status changed = measures_.Apply(query.message.edit());
  query.reply(AnswerTo(query.message, changed.ok(), changed.message()));
  ShowMeasurements();
}

void Presenter::ShowMeasurements() {
  std::optional<measuring::Measurements> measurements = measures_.Update();
  if (!measurements) return;
  live::ServerMessage message;
  *message.mutable_measurements() = *std::move(measurements);
  Send({LiveKind::kMeasurements, {}}, message);
}

void Presenter::ControlPlayback(const ClientQuery& query) {
  if (!services_.play) return query.reply(AnswerTo(query.message, false, "nothing is played back"));
  services_.play(query.message.playback());
  query.reply(AnswerTo(query.message, true, ""));
  ShowPlayback();
}

void Presenter::ShowPlayback() {
  if (!services_.playback) return;
  live::ServerMessage message;
  *message.mutable_playback() = services_.playback();
  Send({LiveKind::kPlayback, {}}, message);
}

void Presenter::SendOrder(const ClientQuery& query) {
  const std::optional<Command> command = ToCommand(query.message.order());
  if (!command) return query.reply(AnswerTo(query.message, false, "this is no order"));
  if (!services_.send)
    return query.reply(
        AnswerTo(query.message, false, "there is no rig: this scan is shown from files"));
  const Result<std::uint64_t> number = services_.send(*command);
  if (!number) return query.reply(AnswerTo(query.message, false, number.error().message()));
  orders_[*number] = {query.message.number(), clock_.SteadyNow(), query.reply};
}

void Presenter::ForgetOrders(SteadyTime now) {
  std::erase_if(orders_, [&](const auto& entry) {
    if (now - entry.second.sent < kOrderPatience) return false;
    live::Answer answer;
    answer.set_number(entry.second.client_number);
    answer.set_text("the rig does not answer");
    entry.second.reply(std::move(answer));
    return true;
  });
}

void Presenter::TakeBatches() {
  while (std::unique_ptr<BlockBatch> batch = inbox_.TakeFilled()) {
    if (batch->scan == model_.scan()) TakeBatch(*batch);
    inbox_.GiveBack(std::move(batch), false);
  }
}

void Presenter::TakeBatch(const BlockBatch& batch) {
  if (!model_.Apply(batch)) {
    LOG(Console, Warning) << "no room for a copy of the model";
  }
  measures_.NoteModel();
  for (const CopiedBlock& block : batch.blocks)
    schedule_.NoteBlock(batch.map, block.coordinates, batch.grid.blocks, batch.capture_time);
  if (!scan_.has_volume_min()) {
    SetVolume(batch.grid);
    PublishScan();
  }
  const auto is_same = [](const CopiedMap& a, const CopiedMap& b) {
    return a.joined == b.joined && a.T_world_map.isApprox(b.T_world_map, 0.0);
  };
  if (std::ranges::equal(shown_maps_, batch.maps, is_same)) return;
  shown_maps_ = batch.maps;
  PublishMaps();
}

std::vector<std::int32_t> Presenter::BlocksOf(const GroupKey& key) const {
  std::vector<std::int32_t> blocks;
  const TsdfVolume& tsdf = *model_.map(key.map).tsdf;
  const GridIndex first = kGroupBlocks * GridIndex(key.x, key.y, key.z);
  for (int i = 0; i < kGroupBlocks * kGroupBlocks * kGroupBlocks; ++i) {
    const GridIndex step(i % kGroupBlocks, i / kGroupBlocks % kGroupBlocks,
                         i / (kGroupBlocks * kGroupBlocks));
    const std::int32_t block = tsdf.Find(first + step);
    if (block != TsdfVolume::kNoBlock) blocks.push_back(block);
  }
  return blocks;
}

Nanoseconds Presenter::MakeGroup() {
  const SteadyTime now = clock_.SteadyNow();
  if (model_.size() == 0 || inbox_.viewers == 0) return kMaxWait;
  const int active = model_.active_map();
  Eigen::Vector3d rig_group = Eigen::Vector3d::Zero();
  if (const auto& tsdf = model_.map(active).tsdf) {
    const VoxelGrid& grid = tsdf->grid();
    rig_group =
        (pose_.T_map_depth.translation() - grid.min_m) / (kGroupBlocks * grid.block_size_m());
  }
  const std::optional<DueGroup> due = schedule_.Take(now, active, rig_group, now >= next_group_);
  if (!due) {
    if (schedule_.waiting() == 0) return kMaxWait;
    return now < next_group_ ? std::min(next_group_ - now, kMaxPause) : kMaxPause;
  }
  const Nanoseconds worked_before = ThreadProcessorTime();
  MakeGroup(*due);
  // The first surface of a place is awaited; better ones may take their time.
  if (due->is_new) return Nanoseconds(0);
  const Nanoseconds worked = ThreadProcessorTime() - worked_before;
  const double cores = options_.console().expert().mesh_cores();
  next_group_ = now + FromSeconds(ToSeconds(worked) / std::clamp(cores, 0.01, 1.0));
  return Nanoseconds(0);
}

void Presenter::MakeGroup(const DueGroup& due) {
  const GroupKey& key = due.key;
  const ReadableMap& map = model_.map(key.map);
  if (!map.tsdf || (due.is_new && !MayHaveSurface(*map.tsdf, key))) return;
  const Surface surface = mesher_.Extract(*map.tsdf, *map.thermal, BlocksOf(key));
  const bool has_surface = !surface.triangles.empty();
  schedule_.SetShown(key, has_surface);
  if (due.is_new && !has_surface) return;
  const VoxelGrid& grid = map.tsdf->grid();
  const std::uint32_t version = ++versions_[key];
  EncodedGroup encoded = EncodeGroup(key, version, grid, surface);
  encoded.group.set_capture_time_ns(newest_capture_ns_);
  encoded.group.set_changed_time_ns(static_cast<std::uint64_t>(ToNanoseconds(due.changed)));
  const Eigen::Vector3d centre = map.place.T_world_map * GroupCentre(grid, key);
  const auto publish = [&](LiveKind kind, const live::ServerMessage& message) {
    auto sent = std::make_shared<LiveMessage>();
    sent->slot = {kind, key};
    sent->version = version;
    sent->centre_world = centre;
    sent->bytes = message.SerializeAsString();
    publish_(std::move(sent));
  };
  live::ServerMessage group, details;
  *group.mutable_group() = std::move(encoded.group);
  *details.mutable_details() = std::move(encoded.details);
  publish(LiveKind::kGroup, group);
  if (has_surface) publish(LiveKind::kDetails, details);
}

void Presenter::ShowImages(SteadyTime now) {
  if (now < next_image_ || inbox_.viewers == 0) return;
  const auto send = [this](LiveKind kind, live::CameraImage image) {
    live::ServerMessage message;
    *message.mutable_image() = std::move(image);
    Send({kind, {}}, message);
  };
  const DepthFramePtr depth = inbox_.TakeDepth();
  const ThermalFramePtr thermal = inbox_.TakeThermal();
  if (depth) send(LiveKind::kDepthImage, ToCameraImage(*depth, kImageWidth_px));
  if (thermal) send(LiveKind::kThermalImage, ToCameraImage(*thermal, kImageWidth_px));
  if (inbox_.raw_viewers > 0) ShowRawImages(depth, thermal);
  if (depth || thermal)
    next_image_ = now + FromSeconds(1.0 / options_.console().expert().image_hz());
}

void Presenter::ShowRawImages(const DepthFramePtr& depth, const ThermalFramePtr& thermal) {
  const auto send = [this](LiveKind kind, const FrameHeader& header, std::string bytes) {
    auto sent = std::make_shared<LiveMessage>();
    sent->slot = {kind, {}};
    sent->time_ns = static_cast<std::uint64_t>(ToNanoseconds(header.capture_time));
    sent->bytes = std::move(bytes);
    publish_(std::move(sent));
  };
  if (depth) send(LiveKind::kRawDepth, depth->header, ToRawImage(*depth));
  if (thermal && !thermal->temperature_raw.empty())
    send(LiveKind::kRawThermal, thermal->header, ToRawImage(*thermal));
}

void Presenter::ShowState(SteadyTime now) {
  if (now < next_state_ || !services_.describe) return;
  next_state_ = now + kStateInterval;
  ShowPlayback();
  live::ServerMessage message;
  live::State& state = *message.mutable_state();
  services_.describe(state);
  state.mutable_console()->set_viewers(
      static_cast<std::uint32_t>(std::max(0, inbox_.viewers.load())));
  state.mutable_console()->set_groups_waiting(static_cast<std::uint32_t>(schedule_.waiting()));
  state.mutable_console()->set_groups(static_cast<std::uint32_t>(versions_.size()));
  Send({LiveKind::kState, {}}, message);
}

}  // namespace isotherm
