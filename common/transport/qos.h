#pragma once

#include <memory>

#include "common/time/time_types.h"
#include "common/transport/topics.h"

struct dds_qos;

namespace isotherm {

/// Frames of one stream that writer and reader keep: about a second at 30 Hz, so that repeating
/// what a link lost has time to succeed.
inline constexpr int kFrameHistory = 32;
/// A flow window below the history cannot overflow it, neither in the writer nor in the reader.
inline constexpr int kMaxFlowWindowFrames = kFrameHistory - 4;
/// Odometry poses that are kept per rig: more than two seconds at 200 Hz.
inline constexpr int kExternalOdometryHistory = 512;

/// Requests for pieces of recordings, and answers, that are kept: 2 MB of the largest pieces.
inline constexpr int kRecordingHistory = 32;
/// Whoever asks waits for no more answers at once; two can ask at the same time.
inline constexpr int kMaxRecordingRequests = kRecordingHistory / 2;

/// A write of a frame waits at most this long for room in the middleware's buffers: three frames at
/// 30 Hz. Longer: the publish thread notices later that the link is stuck; shorter: a short stall
/// of the network costs frames. Not tuned.
inline constexpr Nanoseconds kMaxFrameBlocking = std::chrono::milliseconds(100);
/// A write of any other message waits at most this long. The edge's time to stop contains it
/// (stop_limits.h).
inline constexpr Nanoseconds kMaxMessageBlocking = std::chrono::milliseconds(50);

/// Frees a set of qualities of service.
struct DdsQosDeleter {
  void operator()(dds_qos* qos) const;
};
using QosPtr = std::unique_ptr<dds_qos, DdsQosDeleter>;

const char* TopicName(TopicId topic);
/// The same for topic, writer and reader, so that both sides cannot disagree.
QosPtr MakeQos(TopicId topic);
/// For a reader, which keeps more of what is not yet taken than a writer does: somebody else's
/// sample under the same key must not push out the one that matters.
QosPtr MakeReaderQos(TopicId topic);

}  // namespace isotherm
