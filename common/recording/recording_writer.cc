#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/codec/codec.h"
#include "common/recording/frame_protos.h"
#include "common/recording/mcap_writer.h"
#include "common/recording/recording_protos.h"
#include "common/recording/recording_streams.h"
#include "common/recording/schema.h"

namespace isotherm {
namespace {

namespace rec = recording;
using foxglove::CompressedImage;
using foxglove::RawImage;

class McapRecordingWriter final : public RecordingWriter {
 public:
  McapRecordingWriter(std::unique_ptr<mcap::Writer> writer, const RecordingOptions& options)
      : writer_(std::move(writer)), storage_(options.image_storage) {}
  ~McapRecordingWriter() override { static_cast<void>(Close()); }

  Status Write(const Rig& rig) override {
    const bool follows_another = rig_written_at_.has_value();
    rig_ = rig;
    rig_written_at_.reset();
    // Before the first frame nothing says what time it is.
    if (!last_time_) return OkStatus();
    if (!follows_another) return WriteRig(*last_time_);
    // Behind all copies of the one before; the reader must not have to search the file for it.
    const CaptureTime time = *last_time_ + Nanoseconds(1);
    ISOTHERM_RETURN_IF_ERROR(WriteRig(time));
    return WriteMetadata(kRigMetadataName,
                         {{std::string(kRigSince), fmt::format("{}", ToNanoseconds(time))}});
  }

  Status Write(const EncodedDepthFrame& frame, const std::optional<CaptureTime>& arrival) override {
    ++offered_;
    return WriteFrame(rec::kDepthTopic, frame, arrival);
  }
  Status Write(const EncodedThermalFrame& frame,
               const std::optional<CaptureTime>& arrival) override {
    ++offered_;
    return WriteFrame(rec::kThermalTopic, frame, arrival);
  }

  Status Write(const NucEvent& event) override {
    return Append(rec::kNucTopic, event.start, event.start, rec::ToMessage(event));
  }

  Status Write(const ClockStep& step) override {
    return Append(rec::kClockTopic, step.time, step.time, rec::ToMessage(step));
  }

  Status Write(const ExternalOdometry& pose) override {
    // Filed under its own time, unless that is nonsense: it must not stretch the recording.
    constexpr Nanoseconds kFar = std::chrono::seconds(10);
    const CaptureTime newest = last_time_.value_or(pose.time);
    const bool is_far = pose.time < newest - kFar || pose.time > newest + kFar;
    const CaptureTime time = is_far ? newest : pose.time;
    return Append(rec::kExternalOdometryTopic, time, time, rec::ToMessage(pose));
  }

  Status WritePose(std::string_view stream, const StampedPose& pose) override {
    const std::string topic = fmt::format("/{}", stream);
    if (topic != rec::kGroundtruthTopic && topic != rec::kTrajectoryTopic) {
      return InvalidArgument(
          fmt::format("unknown pose stream \"{}\" (groundtruth, trajectory)", stream));
    }
    return Append(topic, pose.time, pose.time, rec::ToMessage(pose));
  }

  Status WriteMetadata(std::string_view name,
                       const std::map<std::string, std::string>& values) override {
    if (closed_) return AlreadyClosed();
    return writer_->WriteMetadata({.name = std::string(name), .values = values});
  }

  Status WriteLog(CaptureTime time, std::string_view level, std::string_view text) override {
    return Append(rec::kLogTopic, time, time, rec::ToLogMessage(time, level, text));
  }

  Status WriteMessage(std::string_view topic, std::string_view schema_name, std::string_view schema,
                      CaptureTime time, std::string_view payload) override {
    const auto channel = ChannelFor(topic, schema_name, [schema] { return std::string(schema); });
    if (!channel) return channel.error();
    return AppendBytes(*channel, time, time, payload);
  }

  Status Flush() override { return closed_ ? AlreadyClosed() : writer_->Flush(); }

  Status Close() override {
    // A recording without any message still says whose it was.
    if (!closed_ && rig_ && !last_time_) {
      last_time_ = CaptureTime{};
      static_cast<void>(WriteRig(*last_time_));
    }
    closed_ = true;
    return writer_->Close();
  }

  RecordingStats stats() const override {
    RecordingStats stats;
    stats.depth_frames = MessageCount(rec::kDepthTopic);
    stats.thermal_frames = MessageCount(rec::kThermalTopic);
    stats.failed = offered_ - stats.depth_frames - stats.thermal_frames;
    stats.unsynced = UnsyncedCount(rec::kDepthTopic) + UnsyncedCount(rec::kThermalTopic);
    stats.bytes = writer_->bytes();
    return stats;
  }

