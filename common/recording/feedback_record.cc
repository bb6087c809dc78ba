#include "common/recording/feedback_record.h"

#include <Eigen/Geometry>
#include <cmath>

#include "common/recording/feedback.pb.h"
#include "common/recording/proto_parts.h"
#include "common/recording/schema.h"

namespace isotherm {
namespace {

void SetPose(const RigidTransform& pose, recording::PoseRecord& record) {
  recording::SetVector(pose.translation(), *record.mutable_translation());
  recording::SetQuaternion(Eigen::Quaterniond(pose.linear()), *record.mutable_rotation());
}

void SetFractions(const CoverageFractions& fractions, recording::CoverageRecord& record) {
  record.set_good(fractions.good);
  record.set_acceptable(fractions.acceptable);
  record.set_bad(fractions.bad);
  record.set_never_measured(fractions.never_measured);
}

recording::FeedbackRecord ToRecord(const Feedback& feedback,
                                   const std::optional<CaptureTime>& arrival) {
  recording::FeedbackRecord record;
  recording::SetTime(feedback.capture_time, *record.mutable_timestamp());
  if (arrival) recording::SetTime(*arrival, *record.mutable_arrival());
  record.set_session(feedback.session);
  record.set_frame_number(feedback.frame_number);
  record.set_tracking(std::string(ToString(feedback.tracking_state)));
  if (feedback.T_world_depth) SetPose(*feedback.T_world_depth, *record.mutable_world_from_depth());
  if (std::isfinite(feedback.view.good)) SetFractions(feedback.view, *record.mutable_view());
  if (std::isfinite(feedback.model.good)) SetFractions(feedback.model, *record.mutable_model());
  record.set_covered_area_m2(feedback.covered_area_m2);
  for (const Advice advice : feedback.advice) record.add_advice(std::string(ToString(advice)));
  record.set_reason(feedback.advice_reason);
  record.set_done(feedback.done);
  if (feedback.T_world_depth_next)
    SetPose(*feedback.T_world_depth_next, *record.mutable_world_from_next());
  if (feedback.T_depth_next) SetPose(*feedback.T_depth_next, *record.mutable_depth_from_next());
  record.set_next_gain_m2(feedback.next_gain_m2);
  record.set_frames_left_out(feedback.frames_left_out);
  record.set_link(feedback.link);
  return record;
}

template <typename Message>
Status WriteAs(std::string_view topic, CaptureTime time, const Message& message,
               RecordingWriter& writer) {
  const google::protobuf::Descriptor& descriptor = *Message::descriptor();
  return writer.WriteMessage(topic, descriptor.full_name(), recording::SerializedSchema(descriptor),
                             time, message.SerializeAsString());
}

}  // namespace

Status WriteFeedback(const Feedback& feedback, const std::optional<CaptureTime>& arrival,
                     RecordingWriter& writer, const std::optional<CaptureTime>& newest) {
  const CaptureTime time = newest.value_or(feedback.capture_time);
  ISOTHERM_RETURN_IF_ERROR(
      WriteAs(kFeedbackRecordTopic, time, ToRecord(feedback, arrival), writer));
  if (feedback.image.empty()) return OkStatus();
  foxglove::CompressedImage image;
  recording::SetTime(feedback.capture_time, *image.mutable_timestamp());
  image.set_frame_id(recording::kDepthFrame);
  image.set_format("png");
  image.set_data(feedback.image.data(), feedback.image.size());
  return WriteAs(kFeedbackImageTopic, time, image, writer);
}

}  // namespace isotherm
