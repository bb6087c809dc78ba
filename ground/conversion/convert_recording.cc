#include "ground/conversion/convert_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>

#include "common/base/log.h"
#include "common/base/noise.h"
#include "common/codec/codec.h"
#include "common/recording/feedback.pb.h"
#include "common/recording/feedback_record.h"
#include "common/recording/mcap_message_stream.h"
#include "common/recording/recording_streams.h"
#include "common/recording/recording_topics.h"
#include "common/recording/schema.h"

namespace isotherm {
namespace {

namespace rec = recording;

// The reader turns these into items; everything else is carried over as bytes. A topic that is
// missing here would be in the new file twice.
constexpr std::array<std::string_view, 13> kOwnTopics = {
    rec::kDepthTopic,      rec::kThermalTopic,          rec::kRigTopic,
    rec::kDepthInfoTopic,  rec::kThermalInfoTopic,      rec::kNucTopic,
    rec::kClockTopic,      rec::kGroundtruthTopic,      rec::kTrajectoryTopic,
    rec::kLogTopic,        rec::kExternalOdometryTopic, rec::kOldOdometryTopic,
    rec::kThermalPoseTopic};

/// A message that the reader of recordings does not know (feedback, status), as it is in the file.
struct OtherMessage {
  std::string topic;
  const mcap::Schema* schema = nullptr;
  CaptureTime time{};
  std::string data;
};

/// Gives these messages of a recording in order of time.
class OtherMessages {
 public:
  static Result<std::unique_ptr<OtherMessages>> Open(const std::filesystem::path& recording) {
    auto source = OpenFileSource(recording);
    if (!source) return Err(source.error());
    auto index = mcap::ReadFileIndex(**source);
    if (!index) return Err(index.error().WithContext(recording.string()));
    return std::make_unique<OtherMessages>(std::move(*source), std::move(*index));
  }
  OtherMessages(std::unique_ptr<ByteSource> source, mcap::FileIndex index)
      : source_(std::move(source)), index_(std::move(index)), stream_(*source_, index_) {}

  /// nullopt at the end. What is damaged is left to the reader to count.
  std::optional<OtherMessage> Next() {
    while (true) {
      const auto message = stream_.Next();
      if (!message) continue;
      if (!message->has_value()) return std::nullopt;
      const auto channel = index_.definitions.channels.find((*message)->channel_id);
      if (channel == index_.definitions.channels.end()) continue;
      const auto schema = index_.definitions.schemas.find(channel->second.schema_id);
      const bool is_own = std::ranges::count(kOwnTopics, channel->second.topic) > 0;
      if (is_own || schema == index_.definitions.schemas.end()) continue;
      const std::span<const std::uint8_t> data = (*message)->data;
      return OtherMessage{
          channel->second.topic, &schema->second,
          CaptureTimeFromNanoseconds(static_cast<std::int64_t>(
              // A damaged time must not overflow the order of messages.
              std::min<std::uint64_t>((*message)->log_time, rec::kMaxRecordedNanoseconds))),
          std::string(data.begin(), data.end())};
    }
  }

 private:
  const std::unique_ptr<ByteSource> source_;
  const mcap::FileIndex index_;
  mcap::MessageStream stream_;
};

/// Tells a message from others of its recording, alike in each recording that has it. What both
/// sides wrote of feedback is not the same to the byte: the edge adds when it arrived.
std::string IdentityOf(const OtherMessage& message) {
  recording::FeedbackRecord feedback;
  if (message.topic == kFeedbackRecordTopic && feedback.ParseFromString(message.data))
    return fmt::format("{} {} {}", message.topic, feedback.session(), feedback.frame_number());
  return message.topic + ' ' + message.data;
}

/// Gives those of several recordings, each once.
class MergedMessages {
 public:
  explicit MergedMessages(std::vector<std::unique_ptr<OtherMessages>> recordings)
      : recordings_(std::move(recordings)) {
    for (const auto& recording : recordings_) heads_.push_back(recording->Next());
  }

