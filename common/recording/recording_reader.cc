#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "common/recording/frame_protos.h"
#include "common/recording/mcap_message_stream.h"
#include "common/recording/recording_protos.h"
#include "common/recording/recording_streams.h"
#include "common/rig/rig_calibration.h"

namespace isotherm {
namespace {

namespace rec = recording;

/// Says what a channel carries for us.
enum class Content {
  kOther,
  kRawDepth,
  kCompressedDepth,
  kRawThermal,
  kCompressedThermal,
  kNuc,
  kClock,
  kPose,
  kExternalOdometry,
  kLog,
  kRig
};

template <typename Message>
bool Is(std::string_view schema_name) {
  return schema_name == Message::descriptor()->full_name();
}

Content ContentOf(std::string_view topic, std::string_view schema_name) {
  if (topic == rec::kDepthTopic) {
    // Topic and schema must both fit: other programs use "/depth" for their own messages.
    if (Is<foxglove::RawImage>(schema_name)) return Content::kRawDepth;
    if (Is<foxglove::CompressedImage>(schema_name)) return Content::kCompressedDepth;
  }
  if (topic == rec::kThermalTopic) {
    if (Is<foxglove::RawImage>(schema_name)) return Content::kRawThermal;
    if (Is<foxglove::CompressedImage>(schema_name)) return Content::kCompressedThermal;
  }
  if (topic == rec::kNucTopic && Is<rec::NucRecord>(schema_name)) return Content::kNuc;
  if (topic == rec::kClockTopic && Is<rec::ClockStepRecord>(schema_name)) return Content::kClock;
  if ((topic == rec::kExternalOdometryTopic || topic == rec::kOldOdometryTopic) &&
      Is<foxglove::PoseInFrame>(schema_name))
    return Content::kExternalOdometry;
  if (topic == rec::kLogTopic && Is<foxglove::Log>(schema_name)) return Content::kLog;
  if (topic == rec::kRigTopic && Is<rec::RigRecord>(schema_name)) return Content::kRig;
  if ((topic == rec::kGroundtruthTopic || topic == rec::kTrajectoryTopic) &&
      Is<foxglove::FrameTransform>(schema_name)) {
    return Content::kPose;
  }
  return Content::kOther;
}

template <typename Message>
Result<Message> ParseAs(const mcap::Message& message) {
  Message parsed;
  if (!parsed.ParseFromArray(message.data.data(), static_cast<int>(message.data.size()))) {
    return Err(DataLoss("its content is damaged"));
  }
  return parsed;
}

/// Parses the message and converts it with `convert`.
template <typename Message, typename Convert>
Result<std::optional<RecordedItem>> ParseItem(const mcap::Message& message, Convert convert) {
  Result<Message> parsed = ParseAs<Message>(message);
  if (!parsed) return Err(std::move(parsed.error()));
  auto item = convert(*parsed);
  if (!item) return Err(std::move(item.error()));
  return RecordedItem(std::move(*item));
}

template <typename Image>
Result<std::optional<RecordedItem>> ParseDepth(const mcap::Message& message, CaptureTime time) {
  return ParseItem<Image>(
      message, [&](Image& image) { return rec::ToDepth(image, time, message.sequence); });
}

template <typename Image>
Result<std::optional<RecordedItem>> ParseThermal(const mcap::Message& message, CaptureTime time) {
  return ParseItem<Image>(
      message, [&](Image& image) { return rec::ToThermal(image, time, message.sequence); });
}

CaptureTime ToCaptureTime(std::uint64_t log_time) {
  // A damaged log time must not become a negative one.
  constexpr auto kLast = static_cast<std::uint64_t>(rec::kMaxRecordedNanoseconds);
  return CaptureTimeFromNanoseconds(static_cast<std::int64_t>(std::min(log_time, kLast)));
}

class McapRecordingReader final : public RecordingReader {
 public:
  McapRecordingReader(std::unique_ptr<ByteSource> source, mcap::FileIndex index)
      : source_(std::move(source)), index_(std::move(index)), stream_(*source_, index_) {
    info_.complete = index_.complete;
    info_.bytes_ignored = index_.bytes_ignored;
    for (const mcap::Gap& gap : index_.gaps) {
      RecordingGap& copy = info_.gaps.emplace_back();
      copy.offset = gap.offset;
      copy.bytes = gap.length;
      for (const auto& [id, count] : gap.message_counts)
        copy.messages_by_topic[TopicOf(id)] += count;
    }
    for (const auto& [id, channel] : index_.definitions.channels) {
      const auto schema = index_.definitions.schemas.find(channel.schema_id);
      contents_[id] = schema == index_.definitions.schemas.end()
                          ? Content::kOther
                          : ContentOf(channel.topic, schema->second.name);
    }
    for (const auto& [id, count] : index_.message_counts) {
      // Summed up: two channels may carry one topic, for example after files were merged.
      info_.messages_by_topic[TopicOf(id)] += count;
    }
    for (const mcap::Segment& segment : index_.segments) {
      const CaptureTime start = ToCaptureTime(segment.start);
      const CaptureTime end = ToCaptureTime(segment.end);
      info_.start = info_.start ? std::min(*info_.start, start) : start;
      info_.end = info_.end ? std::max(*info_.end, end) : end;
    }
    for (const mcap::Metadata& metadata : index_.metadata) {
      info_.metadata[metadata.name] = metadata.values;
    }
  }

