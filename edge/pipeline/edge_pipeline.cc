#include "edge/pipeline/edge_pipeline.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/freed_memory.h"
#include "common/base/log.h"
#include "common/base/processor_time.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// Frames that may wait for the codec: a quarter of a second of both cameras, 10 MB.
constexpr std::size_t kCodecQueueFrames = 16;

/// Without a frame for this long, the recording brings to the disk what it has collected.
constexpr Nanoseconds kIdle = std::chrono::milliseconds(250);
/// A disk may stall for some seconds, and the link may wait for the ground for ten
/// (PublisherOptions::flow_timeout). A step that takes longer than these limits hangs.
constexpr Nanoseconds kStuck = std::chrono::seconds(10);
constexpr Nanoseconds kLinkStuck = std::chrono::seconds(15);
constexpr Nanoseconds kNoLimit = std::chrono::hours(24 * 365);  // For waits that end by event.

OverflowPolicy PolicyFor(const EdgeOptions& options) {
  return options.source().rate() > 0.0 ? OverflowPolicy::kDropOldest : OverflowPolicy::kBlock;
}

/// Logs what was wrong with a camera's clock, if anything.
void ReportStamping(std::string_view stream, const StampingCounts& counts) {
  if (counts.resets + counts.moved + counts.unsynchronised == 0) return;
  LOG(Edge, Warning) << stream << " camera's clock: resets=" << counts.resets
                     << " moved_stamps=" << counts.moved
                     << " unsynchronised_frames=" << counts.unsynchronised;
}

bool SendsCounts(const FrameSource& source) {
  const std::vector<CameraDescription> cameras = source.cameras();
  return std::any_of(cameras.begin(), cameras.end(),
                     [](const CameraDescription& camera) { return camera.counts_only; });
}

auto CountDropsAs(FrameFate fate, FrameCounters& counters) {
  return [fate, &counters](const EncodedFramePtr& frame) { counters.Count(frame->sensor(), fate); };
}

}  // namespace

EdgePipeline::EdgePipeline(const EdgeOptions& options, EdgeParts parts)
    : source_(parts.source),
      publisher_(parts.publisher),
      counters_(parts.counters),
      health_(parts.health),
      clock_(parts.clock),
      spool_(std::move(parts.spool)),
      session_(parts.session),
      first_numbers_(parts.first_numbers),
      thermal_is_counts_(SendsCounts(parts.source)),
      is_paced_(options.source().rate() > 0.0),
      step_watch_(ReadClocks(clock_)),
      depth_timestamper_(options.timestamper(), Sensor::kDepth, Nanoseconds(0)),
      thermal_timestamper_(options.timestamper(), Sensor::kThermal,
                           FromSeconds(parts.rig_thermal_delay_s)),
      nuc_(options, parts.source),
      blind_detector_(options.frame_check()),
      time_base_(TimeBaseOf(options.source())),
      feedback_(time_base_),
      codec_queue_(kCodecQueueFrames, OverflowPolicy::kBlock),
      spool_capacity_(static_cast<std::size_t>(options.spool().expert().queue_frames())),
      spool_queue_(spool_capacity_, PolicyFor(options),
                   CountDropsAs(FrameFate::kRecordQueueFull, counters_)),
      publish_queue_(static_cast<std::size_t>(options.link().expert().queue_frames()),
                     PolicyFor(options), CountDropsAs(FrameFate::kPublishQueueFull, counters_)) {
  const LinkExpertOptions& link = options.link().expert();
  if (!spool_ || link.backfill_hz() <= 0.0) return;
  const BackfillOptions backfill{.frames_per_s = link.backfill_hz(),
                                 .patience = FromSeconds(link.linger_s()),
                                 .waits_for_ground = !options.exit_at_end()};
  // A quarter of the queue: the link has been slower than the cameras for half a second.
  const std::size_t behind =
      std::max<std::size_t>(1, static_cast<std::size_t>(link.queue_frames()) / 4);
  backfill_ = std::make_unique<Backfill>(
      backfill, BackfillParts{publisher_, spool_->recorded_frames(), counters_, clock_,
                              [this, behind] { return publish_queue_.size() >= behind; }});
}

EdgePipeline::~EdgePipeline() { static_cast<void>(Stop()); }

void EdgePipeline::StartReceiving() {
  receive_thread_ = std::jthread([this](const std::stop_token& stop) {
    NameThread("receive");
    PublisherHandlers handlers;
    handlers.command = [this, &stop](const Command& command) { commands_.Push(command, stop); };
    handlers.feedback = [this, &stop](const Feedback& feedback, CaptureTime arrival, bool is_live) {
      // Its age counts on the time line of capture times.
      feedback_.Add(feedback, arrival - clock_step_total(), is_live);
      if (spool_) feedback_to_record_.Push({feedback, arrival}, stop);
    };
    publisher_.Run(stop, handlers);
  });
}