  std::optional<OtherMessage> Next() {
    while (true) {
      const auto earliest = std::ranges::min_element(
          heads_, {}, [](const auto& head) { return head ? head->time : CaptureTime::max(); });
      if (!*earliest) return std::nullopt;
      const auto recording = static_cast<std::size_t>(earliest - heads_.begin());
      OtherMessage message = std::exchange(*earliest, recordings_[recording]->Next()).value();
      if (recordings_.size() == 1) return message;
      const std::size_t identity = std::hash<std::string>()(IdentityOf(message));
      // The other side had it earlier or later; the same recording may say the same again.
      if (owners_.try_emplace(identity, recording).first->second == recording) return message;
    }
  }

 private:
  std::vector<std::unique_ptr<OtherMessages>> recordings_;
  std::vector<std::optional<OtherMessage>> heads_;
  /// The recording that had a message first, by a hash of its identity.
  std::unordered_map<std::size_t, std::size_t> owners_;
};

/// The tracked pose that a feedback message carries; nullopt while the rig was lost.
std::optional<StampedPose> PoseOf(const OtherMessage& message) {
  if (message.topic != kFeedbackRecordTopic) return std::nullopt;
  return rec::TrackedPoseIn(message.data);
}

class Converter {
 public:
  Converter(const ConvertRequest& request, RecordingReader& reader, MergedMessages& others,
            RecordingWriter& writer)
      : request_(request), reader_(reader), others_(others), writer_(writer) {
    for (const auto& [topic, count] : reader.info().messages_by_topic) total_ += count;
    ChoosePoses();
  }

  Status Run() {
    if (const Result<Rig> rig = reader_.ReadRig()) {
      ISOTHERM_RETURN_IF_ERROR(writer_.Write(*rig));
      summary_.has_thermal_pose = rig->T_thermal_depth.has_value();
    }
    ISOTHERM_RETURN_IF_ERROR(WriteMetadata());
    item_ = NextItem();
    other_ = others_.Next();
    while (item_ || other_ || pose_ < request_.poses.size()) {
      if (request_.stop.stop_requested()) return Unavailable("the conversion was interrupted");
      ISOTHERM_RETURN_IF_ERROR(WriteEarliest());
      if (request_.progress && total_ > 0)
        request_.progress(static_cast<double>(written_) / static_cast<double>(total_));
    }
    return OkStatus();
  }

  const ConvertSummary& summary() const { return summary_; }

 private:
  enum class PosesFrom : std::uint8_t { kNowhere, kRequest, kTrajectory, kFeedback, kGroundtruth };

  void ChoosePoses() {
    const auto has = [this](std::string_view topic) {
      const auto found = reader_.info().messages_by_topic.find(std::string(topic));
      return found != reader_.info().messages_by_topic.end() && found->second > 0;
    };
    if (!request_.poses.empty()) {
      from_ = PosesFrom::kRequest;
      summary_.poses_from = "the trajectory";
    } else if (has(rec::kTrajectoryTopic)) {
      from_ = PosesFrom::kTrajectory;
      summary_.poses_from = "the recording's trajectory";
      // Compact recordings keep feedback as it is: poses would be in them twice.
    } else if (has(kFeedbackRecordTopic) && request_.storage == ImageStorage::kViewable) {
      from_ = PosesFrom::kFeedback;
      summary_.poses_from = "the ground's feedback";
    } else if (has(rec::kGroundtruthTopic)) {
      from_ = PosesFrom::kGroundtruth;
      summary_.poses_from = "the ground truth";
    }
  }

