#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/frame/frame.h"
#include "common/geometry/external_odometry.h"
#include "common/geometry/pose_covariance.h"
#include "common/geometry/rigid_transform.h"
#include "common/rig/rig.h"
#include "common/time/kernel_clock.h"
#include "common/time/time_types.h"

/// These types cross the link besides frames. idl/ says how they are packed, qos.cc how they are
/// carried. The bounds of the link are the constants below: writers cut text and
/// lists that are longer, and leave out an image that is too large.
namespace isotherm {

/// Version of the wire types. Minor: members were added, both sides still understand each other.
/// Major: they do not and say so (CheckCompatible()); the topics have other names (qos.cc).
inline constexpr std::uint16_t kWireMajor = 3;
inline constexpr std::uint16_t kWireMinor = 0;

/// Ends each sample (idl/isotherm_frames.idl). Not 0, which is what a missing member reads as.
inline constexpr std::uint8_t kWireMark = 0xA5;

inline constexpr std::size_t kMaxIdBytes = 32;     ///< edge_id, serial numbers, names of stages.
inline constexpr std::size_t kMaxTextBytes = 256;  ///< Sentences.
inline constexpr std::size_t kMaxPayloadBytes = 8U << 20;  ///< One encoded frame.
inline constexpr std::size_t kMaxFramePixels = 1U << 22;   ///< One frame: 2048 x 2048.
inline constexpr std::size_t kMaxHoles = 64;               ///< Ranges in one receipt.
inline constexpr std::size_t kMaxDropReasons = 16;
inline constexpr std::size_t kMaxAdvice = 8;
inline constexpr std::size_t kMaxMarks = 8;        ///< In one status.
inline constexpr std::size_t kMaxMarkBytes = 128;  ///< A mark says no more.
inline constexpr std::size_t kMaxStageLatencies = 16;
inline constexpr std::size_t kMaxConfidenceImageBytes = 20'000;  ///< Confidence image.

/// Names the two ends of the link.
enum class Role : std::uint8_t { kEdge = 0, kGround = 1 };

/// Says who a process is and what it speaks. Its wire type is frozen. It is written once at start
/// and kept for late joiners.
struct Hello {
  Role role = Role::kEdge;
  std::uint16_t wire_major = kWireMajor;
  std::uint16_t wire_minor = kWireMinor;
  std::string software_version{};
  std::string host{};
};

/// One sentence that says which side is old, or ok.
Status CheckCompatible(const Hello& own, const Hello& peer);

/// Holds what one camera of the rig delivers.
struct StreamMode {
  int width = 0;  ///< Pixels; 0 = the rig has no such camera.
  int height = 0;
  double rate_hz = 0.0;  ///< Nominal.
  Encoding encoding = Encoding::kRaw16;
  std::string serial{};  ///< Serial number of the camera; empty = unknown.
  std::string model{};   ///< Driver and model, for people; empty = not a camera, or unknown.