void EdgePipeline::StartCapture() {
  const auto start = [this](const char* name, void (EdgePipeline::*work)(const std::stop_token&)) {
    return std::jthread([this, name, work](const std::stop_token& stop) {
      NameThread(name);
      (this->*work)(stop);
    });
  };
  if (spool_) spool_thread_ = start("record", &EdgePipeline::Record);
  publish_thread_ = start("publish", &EdgePipeline::Publish);
  if (backfill_) backfill_thread_ = start("backfill", &EdgePipeline::RunBackfill);
  codec_thread_ = start("codec", &EdgePipeline::Encode);
  std::promise<void> ended;
  capture_ended_ = ended.get_future();
  capture_thread_ = std::jthread(
      [this](const std::stop_token& stop, std::promise<void> at_end) {
        NameThread("capture");
        Capture(stop);
        at_end.set_value();
      },
      std::move(ended));
}

bool EdgePipeline::StopCapture(Nanoseconds limit) {
  if (std::exchange(capture_stopped_, true)) return !capture_left_behind_;
  // Along the line, so that each stage can still pass on what it has.
  capture_thread_.request_stop();
  if (capture_thread_.joinable()) {
    // A driver that hangs cannot be ended; its thread is left behind rather than the recording.
    capture_left_behind_ = capture_ended_.wait_for(limit) != std::future_status::ready;
    if (!capture_left_behind_) capture_thread_.join();
  }
  codec_thread_.request_stop();
  if (codec_thread_.joinable()) codec_thread_.join();
  return !capture_left_behind_;
}

Status EdgePipeline::StopRecording() {
  if (std::exchange(recording_stopped_, true)) return recording_status_;
  static_cast<void>(StopCapture(kNoLimit));
  publish_thread_.request_stop();  // It need not wait for the disk.
  spool_thread_.request_stop();
  if (spool_thread_.joinable()) spool_thread_.join();
  if (!spool_) return recording_status_;
  RecordMessages();
  if (feedback_to_record_.dropped() > 0) {
    LOG(Spool, Warning) << "feedback not recorded, messages=" << feedback_to_record_.dropped();
  }
  recording_status_ = spool_->Close();
  return recording_status_;
}

Status EdgePipeline::Stop() {
  static_cast<void>(StopRecording());
  if (std::exchange(stopped_, true)) return recording_status_;
  for (std::jthread* thread : {&backfill_thread_, &publish_thread_, &receive_thread_}) {
    thread->request_stop();
    if (thread->joinable()) thread->join();
  }
  if (clock_steps_ > 0) {
    LOG(Edge, Warning) << "the wall clock was set during the scan, steps=" << clock_steps_
                       << "; wall clock minus capture times at the end, s="
                       << ToSeconds(clock_step_total());
  }
  if (capture_left_behind_) return recording_status_;  // It may still use what follows.
  ReportStamping("depth", depth_timestamper_.counts());
  ReportStamping("thermal", thermal_timestamper_.counts());
  if (odometry_poses_captured_ > 0) {
    LOG(Edge, Info) << "odometry poses, captured=" << odometry_poses_captured_
                    << " published=" << odometry_poses_published_
                    << " not_published=" << odometry_poses_captured_ - odometry_poses_published_;
  }
  return recording_status_;
}

bool EdgePipeline::finished() const {
  if (!IsCaptured()) return false;
  if (!backfill_) return true;
  backfill_->NoteEnd();
  return backfill_->is_settled();
}

bool EdgePipeline::IsCaptured() const {
  if (!source_ended_) return false;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const SensorCounters counters = counters_.Get(sensor);
    if (counters.OnTheWayToGround() != 0) return false;
    if (spool_ && counters.OnTheWayToDisk() != 0) return false;
  }
  return true;
}

double EdgePipeline::spool_fill_ratio() const {
  if (!spool_ || !spool_->status().problem.empty()) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(spool_queue_.size()) / static_cast<double>(spool_capacity_);
}

std::optional<SpoolStatus> EdgePipeline::recording() const {
  return spool_ ? std::optional(spool_->status()) : std::nullopt;
}

std::optional<std::string> EdgePipeline::StuckIn(SteadyTime now) const {
  if (recording_.AtItFor(now) > kStuck) return "the disk does not answer";
  if (backfill_ && backfill_->AtItFor(now) > kStuck)
    return "what the ground lacks cannot be read, the disk does not answer";
  if (reading_.AtItFor(now) > kStuck) return "the source of frames does not answer";
  if (publishing_.AtItFor(now) > kLinkStuck) return "the network does not answer";
  if (publisher_.stats().ending_for > kLinkStuck)
    return "the network does not end, to be joined anew (MultipleReceiveThreads in its profile "
           "must be false)";
  return std::nullopt;
}