  /// As it was, and what was spoiled now in addition to what was before.
  Status WriteMetadata() {
    auto metadata = reader_.info().metadata;
    // The writer describes the new file itself.
    metadata.erase(std::string(kRecordingMetadataName));
    if (request_.defect != DepthDefect::kNone) {
      std::string& done = metadata[std::string(kSpoiledMetadata)]["depth"];
      done += (done.empty() ? "" : ", ") + std::string(ToString(request_.defect));
    }
    for (const auto& [name, values] : metadata)
      ISOTHERM_RETURN_IF_ERROR(writer_.WriteMetadata(name, values));
    return OkStatus();
  }

  /// nullopt at the end.
  std::optional<RecordedItem> NextItem() {
    while (true) {
      Result<std::optional<RecordedItem>> item = reader_.Next();
      ++written_;
      if (item) return std::move(*item);
      LeaveOut(item.error());
    }
  }

  void LeaveOut(const Status& why) {
    // A damaged recording may have thousands; the summary counts them all.
    constexpr std::uint64_t kMaxTold = 10;
    if (++summary_.left_out > kMaxTold) return;
    LOG(Convert, Warning) << "left out: " << why.message();
  }

  Status WriteEarliest() {
    constexpr CaptureTime kNever = CaptureTime::max();
    const CaptureTime item = item_ ? TimeOf(*item_) : kNever;
    const CaptureTime other = other_ ? other_->time : kNever;
    const CaptureTime pose = pose_ < request_.poses.size() ? request_.poses[pose_].time : kNever;
    // Poses first: a frame is shown where the rig was when it was taken.
    if (pose <= item && pose <= other && pose != kNever)
      return WriteTracked(request_.poses[pose_++]);
    if (other < item || !item_) {
      const OtherMessage message = std::exchange(other_, others_.Next()).value();
      ++written_;
      return WriteOther(message);
    }
    const RecordedItem current = std::exchange(item_, NextItem()).value();
    return std::visit([this](const auto& recorded) { return WriteItem(recorded); }, current);
  }

  Status WriteOther(const OtherMessage& message) {
    if (from_ == PosesFrom::kFeedback) {
      if (const std::optional<StampedPose> pose = PoseOf(message))
        ISOTHERM_RETURN_IF_ERROR(WriteTracked(*pose));
    }
    return writer_.WriteMessage(message.topic, message.schema->name, message.schema->data,
                                message.time, message.data);
  }

  Status WriteTracked(const StampedPose& pose) {
    ++summary_.poses;
    return writer_.WritePose("trajectory", pose);
  }

  Status WriteItem(const RecordedDepth& depth) {
    EncodedDepthFrame frame = depth.frame;
    const auto encode = [this](const auto& pixels) { return depth_encoder_.Encode(pixels); };
    if (!Store(frame.image, encode) || !Spoil(frame)) return OkStatus();
    ++summary_.depth_frames;
    return writer_.Write(frame, depth.arrival);
  }
  Status WriteItem(const RecordedThermal& thermal) {
    EncodedThermalFrame frame = thermal.frame;
    const auto encode = [&](const auto& pixels) {
      return thermal_encoder_.Encode(pixels, frame.scale);
    };
    if (!Store(frame.image, encode)) return OkStatus();
    ++summary_.thermal_frames;
    return writer_.Write(frame, thermal.arrival);
  }
  Status WriteItem(const RecordedPose& recorded) {
    if (recorded.stream == "trajectory") {
      return from_ == PosesFrom::kTrajectory ? WriteTracked(recorded.pose) : OkStatus();
    }
    if (from_ == PosesFrom::kGroundtruth) ++summary_.poses;
    const bool is_beside = from_ != PosesFrom::kGroundtruth;
    if (!is_beside || request_.storage != ImageStorage::kViewable)
      return writer_.WritePose(recorded.stream, recorded.pose);
    // A viewer knows one pose of each coordinate frame: that of the tracker is the rig's.
    return rec::WriteGroundtruth("groundtruth", recorded.pose, writer_);
  }
  Status WriteItem(const NucEvent& event) { return writer_.Write(event); }
  Status WriteItem(const ClockStep& step) { return writer_.Write(step); }
  Status WriteItem(const ExternalOdometry& pose) { return writer_.Write(pose); }
  Status WriteItem(const RecordedLog& log) {
    return writer_.WriteLog(log.time, log.level, log.text);
  }

