#include "common/transport/qos.h"

#include <dds/dds.h>

#include <algorithm>
#include <array>

namespace isotherm {
namespace {

/// Says how one topic is carried. All are keep-last: keep-all would let an outage block the writer.
struct Profile {
  const char* name;
  /// Samples kept per rig, on both sides.
  std::int32_t history;
  /// Kept for readers that come later (transient-local). Frames too: what is written between the
  /// moment the writer sees the reader and the moment the reader sees the writer would be lost
  /// otherwise.
  bool keep_for_late_joiners;
  /// Longest time that a write may wait for room in the middleware's buffers.
  dds_duration_t max_blocking;
  /// A writer that is silent for this long counts as gone. The middleware keeps it alive by itself.
  dds_duration_t liveliness;
  bool reliable = true;  ///< It sends again what is lost.
};

// See MakeReaderQos. Sixteen samples of small topics are kilobytes.
constexpr std::int32_t kMinReaderHistory = 16;
// A third of a second of both cameras: so long may the ground's thread be away.
constexpr std::int32_t kPieceHistory = 1024;
constexpr dds_duration_t kFrameBlocking = kMaxFrameBlocking.count();
constexpr dds_duration_t kSmallBlocking = kMaxMessageBlocking.count();
// Smaller: a peer on a busy network or computer counts as gone while it is there; larger: a link
// that was cut is noticed later. Not tuned.
constexpr dds_duration_t kLease = DDS_SECS(1);

// The major version is in the names, so that what a peer of another one sends is not even
// delivered. The hello has none, and its type is frozen: it is how they tell each other.
static_assert(kWireMajor == 3);
constexpr std::array<Profile, 16> kProfiles = {{
    {"isotherm/3/depth", kFrameHistory, true, kFrameBlocking, kLease},
    {"isotherm/3/thermal", kFrameHistory, true, kFrameBlocking, kLease},
    {"isotherm/3/rig", 1, true, kSmallBlocking, kLease},
    {"isotherm/3/edge_status", 1, true, kSmallBlocking, kLease},
    // No order may be overwritten by the next one, and none may reach an edge that starts later.
    {"isotherm/3/command", 16, false, kSmallBlocking, kLease},
    {"isotherm/3/command_result", 16, false, kSmallBlocking, kLease},
    {"isotherm/3/receipt", 1, false, kSmallBlocking, kLease},
    {"isotherm/3/feedback", 1, false, kSmallBlocking, kLease},
    {"isotherm/hello", 1, true, kSmallBlocking, kLease},
    {"isotherm/3/external_odometry", kExternalOdometryHistory, true, kSmallBlocking, kLease},
    // Not kept: what a ground that comes later lacks, it asks for.
    {"isotherm/3/backfill_depth", kFrameHistory, false, kFrameBlocking, kLease},
    {"isotherm/3/backfill_thermal", kFrameHistory, false, kFrameBlocking, kLease},
    // Whoever asks keeps no more than that under way (kMaxRecordingRequests), and asks again.
    {"isotherm/3/recording_request", kRecordingHistory, false, kSmallBlocking, kLease},
    {"isotherm/3/recording_piece", kRecordingHistory, false, kFrameBlocking, kLease},
    {"isotherm/3/frame_piece", kPieceHistory, false, kSmallBlocking, kLease, false},
    {"isotherm/3/piece_report", 1, false, kSmallBlocking, kLease},
}};

const Profile& ProfileOf(TopicId topic) { return kProfiles.at(static_cast<std::size_t>(topic)); }

}  // namespace

void DdsQosDeleter::operator()(dds_qos* qos) const { dds_delete_qos(qos); }

const char* TopicName(TopicId topic) { return ProfileOf(topic).name; }

QosPtr MakeQos(TopicId topic) {
  const Profile& profile = ProfileOf(topic);
  QosPtr qos(dds_create_qos());
  dds_qset_reliability(qos.get(),
                       profile.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       profile.max_blocking);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, profile.history);
  dds_qset_durability(qos.get(), profile.keep_for_late_joiners ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                               : DDS_DURABILITY_VOLATILE);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, profile.history,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_liveliness(qos.get(), DDS_LIVELINESS_AUTOMATIC, profile.liveliness);
  dds_qset_destination_order(qos.get(), DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  // A writer that leaves does not take its last samples with it.
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

QosPtr MakeReaderQos(TopicId topic) {
  QosPtr qos = MakeQos(topic);
  // Twice what a writer keeps, for the samples of another process that uses the same name.
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST,
                   std::max(2 * ProfileOf(topic).history, kMinReaderHistory));
  return qos;
}

}  // namespace isotherm
