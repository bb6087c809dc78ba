#pragma once

#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/time/time_types.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class FromCamera;
class LinkFrame;
class LinkOpened;
class LinkStatus;
class PixelSlots;
class ToCamera;

/// The socket between the edge and a camera's own process: whole messages, in order. Sending never
/// waits. Owns the descriptor. Thread-compatible.
class CameraLink {
 public:
  explicit CameraLink(int descriptor) : descriptor_(descriptor) {}
  ~CameraLink();
  CameraLink(const CameraLink&) = delete;
  CameraLink& operator=(const CameraLink&) = delete;

  /// Says what came within the timeout. kClosed: the other process has ended, or sent bytes that
  /// are no message.
  enum class Received { kMessage, kNothingYet, kClosed };
  /// Waits at most `timeout`.
  Received Receive(FromCamera* message, Nanoseconds timeout);
  Received Receive(ToCamera* message, Nanoseconds timeout);
  /// False: the other side is gone, or has not read for long.
  bool Send(const FromCamera& message);
  bool Send(const ToCamera& message);

 private:
  template <typename Message>
  Received ReceiveAny(Message* message, Nanoseconds timeout);
  template <typename Message>
  bool SendAny(const Message& message);

  const int descriptor_;
};

void ToLink(const Status& status, LinkStatus* to);
/// kDataLoss: a code that there is not.
Status FromLink(const LinkStatus& from);
/// The same for what says that something failed: never ok.
Status FailureFromLink(const LinkStatus& from);

/// Everything but the pixels.
void ToLink(const RawFrame& frame, LinkFrame* to);
/// Copies the pixels out of their slot. kDataLoss: the message is not what a sound process sends.
Result<RawFrame> FromLink(const LinkFrame& from, const PixelSlots& slots);

void ToLink(const std::optional<Rig>& rig, const std::vector<CameraDescription>& cameras,
            LinkOpened* to);
std::optional<Rig> RigOf(const LinkOpened& from);
/// kDataLoss: as with frames.
Result<std::vector<CameraDescription>> CamerasOf(const LinkOpened& from);

}  // namespace isotherm