Result<SourceItem> EdgePipeline::Read(const std::stop_token& stop) {
  const ThreadProgress::Work step(reading_, clock_.SteadyNow());
  return source_.Read(stop);
}

void EdgePipeline::Capture(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    ServeNucCommands();
    Result<SourceItem> item = Read(stop);
    if (!item || std::holds_alternative<EndOfStream>(*item)) break;
    WatchClock();
    if (RawFrame* raw = std::get_if<RawFrame>(&*item)) Process(std::move(*raw), stop);
    if (ExternalOdometry* pose = std::get_if<ExternalOdometry>(&*item))
      BufferOdometryPose(std::move(*pose));
  }
  source_.Close();
  // What was captured before the stop is still processed: captured = recorded + dropped must hold.
  while (std::optional<RawFrame> raw = source_.TakeUnread()) Process(std::move(*raw), stop);
  ServeNucCommands();
  nuc_.End();
  ServeNucCommands();
  source_ended_ = true;
}

void EdgePipeline::WatchClock() {
  const std::optional<Nanoseconds> step = step_watch_.Observe(ReadClocks(clock_));
  if (!step) return;
  clock_steps_ = step_watch_.steps();
  clock_step_total_ns_ = step_watch_.total().count();
  LOG(Edge, Warning) << "the wall clock was set, step_s=" << ToSeconds(*step)
                     << "; capture times go on without it, wall clock minus capture time base, s="
                     << ToSeconds(step_watch_.total());
}

void EdgePipeline::Process(RawFrame raw, const std::stop_token& stop) {
  // From here on, arrival is on the time line that steps of the wall clock do not touch. Arrivals
  // of sources that do not read the clocks (a replay's) are on a time line of their own.
  if (raw.arrival_steady != SteadyTime{}) raw.arrival_wall = step_watch_.At(raw.arrival_steady);
  if (raw.sensor == Sensor::kDepth) {
    ProcessDepth(std::move(raw), stop);
  } else {
    ProcessThermal(std::move(raw), stop);
  }
}

void EdgePipeline::BufferOdometryPose(ExternalOdometry pose) {
  // Cameras that stopped must not make the buffer grow.
  constexpr std::size_t kMax = 1024;
  if (external_odometry_.size() == kMax) external_odometry_.erase(external_odometry_.begin());
  external_odometry_.push_back({session_, odometry_poses_captured_++, std::move(pose)});
}

void EdgePipeline::ProcessDepth(RawFrame raw, const std::stop_token& stop) {
  const Stamp stamp = depth_timestamper_.Process(raw, raw.arrival_wall);
  NoteStamped(raw, stamp);
  feedback_.NoteCapture(stamp.time, TimeLineNow());
  health_.SetBlind(Sensor::kDepth, blind_detector_.Update(raw));
  EncodedDepthFrame frame;
  frame.header = Header(raw, stamp);
  frame.depth_scale = raw.depth_scale;
  QueueForCodec({{std::move(frame), raw.arrival_wall}, std::move(raw.pixels)}, stop);
}

void EdgePipeline::ProcessThermal(RawFrame raw, const std::stop_token& stop) {
  const Stamp stamp = thermal_timestamper_.Process(raw, raw.arrival_wall);
  NoteStamped(raw, stamp);
  const NucStatus nuc = nuc_.Process(raw, stamp.time);
  EncodedThermalFrame frame;
  frame.header = Header(raw, stamp);
  frame.nuc_state = nuc.state;
  frame.nuc_source = nuc.source;
  frame.seconds_since_nuc = nuc.seconds_since_nuc;
  frame.valid = nuc.valid && !thermal_is_counts_;
  if (thermal_is_counts_) frame.image.encoding = Encoding::kCounts16;
  frame.scale = thermal_is_counts_ ? kCentikelvin : raw.thermal_scale;
  frame.housekeeping = raw.housekeeping;
  nuc_report_.Set(nuc_.Report());
  QueueForCodec({{std::move(frame), raw.arrival_wall}, std::move(raw.pixels)}, stop);
}

void EdgePipeline::NoteStamped(const RawFrame& raw, const Stamp& stamp) {
  newest_capture_ns_ = ToNanoseconds(stamp.time);
  health_.NoteStamp(raw.sensor, stamp);
  if (raw.arrival_steady == SteadyTime{}) return;  // Not from a camera.
  health_.AddStamping(raw.sensor, clock_.SteadyNow() - raw.arrival_steady);
}