  friend bool operator==(const StreamMode&, const StreamMode&) = default;
};

/// "640x480@30".
std::string ModeText(const StreamMode& mode);

/// Calibration and active modes. Written at the start of each scan, kept for late joiners.
struct RigDescription {
  std::uint64_t session = 0;
  Rig rig;
  StreamMode depth;
  StreamMode thermal;
  /// Frames come as fast as the ground takes them (a replay), not as a camera makes them.
  bool waits_for_ground = false;
};

/// An odometry pose on its way to the ground.
struct ExternalOdometrySample {
  std::uint64_t session = 0;
  std::uint64_t number = 0;  ///< Counts the session's samples from 0, so that losses are seen.
  ExternalOdometry pose;
};

/// Says how far the edge's session has come.
enum class ScanState : std::uint8_t {
  kIdle = 0,      ///< No session yet.
  kScanning = 1,  ///< Frames are being published.
  kEnded = 2,     ///< The counts in the status are final: the ground can close the session.
};

/// Says what happens when the link or the ground is slower than the cameras.
enum class PublishPolicy : std::uint8_t {
  kLive = 0,      ///< Never wait: latency is bounded and what is left behind is counted.
  kLossless = 1,  ///< Wait for receipts, so that frames arrive in order.
};

/// Says who orders corrections of the thermal camera.
enum class NucPolicy : std::uint8_t {
  kAutomatic = 0,  ///< The edge decides, by drift and interval.
  kManual = 1,     ///< Only by command.
  kCamera = 2,     ///< The camera decides by itself.
};
std::string_view ToString(NucPolicy policy);
/// Returns the state, or where a correction came from, in the operator's words.
std::string_view ToString(NucState state);
std::string_view ToString(NucSource source);

/// The thermal camera's correction as the edge sees it.
struct NucReport {
  NucState state = NucState::kUnknown;
  NucSource source = NucSource::kUnknown;
  NucPolicy policy = NucPolicy::kAutomatic;
  double seconds_since = std::numeric_limits<double>::quiet_NaN();  ///< Since the shutter opened.
  std::uint32_t closings_per_minute = 0;
  double closed_fraction = std::numeric_limits<double>::quiet_NaN();  ///< In the last minute, 0..1.
  bool storm = false;       ///< More closings per minute than allowed.
  bool warming_up = false;  ///< Temperatures may still be off.
  double fpa_celsius = std::numeric_limits<double>::quiet_NaN();
  double housing_celsius = std::numeric_limits<double>::quiet_NaN();
  std::string reason{};  ///< Why the state is as it is; empty = nothing to say.
};

/// Counts the frames that were dropped for one reason.
struct DropCount {
  std::string reason{};
  std::uint64_t frames = 0;
};

/// Counters of one stream on the edge: captured = published + dropped (all reasons) + in the
/// queues.
struct StreamStatus {
  std::uint64_t captured = 0;
  std::uint64_t published = 0;
  std::uint64_t next_frame_number =
      0;                 ///< One above the highest published; at the end, no higher one will come.
  double rate_hz = 0.0;  ///< Measured over the last seconds.
  std::uint32_t queue_frames = 0;    ///< Waiting to be published.
  std::vector<DropCount> dropped{};  ///< At most kMaxDropReasons.
};

/// Tells how old depth frames were, from their capture time to the arrival of the feedback on them,
/// both on the edge. NaN = no feedback yet, or the edge replays with times of its own.
struct FeedbackLatency {
  std::uint64_t count = 0;  ///< Messages of feedback.
  double p50_s = std::numeric_limits<double>::quiet_NaN();
  double p99_s = std::numeric_limits<double>::quiet_NaN();
};

/// Says what became of a camera.
enum class CameraState : std::uint8_t {
  kNone = 0,  ///< Not a camera: a replay, a simulation, nothing.
  kWorking = 1,
  kLost = 2,   ///< Unplugged, silent or failing; it is opened again and again.
  kBlind = 3,  ///< It works, but shows (almost) nothing: covered, too close, too far.
};

/// One camera as the edge sees it.
struct CameraReport {
  CameraState state = CameraState::kNone;
  std::uint32_t failures = 0;  ///< How often it was lost.
  /// From the arrival of a frame to its capture time being known. NaN = not measured.
  double stamping_p50_s = std::numeric_limits<double>::quiet_NaN();
  double stamping_p99_s = std::numeric_limits<double>::quiet_NaN();
  /// One sigma of the newest frame's capture time. NaN = no frame yet, 0 = not estimated yet.
  double stamp_sigma_s = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t unsynchronised_frames = 0;  ///< Whose capture time must not be trusted.
};

/// The edge's wall clock as the edge sees it. NaN = not known.
struct ClockReport {
  bool synchronised = false;  ///< Somebody (chrony) disciplines it, says the kernel.
  double offset_s = std::numeric_limits<double>::quiet_NaN();  ///< Still being corrected.
  double estimated_error_s = std::numeric_limits<double>::quiet_NaN();
  double max_error_s = std::numeric_limits<double>::quiet_NaN();  ///< Bound of the error.
  /// The clock was set this often in this session, and by this much in all. Capture times do not
  /// follow: the wall clock is ahead of them by the sum.
  std::uint64_t steps = 0;
  double step_sum_s = 0.0;
  friend bool operator==(const ClockReport&, const ClockReport&) = default;
};

/// Converts what the kernel tells; it tells of no steps, so there are none.
ClockReport ToReport(const KernelClock& clock);
/// "synchronised, off by about 0.12 ms, at most 1.2 ms, set 2 times by +3.020 s in all".
std::string ToText(const ClockReport& clock);
/// "+-0.05 ms depth, +-0.09 ms thermal, UNSYNCHRONISED frames 3 depth, 0 thermal"; empty if nothing
/// is known.
std::string StampText(const CameraReport& depth, const CameraReport& thermal);

/// The edge's answer to the newest Receipt::clock_ping, by its wall clock: the ground compares it
/// with its own (ClockComparison).
struct ClockEcho {
  std::uint64_t ping = 0;
  CaptureTime received{};
  CaptureTime sent{};
};

/// A moment of the scan that somebody wants to find again, in words.
struct ScanMark {
  CaptureTime time{};  ///< The capture time of the newest frame.
  std::string text{};  ///< At most kMaxMarkBytes.
  friend bool operator==(const ScanMark&, const ScanMark&) = default;
};

/// State of the edge at 1 Hz and at each change of scan_state; the last one is kept for late
/// joiners. NaN = not known.
struct EdgeStatus {
  std::uint64_t session = 0;
  CaptureTime time{};
  ScanState scan_state = ScanState::kIdle;
  PublishPolicy publish_policy = PublishPolicy::kLive;
  StreamStatus depth;
  StreamStatus thermal;
  NucReport nuc;
  double spool_fill_ratio = std::numeric_limits<double>::quiet_NaN();  ///< 0..1; NaN: no record.
  std::uint64_t spool_frames = 0;  ///< Recorded, and the ground lacks them as far as is known.
  ClockReport clock;
  std::optional<ClockEcho> clock_echo;
  std::uint64_t disk_free_bytes = 0;  ///< Free space on the rig's disk; 0 = not known, 1 = none.
  double cpu_temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  FeedbackLatency feedback;  ///< Feedback in this session.
  CameraReport depth_camera;
  CameraReport thermal_camera;
  std::vector<ScanMark> marks{};  ///< The newest kMaxMarks of this session.
  /// Process (PeerHandle) of the ground station whose receipts count; 0: none yet.
  std::uint64_t served_ground = 0;
  std::uint64_t spool_bytes = 0;  ///< About the size of spool_frames.
  /// Frames that the recording has deleted, to keep the newest, before the ground had them.
  std::uint64_t frames_gone = 0;
  /// The recording keeps so much of the scan, seconds; 0: all of it, NaN: it is not known yet.
  double spool_keeps_s = 0.0;
};

/// Names what the ground can order.
enum class CommandKind : std::uint8_t {
  kStartScan = 0,
  kStopScan = 1,
  kTriggerNuc = 2,
  kSetNucPolicy = 3,
  kSetPublishPolicy = 4,
  kHoldNuc = 5,  ///< No corrections for a while.
  kMark = 6,     ///< Remember this moment of the scan.
};

/// An order from the ground. Every command is answered by a CommandResult with the same number.
struct Command {
  std::uint64_t number = 0;  ///< Chosen by the sender, unique within its run.
  CaptureTime time{};        ///< When it was given, ground wall clock.
  CommandKind kind = CommandKind::kStartScan;
  NucPolicy nuc_policy = NucPolicy::kAutomatic;         ///< For kSetNucPolicy.
  PublishPolicy publish_policy = PublishPolicy::kLive;  ///< For kSetPublishPolicy.
  double hold_s = 0.0;                                  ///< For kHoldNuc; 0 ends a hold.
  std::string text{};                                   ///< For kMark; at most kMaxMarkBytes.
};

/// Says what became of a command. What is kRefused was not done; what is kFailed was tried, and may
/// still be done where a camera only did not answer.
enum class CommandOutcome : std::uint8_t { kDone = 0, kRefused = 1, kFailed = 2 };

/// Answers the command of the same number.
struct CommandResult {
  std::uint64_t number = 0;
  CommandOutcome outcome = CommandOutcome::kDone;
  std::string text{};  ///< Why it was refused or failed, or what will be done.
};

/// Frame numbers first..last, both included.
struct FrameRange {
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  friend bool operator==(const FrameRange&, const FrameRange&) = default;
};

/// Holds what the ground has of one stream. received + missing = next (with `missing` the sum of
/// all holes).
struct StreamReceipt {
  std::uint64_t next = 0;  ///< One above the highest number received.
  std::uint64_t handled =
      0;  ///< All numbers below are delivered or given up by the reorder window.
  std::uint64_t received = 0;       ///< Distinct frames.
  std::vector<FrameRange> holes{};  ///< Newest kMaxHoles ranges that are missing, ascending.
};

/// Frames that are in `range`.
inline std::uint64_t SizeOf(const FrameRange& range) { return range.last - range.first + 1; }

/// A frame that is sent from the recording because the ground lacks it, beside the frames that are
/// being captured. Frame is EncodedDepthFrame or EncodedThermalFrame.
template <typename Frame>
struct Backfilled {
  Frame frame;
};

/// Says what a ground station makes of a session.
enum class SessionVerdict : std::uint8_t {
  kFollowed = 0,
  kOtherRig = 1,  ///< Refused: another process has this name, and it came first.
};

/// Tells the edge what the ground has handled, a few times a second. In a lossless replay the edge
/// publishes no further than receipts allow; live, they only say what got lost.
struct Receipt {
  std::uint64_t session = 0;  ///< 0 = none: the ground follows this rig and waits for it.
  StreamReceipt depth;
  StreamReceipt thermal;
  std::uint64_t clock_ping = 0;  ///< To be echoed in the status; 0 = none.
  SessionVerdict verdict = SessionVerdict::kFollowed;
};

/// Says whether the ground knows where the rig is. kDegraded: not all directions of its motion were
/// observed; the motion before stands in for the others.
enum class TrackingState : std::uint8_t { kWaiting = 0, kTracked = 1, kDegraded = 2, kLost = 3 };
std::string_view ToString(TrackingState state);

/// Tells the operator what to do next.
enum class Advice : std::uint8_t {
  kMoveCloser = 0,
  kMoveFarther = 1,
  kLessOblique = 2,
  kMoreOblique = 3,  ///< The operator is reflected.
  kSlower = 4,
  kHoldForNuc = 5,
  kGoBackToRelocalise = 6,
  kDone = 7,  ///< Enough of the whole surface is measured well.
};
/// In the operator's words.
std::string_view ToString(Advice advice);

/// Parts of a surface by the best conditions under which it was measured; they add up to 1. NaN =
/// no surface yet.
struct CoverageFractions {
  float good = std::numeric_limits<float>::quiet_NaN();
  float acceptable = std::numeric_limits<float>::quiet_NaN();
  float bad = std::numeric_limits<float>::quiet_NaN();
  float never_measured = std::numeric_limits<float>::quiet_NaN();
};

/// Holds the duration of one stage of the reconstruction: median and 99th percentile.
struct StageLatency {
  std::string stage{};
  float p50_s = 0.0F;
  float p99_s = 0.0F;
};

/// Holds what the ground thinks of the scan, for the operator or the vehicle. Only the newest
/// counts.
struct Feedback {
  std::uint64_t session = 0;
  std::uint64_t frame_number = 0;  ///< The depth frame that this is about.
  CaptureTime
      capture_time{};  ///< Capture time of that frame, by which the edge knows the feedback's age.
  TrackingState tracking_state = TrackingState::kWaiting;
  std::optional<RigidTransform>
      T_world_depth;             ///< Absent while lost, and in a sub-map that is not joined.
  double covered_area_m2 = 0.0;  ///< Surface in the model.
  CoverageFractions model;       ///< The whole surface.
  CoverageFractions view;        ///< The surface in view.
  std::vector<Advice> advice{};  ///< Most urgent first; at most kMaxAdvice.
  /// The pose to go to next; while lost, the one where tracking last worked.
  std::optional<RigidTransform> T_world_depth_next;
  std::vector<std::uint8_t>
      image;  ///< Confidence image, PNG or JPEG; at most kMaxConfidenceImageBytes.
  std::vector<StageLatency> latencies{};  ///< Optional; at most kMaxStageLatencies.
  /// The covariance of T_world_depth relative to the model, along the axes of `world`; present if
  /// the pose is.
  std::optional<PoseCovariance> pose_covariance;
  std::string advice_reason{};  ///< Why, or what to do, with numbers; at most kMaxTextBytes.
  bool done = false;            ///< Enough of the whole surface is measured well.
  /// The next pose as seen from the depth camera now; absent while lost.
  std::optional<RigidTransform> T_depth_next;
  double next_gain_m2 = 0.0;  ///< Surface that the next view would measure well for the first time.
  /// Thermal frames of this scan that the ground left out to keep up. Its recording has them.
  std::uint32_t frames_left_out = 0;
  std::string link{};  ///< How the link is, in words; at most kMaxTextBytes.
};

}  // namespace isotherm