  const RecordingInfo& info() const override { return info_; }

  Result<Rig> ReadRig() override {
    // A camera that came late is in the rig that was written anew; if that cannot be read, the
    // first one is better than none.
    if (const std::optional<std::uint64_t> since = RigSince()) {
      if (Result<Rig> newest = FirstRig(*since)) return newest;
    }
    return FirstRig(0);
  }

  Result<std::optional<RecordedItem>> Next() override {
    while (true) {
      const auto message = stream_.Next();
      if (!message) return Err(message.error());
      if (!message->has_value()) return std::nullopt;
      const Content content = ContentOfChannel((*message)->channel_id);
      // Copies of the rig are for readers that seek (ReadRig), not items of the scan.
      if (content == Content::kOther || content == Content::kRig) continue;
      auto item = ParseMessage(content, **message);
      if (item) return item;
      return Err(item.error().WithContext(
          fmt::format("message {} on {}", (*message)->sequence, TopicOf((*message)->channel_id))));
    }
  }

  Status Seek(CaptureTime time) override {
    stream_.Seek(static_cast<std::uint64_t>(std::max<std::int64_t>(ToNanoseconds(time), 0)));
    return OkStatus();
  }

 private:
  /// The log time of the first copy of a rig that was written anew; nullopt if none was.
  std::optional<std::uint64_t> RigSince() const {
    const auto metadata = info_.metadata.find(std::string(kRigMetadataName));
    if (metadata == info_.metadata.end()) return std::nullopt;
    const auto value = metadata->second.find(std::string(kRigSince));
    if (value == metadata->second.end()) return std::nullopt;
    const std::string& text = value->second;
    std::uint64_t since = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), since);
    return end.ec == std::errc() ? std::optional(since) : std::nullopt;
  }

  /// The first rig at or after a log time that can be read.
  Result<Rig> FirstRig(std::uint64_t since) const {
    Status problem = NotFound("the recording has no rig calibration");
    if (!info_.messages_by_topic.contains(std::string(rec::kRigTopic))) return Err(problem);
    mcap::MessageStream stream(*source_, index_);
    if (since > 0) stream.Seek(since);
    while (true) {
      const auto message = stream.Next();
      if (!message) continue;  // A damaged chunk: there is another copy behind it.
      if (!message->has_value()) return Err(problem);
      if (ContentOfChannel((*message)->channel_id) != Content::kRig) continue;
      Result<Rig> rig = ParseRig(**message);
      if (rig) return rig;
      // The first problem says more than the last: later copies mostly fail by the same damage.
      if (problem.code() == StatusCode::kNotFound) problem = rig.error();
    }
  }

  static Result<Rig> ParseRig(const mcap::Message& message) {
    Result<rec::RigRecord> record = ParseAs<rec::RigRecord>(message);
    if (!record) return Err(record.error().WithContext("rig calibration"));
    Rig rig = FromProto(record->calibration());
    if (Status status = Validate(rig); !status.ok())
      return Err(status.WithContext("rig calibration"));
    return rig;
  }

