#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "common/base/check.h"
#include "common/testing/sanitizers.h"
#include "common/transport/participant.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// Holds what a test edge sends: raw images of the sizes of a real rig, filled with noise that
/// depends on the number.
struct EdgePlan {
  int domain = 0;
  std::uint64_t session = 1;
  std::uint64_t depth_frames = 0;
  std::uint64_t thermal_frames = 0;
  double depth_hz = 0.0;  ///< 0 = as fast as possible; thermal keeps the ratio of the counts.
  PublishPolicy policy = PublishPolicy::kLossless;
  Nanoseconds wait_for_ground = Nanoseconds(0);
};

inline constexpr std::chrono::seconds kLinkPatience{60};  // Far above anything measured.

/// One byte in this many of a payload is a mark that depends on the frame; the others are the same
/// in all frames, so that making them costs little.
inline constexpr std::size_t kMarkEvery = 1001;

inline std::uint8_t Mark(std::uint64_t number, std::size_t index) {
  return static_cast<std::uint8_t>((number * 0x9E3779B97F4A7C15ULL + index * 0x2545F491ULL) >> 17U);
}

/// The thread sanitizer looks at each byte that is copied: images a quarter as wide and high are
/// enough for it.
inline constexpr int kShrink = testing::kThreadSanitizer ? 4 : 1;

template <typename Frame>
Frame MakeFrame(std::uint64_t session, std::uint64_t number, int width, int height) {
  Frame frame;
  frame.header.session = session;
  frame.header.frame_number = number;
  frame.header.capture_time = CaptureTimeFromNanoseconds(static_cast<std::int64_t>(number) * 1000);
  frame.image.width = width;
  frame.image.height = height;
  frame.image.payload.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 2,
                             0x5A);
  for (std::size_t i = 0; i < frame.image.payload.size(); i += kMarkEvery) {
    frame.image.payload[i] = Mark(number, i);
  }
  return frame;
}

/// An edge without cameras: participant, publisher and its receive thread.
class EdgeSide {
 public:
  EdgeSide(const TransportEnvironment& environment, const Clock& clock, const EdgePlan& plan,
           const PublisherHandlers& handlers = {})
      : plan_(plan) {
    participant_ = std::move(*Participant::Create(environment, plan.domain));
    PublisherOptions options;
    options.edge_id = "test-edge";
    options.policy = plan.policy;
    // What is sent is compared with what arrives, and nothing of pieces is sent again.
    options.pieces = false;
    publisher_ = std::move(*Publisher::Create(*participant_, clock, options));
    receiver_ = std::jthread(
        [this, handlers](const std::stop_token& stop) { publisher_->Run(stop, handlers); });
  }

  Publisher& publisher() { return *publisher_; }
  const Participant& participant() const { return *participant_; }

  /// Sends the whole plan and says that the session has ended. True if the ground confirmed
  /// everything.
  bool SendAll() {
    if (plan_.wait_for_ground > Nanoseconds(0)) {
      CHECK(publisher_->WaitForGround(plan_.wait_for_ground, {}));
    }
    Begin();
    SendFrames(0, plan_.depth_frames);
    return End();
  }

  void Begin() {
    RigDescription rig;
    rig.session = plan_.session;
    CHECK(publisher_->BeginSession(rig, {}).ok());
    EdgeStatus status;
    status.scan_state = ScanState::kScanning;
    CHECK(publisher_->Publish(status).ok());
  }
  /// Depth frames first..end-1 and the fraction of thermal frames that belongs to them.
  void SendFrames(std::uint64_t first, std::uint64_t end) {
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t i = first; i < end; ++i) {
      if (plan_.depth_hz > 0.0) {
        std::this_thread::sleep_until(start +
                                      FromSeconds(static_cast<double>(i - first) / plan_.depth_hz));
      }
      CHECK(
          publisher_
              ->Publish(
                  MakeFrame<EncodedDepthFrame>(plan_.session, i, 640 / kShrink, 480 / kShrink), {})
              .ok());
      while (thermal_sent_ < plan_.thermal_frames * (i + 1) / plan_.depth_frames) {
        CHECK(publisher_
                  ->Publish(MakeFrame<EncodedThermalFrame>(plan_.session, thermal_sent_++,
                                                           384 / kShrink, 288 / kShrink),
                            {})
                  .ok());
      }
    }
  }
  bool End() {
    // As the daemon does it: first the receive thread ends, then the last word is said.
    receiver_.request_stop();
    receiver_.join();
    EdgeStatus status;
    status.scan_state = ScanState::kEnded;
    CHECK(publisher_->Publish(status).ok());
    return publisher_->Drain(kLinkPatience);
  }

 private:
  const EdgePlan plan_;
  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Publisher> publisher_;
  std::uint64_t thermal_sent_ = 0;
  std::jthread receiver_;
};

}  // namespace isotherm