 private:
  // The rig is repeated this often, so that a file cut or damaged anywhere keeps a copy near; it
  // takes about a kilobyte.
  static constexpr Nanoseconds kRigInterval = std::chrono::seconds(10);

  struct TopicChannel {
    mcap::ChannelId id = 0;
    std::string schema_name;
  };

  static Status AlreadyClosed() { return FailedPrecondition("the recording is closed"); }

  template <typename Frame>
  Status WriteFrame(std::string_view topic, const Frame& frame,
                    const std::optional<CaptureTime>& arrival) {
    const CaptureTime time = frame.header.capture_time;
    EncodedImage image = frame.image;
    if (storage_ == ImageStorage::kCompact) {
      auto message = rec::ToMessage<CompressedImage>(frame, arrival);
      rec::SetImageData(std::move(image), message);
      return Append(topic, time, arrival.value_or(time), message);
    }
    ISOTHERM_RETURN_IF_ERROR(MakeRaw(image));
    auto message = rec::ToMessage<RawImage>(frame, arrival);
    rec::SetImageData(std::move(image), message);
    return Append(topic, time, arrival.value_or(time), message);
  }

  static Status MakeRaw(EncodedImage& image) {
    Result<Image<std::uint16_t>> pixels = Decode(image);  // Checks the size of raw images as well.
    if (!pixels) return pixels.error().WithContext("frame is not recorded");
    if (IsRaw(image.encoding)) return OkStatus();
    image.encoding = IsScaled(image.encoding) ? Encoding::kScaledRaw16 : Encoding::kRaw16;
    image.payload.clear();
    image.payload.reserve(pixels->size() * sizeof(std::uint16_t));
    for (const std::uint16_t pixel : pixels->pixels()) {
      image.payload.push_back(static_cast<std::uint8_t>(pixel));
      image.payload.push_back(static_cast<std::uint8_t>(pixel >> 8));
    }
    return OkStatus();
  }

  /// Writes the rig, again if it was written before: without it a recording is of little use, and
  /// the chunk that has it may be the one that is damaged.
  Status WriteRig(CaptureTime time) {
    rig_written_at_ = time;
    const Rig& rig = *rig_;
    ISOTHERM_RETURN_IF_ERROR(Append(rec::kRigTopic, time, time, rec::ToMessage(time, rig)));
    if (rig.depth) {
      ISOTHERM_RETURN_IF_ERROR(
          Append(rec::kDepthInfoTopic, time, time, rec::ToMessage(time, "depth", *rig.depth)));
    }
    // What is recorded for viewers has the rig's geometry in their terms.
    if (rig.T_thermal_depth && storage_ == ImageStorage::kViewable) {
      ISOTHERM_RETURN_IF_ERROR(Append(rec::kThermalPoseTopic, time, time,
                                      rec::ThermalTransform(time, *rig.T_thermal_depth)));
    }
    if (!rig.thermal) return OkStatus();
    return Append(rec::kThermalInfoTopic, time, time,
                  rec::ToMessage(time, "thermal", *rig.thermal));
  }

  template <typename Message>
  Status Append(std::string_view topic, CaptureTime time, CaptureTime publish_time,
                const Message& message) {
    const auto channel = ChannelFor(topic, Message::descriptor()->full_name(),
                                    [] { return rec::SerializedSchema(*Message::descriptor()); });
    if (!channel) return channel.error();
    return AppendBytes(*channel, time, publish_time, message.SerializeAsString());
  }