  Content ContentOfChannel(mcap::ChannelId channel) const {
    const auto found = contents_.find(channel);
    return found == contents_.end() ? Content::kOther : found->second;
  }

  std::string TopicOf(mcap::ChannelId channel) const {
    const auto found = index_.definitions.channels.find(channel);
    return found == index_.definitions.channels.end() ? fmt::format("channel {}", channel)
                                                      : found->second.topic;
  }

  Result<std::optional<RecordedItem>> ParseMessage(Content content,
                                                   const mcap::Message& message) const {
    const CaptureTime time = ToCaptureTime(message.log_time);
    switch (content) {
      case Content::kRawDepth:
        return ParseDepth<foxglove::RawImage>(message, time);
      case Content::kCompressedDepth:
        return ParseDepth<foxglove::CompressedImage>(message, time);
      case Content::kRawThermal:
        return ParseThermal<foxglove::RawImage>(message, time);
      case Content::kCompressedThermal:
        return ParseThermal<foxglove::CompressedImage>(message, time);
      case Content::kNuc:
        return ParseItem<rec::NucRecord>(
            message, [](const rec::NucRecord& record) { return rec::FromMessage(record); });
      case Content::kClock:
        return ParseItem<rec::ClockStepRecord>(
            message, [](const rec::ClockStepRecord& record) { return rec::FromMessage(record); });
      case Content::kExternalOdometry:
        return ParseItem<foxglove::PoseInFrame>(
            message, [](const foxglove::PoseInFrame& pose) { return rec::FromMessage(pose); });
      case Content::kLog:
        return ParseItem<foxglove::Log>(
            message, [](const foxglove::Log& log) { return rec::FromMessage(log); });
      default:
        return ParsePose(message);
    }
  }

  Result<std::optional<RecordedItem>> ParsePose(const mcap::Message& message) const {
    return ParseItem<foxglove::FrameTransform>(
        message, [&](const foxglove::FrameTransform& transform) -> Result<RecordedPose> {
          Result<StampedPose> pose = rec::FromMessage(transform);
          if (!pose) return Err(std::move(pose.error()));
          // Without the topic's slash.
          return RecordedPose{.stream = TopicOf(message.channel_id).substr(1), .pose = *pose};
        });
  }

  const std::unique_ptr<ByteSource> source_;
  const mcap::FileIndex index_;
  mcap::MessageStream stream_;
  std::map<mcap::ChannelId, Content> contents_;
  RecordingInfo info_;
};

/// Our own files say their version; files from elsewhere do not and are read as far as they fit.
Status CheckVersion(const mcap::FileIndex& index) {
  for (const mcap::Metadata& metadata : index.metadata) {
    if (metadata.name != kRecordingMetadataName) continue;
    const auto version = metadata.values.find("version");
    if (version == metadata.values.end()) continue;
    const std::string& text = version->second;
    int major = 0;
    // Stops at the dot: a minor version only adds what older readers skip.
    std::from_chars(text.data(), text.data() + text.size(), major);
    if (major == kRecordingMajorVersion) continue;
    return FailedPrecondition(fmt::format(
        "recording format {} is not supported, this program reads {}.x: update Isotherm", text,
        kRecordingMajorVersion));
  }
  return OkStatus();
}

}  // namespace

Result<std::unique_ptr<RecordingReader>> MakeRecordingReader(std::unique_ptr<ByteSource> source) {
  Result<mcap::FileIndex> index = mcap::ReadFileIndex(*source);
  if (!index) return Err(std::move(index.error()));
  if (Status status = CheckVersion(*index); !status.ok()) return Err(std::move(status));
  return std::make_unique<McapRecordingReader>(std::move(source), std::move(*index));
}

Result<std::unique_ptr<RecordingReader>> RecordingReader::Open(const std::filesystem::path& path) {
  auto source = OpenFileSource(path);
  if (!source) return Err(std::move(source.error()));
  auto reader = MakeRecordingReader(std::move(*source));
  if (!reader) return Err(reader.error().WithContext(path.string()));
  return reader;
}

}  // namespace isotherm