  /// Codes the image anew if it has to be; false if it is damaged.
  template <typename Encode>
  bool Store(EncodedImage& image, const Encode& encode) {
    // What the writer unpacks for viewers, it checks; so do we, to go on without a damaged one.
    Result<Image<std::uint16_t>> pixels = Decode(image);
    if (!pixels) {
      LeaveOut(pixels.error());
      return false;
    }
    const bool is_plain = image.encoding == Encoding::kRaw16 ||
                          image.encoding == Encoding::kPng16 ||
                          image.encoding == Encoding::kScaledRaw16;
    if (request_.storage == ImageStorage::kCompact && is_plain) image = encode(*pixels);
    return true;
  }

  bool Spoil(EncodedDepthFrame& frame) {
    if (request_.defect == DepthDefect::kNone) return true;
    Result<Image<std::uint16_t>> pixels = Decode(frame.image);
    if (!pixels) {
      LeaveOut(pixels.error());
      return false;
    }
    // Noise by frame number: the same recording is spoiled alike each time.
    AddDefect(request_.defect, NoiseStream(0, 0, frame.header.frame_number), *pixels);
    frame.image = depth_encoder_.Encode(*pixels);
    return true;
  }

  const ConvertRequest& request_;
  RecordingReader& reader_;
  MergedMessages& others_;
  RecordingWriter& writer_;
  PosesFrom from_ = PosesFrom::kNowhere;
  DepthEncoder depth_encoder_;
  ThermalEncoder thermal_encoder_;
  std::optional<RecordedItem> item_;
  std::optional<OtherMessage> other_;
  std::size_t pose_ = 0;
  std::uint64_t total_ = 0, written_ = 0;
  ConvertSummary summary_;
};

Result<MergedMessages> OpenOthers(const std::vector<std::filesystem::path>& paths) {
  std::vector<std::unique_ptr<OtherMessages>> recordings;
  for (const std::filesystem::path& path : paths) {
    auto messages = OtherMessages::Open(path);
    if (!messages) return Err(messages.error());
    recordings.push_back(std::move(*messages));
  }
  return MergedMessages(std::move(recordings));
}

/// Converts what `reader` gives; the files at `paths` are read once more for what it hides.
Result<ConvertSummary> Convert(const ConvertRequest& request, RecordingReader& reader,
                               const std::vector<std::filesystem::path>& paths) {
  auto others = OpenOthers(paths);
  if (!others) return Err(others.error());
  RecordingOptions options;
  options.image_storage = request.storage;
  options.sync = request.sync;
  auto writer = RecordingWriter::Create(request.output, options);
  if (!writer) return Err(writer.error());
  Converter converter(request, reader, *others, **writer);
  if (Status status = converter.Run(); !status.ok()) return Err(std::move(status));
  if (Status status = (*writer)->Close(); !status.ok()) return Err(std::move(status));
  return converter.summary();
}

}  // namespace

Result<ConvertSummary> ConvertRecording(const ConvertRequest& request) {
  std::vector<std::filesystem::path> paths{request.recording};
  if (request.others.empty()) {
    auto reader = RecordingReader::Open(request.recording);
    if (!reader) return Err(reader.error());
    return Convert(request, **reader, paths);
  }
  paths.insert(paths.end(), request.others.begin(), request.others.end());
  auto merged = MergedRecording::OpenAll(paths);
  if (!merged) return Err(merged.error());
  Result<ConvertSummary> summary = Convert(request, **merged, paths);
  if (!(*merged)->conflict().ok()) return Err((*merged)->conflict());
  if (!summary) return summary;
  summary->parts = (*merged)->parts();
  summary->missing = (*merged)->missing();
  return summary;
}

}  // namespace isotherm
