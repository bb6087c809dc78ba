#include "common/recording/recording_topics.h"

#include <string>

#include "common/recording/feedback.pb.h"
#include "common/recording/recording_protos.h"
#include "common/recording/schema.h"

namespace isotherm::recording {

std::optional<StampedPose> TrackedPoseIn(std::string_view feedback_message) {
  FeedbackRecord record;
  if (!record.ParseFromArray(feedback_message.data(), static_cast<int>(feedback_message.size())) ||
      !record.has_world_from_depth()) {
    return std::nullopt;
  }
  if (record.tracking() != "tracked" && record.tracking() != "degraded") return std::nullopt;
  foxglove::FrameTransform transform;
  *transform.mutable_timestamp() = record.timestamp();
  *transform.mutable_translation() = record.world_from_depth().translation();
  *transform.mutable_rotation() = record.world_from_depth().rotation();
  const Result<StampedPose> pose = FromMessage(transform);
  return pose ? std::optional(*pose) : std::nullopt;
}

Status WriteGroundtruth(std::string_view frame, const StampedPose& pose, RecordingWriter& writer) {
  foxglove::FrameTransform transform = ToMessage(pose);
  transform.set_child_frame_id(std::string(frame));
  const google::protobuf::Descriptor& type = *foxglove::FrameTransform::descriptor();
  return writer.WriteMessage(kGroundtruthTopic, type.full_name(), SerializedSchema(type), pose.time,
                             transform.SerializeAsString());
}

}  // namespace isotherm::recording