  Status AppendBytes(mcap::ChannelId channel, CaptureTime time, CaptureTime publish_time,
                     std::string_view bytes) {
    if (closed_) return AlreadyClosed();
    const std::int64_t log_ns = ToNanoseconds(time);
    if (log_ns < 0) {
      return InvalidArgument(fmt::format("time {} ns lies before the Unix epoch", log_ns));
    }
    last_time_ = std::max(last_time_.value_or(time), time);
    // Goes through this function again, with rig_written_at_ set first (WriteRig), so that it ends.
    if (rig_ && (!rig_written_at_ || time - *rig_written_at_ >= kRigInterval))
      ISOTHERM_RETURN_IF_ERROR(WriteRig(time));
    const std::int64_t publish_ns = std::max<std::int64_t>(ToNanoseconds(publish_time), 0);
    return writer_->WriteMessage(
        channel, static_cast<std::uint64_t>(log_ns), static_cast<std::uint64_t>(publish_ns),
        std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
  }

  template <typename MakeSchema>
  Result<mcap::ChannelId> ChannelFor(std::string_view topic, std::string_view schema_name,
                                     MakeSchema make_schema) {
    const auto found = channels_.find(topic);
    if (found != channels_.end()) {
      // MCAP allows one schema per channel; readers would take the second kind for damage.
      if (found->second.schema_name == schema_name) return found->second.id;
      return Err(InvalidArgument(
          fmt::format("{} carries {}, not {}", topic, found->second.schema_name, schema_name)));
    }
    auto schema = schemas_.find(schema_name);
    if (schema == schemas_.end()) {
      const mcap::SchemaId id = writer_->AddSchema(schema_name, "protobuf", make_schema());
      schema = schemas_.emplace(schema_name, id).first;
    }
    const mcap::ChannelId id = writer_->AddChannel(schema->second, topic, "protobuf");
    channels_.emplace(topic, TopicChannel{.id = id, .schema_name = std::string(schema_name)});
    return id;
  }

  std::uint64_t MessageCount(std::string_view topic) const {
    const auto found = channels_.find(topic);
    return found == channels_.end() ? 0 : writer_->message_count(found->second.id);
  }

  std::uint64_t UnsyncedCount(std::string_view topic) const {
    const auto found = channels_.find(topic);
    return found == channels_.end() ? 0 : writer_->unsynced_count(found->second.id);
  }

  const std::unique_ptr<mcap::Writer> writer_;
  const ImageStorage storage_;
  std::map<std::string, TopicChannel, std::less<>> channels_;
  std::map<std::string, mcap::SchemaId, std::less<>> schemas_;
  std::optional<CaptureTime> last_time_;
  std::optional<Rig> rig_;
  std::optional<CaptureTime> rig_written_at_;
  std::uint64_t offered_ = 0;
  bool closed_ = false;
};

Status Validate(const RecordingOptions& options) {
  // Smaller chunks would be mostly definitions, which each one repeats.
  constexpr std::size_t kMinChunkBytes = 4096;
  // A power cut costs what was not flushed: users are promised a second at most.
  constexpr Nanoseconds kMaxFlushInterval = std::chrono::seconds(1);
  if (options.chunk_bytes < kMinChunkBytes ||
      options.chunk_bytes > mcap::Writer::kMaxMessageBytes) {
    return InvalidArgument(fmt::format("chunk_bytes must be {} to {}, not {}", kMinChunkBytes,
                                       mcap::Writer::kMaxMessageBytes, options.chunk_bytes));
  }
  if (options.flush_interval <= Nanoseconds(0) || options.flush_interval > kMaxFlushInterval) {
    return InvalidArgument(
        fmt::format("flush_interval must be more than 0 and at most 1 s, not {} s",
                    ToSeconds(options.flush_interval)));
  }
  return OkStatus();
}

}  // namespace

Result<std::unique_ptr<RecordingWriter>> MakeRecordingWriter(std::unique_ptr<ByteSink> sink,
                                                             const RecordingOptions& options) {
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  auto writer = mcap::Writer::Create(
      std::move(sink),
      {.library = "isotherm " ISOTHERM_VERSION,
       .chunk_bytes = options.chunk_bytes,
       .chunk_duration_ns = static_cast<std::uint64_t>(options.flush_interval.count()),
       .sync = options.sync,
       .clock = options.clock});
  if (!writer) return Err(std::move(writer.error()));
  const mcap::Metadata version{.name = std::string(kRecordingMetadataName),
                               .values = {{"version", fmt::format("{}.{}", kRecordingMajorVersion,
                                                                  kRecordingMinorVersion)}}};
  if (Status status = (*writer)->WriteMetadata(version); !status.ok())
    return Err(std::move(status));
  return std::make_unique<McapRecordingWriter>(std::move(*writer), options);
}

Result<std::unique_ptr<RecordingWriter>> RecordingWriter::Create(const std::filesystem::path& path,
                                                                 const RecordingOptions& options) {
  if (Status status = Validate(options); !status.ok()) return Err(std::move(status));
  auto sink = CreateFileSink(path);
  if (!sink) return Err(std::move(sink.error()));
  auto writer = MakeRecordingWriter(std::move(*sink), options);
  // A file without even a beginning is nothing but a name that is taken.
  std::error_code ignored;
  if (!writer && std::filesystem::is_regular_file(path, ignored)) {
    std::filesystem::remove(path, ignored);
  }
  return writer;
}

}  // namespace isotherm