FrameHeader EdgePipeline::Header(const RawFrame& raw, const Stamp& stamp) const {
  const std::uint64_t first = first_numbers_[static_cast<std::size_t>(raw.sensor)];
  return {session_, first + raw.frame_number, raw.device_ticks, stamp.time, stamp.sigma};
}

void EdgePipeline::QueueForCodec(FrameToEncode frame, const std::stop_token& stop) {
  frame.encoded.external_odometry = std::exchange(external_odometry_, {});
  frame.encoded.log = nuc_.TakeLog();
  if (time_base_ == TimeBase::kWallClock) frame.encoded.wall_minus_time = step_watch_.total();
  const Sensor sensor = frame.encoded.sensor();
  if (codec_queue_.Push(std::move(frame), stop)) return;
  // The stop came while the frame waited for room: a queue that is full is why it is lost.
  if (spool_) counters_.Count(sensor, FrameFate::kRecordQueueFull);
  counters_.Count(sensor, FrameFate::kPublishQueueFull);
}

void EdgePipeline::Encode(const std::stop_token& stop) {
  FreedMemory freed;
  while (std::optional<FrameToEncode> frame = codec_queue_.Pop(stop)) {
    freed.GiveBackIfDue(clock_.SteadyNow());
    auto& content = frame->encoded.content;
    if (auto* depth = std::get_if<EncodedDepthFrame>(&content))
      depth->image = depth_encoder_.Encode(frame->pixels);
    if (auto* thermal = std::get_if<EncodedThermalFrame>(&content)) {
      const bool is_counts = thermal->image.encoding == Encoding::kCounts16;
      thermal->image = is_counts ? PackCounts(frame->pixels)
                                 : thermal_encoder_.Encode(frame->pixels, thermal->scale);
    }
    QueueForSinks(std::move(frame->encoded), stop);
  }
}

void EdgePipeline::QueueForSinks(EncodedFrame encoded, const std::stop_token& stop) {
  const auto frame = std::make_shared<const EncodedFrame>(std::move(encoded));
  // Live, Push makes room and counts by itself what it drops (CountDropsAs). Unpaced playback waits
  // for room, and false says that there was none when the stop came.
  if (spool_ && !spool_queue_.Push(frame, stop)) {
    counters_.Count(frame->sensor(), FrameFate::kRecordQueueFull);
  }
  if (!publish_queue_.Push(frame, stop)) {
    counters_.Count(frame->sensor(), FrameFate::kPublishQueueFull);
  }
}

void EdgePipeline::Record(const std::stop_token& stop) {
  {
    const ThreadProgress::Work step(recording_, clock_.SteadyNow());
    spool_->Tend(/*idle=*/false);
  }
  while (true) {
    const std::optional<EncodedFramePtr> frame = spool_queue_.PopFor(kIdle, stop);
    if (!frame && stop.stop_requested()) return;
    const ThreadProgress::Work step(recording_, clock_.SteadyNow());
    RecordMessages();
    if (frame) spool_->Add(**frame);
    spool_->Tend(/*idle=*/!frame);
  }
}

void EdgePipeline::RecordRig(RigUpdate update) {
  if (spool_) rig_to_record_.Set(std::move(update));
}

void EdgePipeline::RecordMessages() {
  if (const std::optional<RigUpdate> update = rig_to_record_.Take()) spool_->Add(*update);
  while (feedback_to_record_.size() > 0) {
    const std::optional<ReceivedFeedback> received = feedback_to_record_.Pop({});
    spool_->Add(received->feedback, received->arrival);
  }
  while (marks_to_record_.size() > 0) spool_->Add(*marks_to_record_.Pop({}));
}

void EdgePipeline::PublishExternalOdometry(const EncodedFrame& frame, const std::stop_token& stop) {
  for (const ExternalOdometrySample& sample : frame.external_odometry) {
    if (publisher_.Publish(sample, stop).ok()) ++odometry_poses_published_;
  }
}

void EdgePipeline::Publish(const std::stop_token& stop) {
  while (const std::optional<EncodedFramePtr> frame = publish_queue_.Pop(stop)) {
    const ThreadProgress::Work step(publishing_, clock_.SteadyNow());
    // First, so that the ground has them when it tracks the frame.
    PublishExternalOdometry(**frame, stop);
    // A source that waits for the link is not too fast for it.
    if (is_paced_ && !publisher_.TakesNext((*frame)->sensor(), publish_queue_.size())) {
      counters_.Count((*frame)->sensor(), FrameFate::kLeftForLater);
      continue;
    }
    const Status published =
        std::visit([this, &stop](const auto& content) { return publisher_.Publish(content, stop); },
                   (*frame)->content);
    counters_.Count((*frame)->sensor(),
                    published.ok() ? FrameFate::kPublished : FrameFate::kPublishFailed);
  }
}

}  // namespace isotherm
