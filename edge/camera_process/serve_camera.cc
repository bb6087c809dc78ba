// The camera's side of CameraProcess.

#include <signal.h>
#include <sys/prctl.h>

#include <algorithm>
#include <bitset>
#include <optional>
#include <utility>

#include "common/base/log.h"
#include "edge/camera_process/camera_link.pb.h"
#include "edge/camera_process/camera_process.h"
#include "edge/camera_process/camera_process_descriptors.h"

namespace isotherm {
namespace {

// The other side gives up after twenty that did not come (CameraProcess::Settings::hang_timeout).
constexpr Nanoseconds kSignOfLifeInterval = std::chrono::milliseconds(100);
constexpr Nanoseconds kNoWait{0};

class CameraServer {
 public:
  CameraServer(FrameSource& source, const Clock& clock, PixelSlots slots, bool waits,
               std::optional<Status> sandbox)
      : source_(source),
        clock_(clock),
        slots_(std::move(slots)),
        waits_(waits),
        sandbox_(std::move(sandbox)),
        link_(kCameraLinkDescriptor) {
    free_.set();
  }

  void Run() {
    if (const Status opened = source_.Open(); !opened.ok()) return Fail(opened);
    FromCamera message;
    ToLink(source_.rig(), source_.cameras(), message.mutable_opened());
    if (sandbox_) ToLink(*sandbox_, message.mutable_opened()->mutable_sandbox());
    last_sent_ = clock_.SteadyNow();
    if (!link_.Send(message)) return;
    while (Listen(kNoWait)) {
      Result<SourceItem> item = source_.Read({});
      if (!item) return Fail(item.error());
      if (const auto* frame = std::get_if<RawFrame>(&*item)) HandOver(*frame);
      if (std::holds_alternative<EndOfStream>(*item)) return End();
      for (const ControlAnswer& late : source_.TakeControlAnswers()) Answer(late.status);
      ShowLife();
    }
  }

 private:
  void Fail(const Status& status) {
    FromCamera message;
    ToLink(status, message.mutable_failed());
    link_.Send(message);
  }

  void End() {
    FromCamera message;
    message.set_ended(true);
    link_.Send(message);
    // Not before the other side has gone: it may still copy pixels out of the slots.
    while (Listen(kSignOfLifeInterval)) ShowLife();
  }

  void HandOver(const RawFrame& frame) {
    while (waits_ && free_.none()) {
      if (!Listen(kSignOfLifeInterval)) return;
      ShowLife();
    }
    // Nobody reads: the frame is left out and its number with it.
    if (free_.none() || frame.pixels.size() > PixelSlots::kPixelsPerSlot) {
      return slots_.CountLeftOut(frame.sensor);
    }
    int slot = 0;
    while (!free_.test(static_cast<std::size_t>(slot))) ++slot;
    const std::span<const std::uint16_t> pixels = frame.pixels.pixels();
    std::copy(pixels.begin(), pixels.end(), slots_.slot(slot).begin());
    FromCamera message;
    ToLink(frame, message.mutable_frame());
    message.mutable_frame()->set_slot(slot);
    if (!link_.Send(message)) return slots_.CountLeftOut(frame.sensor);
    free_.reset(static_cast<std::size_t>(slot));
    last_sent_ = clock_.SteadyNow();
  }

  void ShowLife() {
    const SteadyTime now = clock_.SteadyNow();
    if (now - last_sent_ < kSignOfLifeInterval) return;
    last_sent_ = now;
    FromCamera message;
    message.set_alive(true);
    link_.Send(message);
  }

  /// Takes what the other side has sent; false if it is gone.
  bool Listen(Nanoseconds wait) {
    while (true) {
      ToCamera message;
      const CameraLink::Received received = link_.Receive(&message, wait);
      if (received == CameraLink::Received::kClosed) return false;
      if (received == CameraLink::Received::kNothingYet) return true;
      Execute(message);
    }
  }

  void Execute(const ToCamera& message) {
    // The link's other end is checked as this one is.
    if (message.has_free_slot() && message.free_slot() >= 0 &&
        message.free_slot() < PixelSlots::kSlots) {
      free_.set(static_cast<std::size_t>(message.free_slot()));
    }
    if (message.has_trigger_nuc()) Order(TriggerNuc{});
    if (message.has_automatic_nuc()) Order(SetAutomaticNuc{message.automatic_nuc()});
  }

  void Order(const CameraControl& control) {
    if (const std::optional<Status> answer = source_.Control(control)) Answer(*answer);
  }

  void Answer(const Status& status) {
    FromCamera message;
    ToLink(status, message.mutable_answer());
    link_.Send(message);
  }

  FrameSource& source_;
  const Clock& clock_;
  const PixelSlots slots_;
  const bool waits_;
  const std::optional<Status> sandbox_;  ///< How confining went; absent: not asked for.
  CameraLink link_;
  std::bitset<PixelSlots::kSlots> free_;
  SteadyTime last_sent_{};
};

}  // namespace

int ServeCamera(FrameSource& source, const Clock& clock, const ServeSettings& settings) {
  // A terminal's Ctrl-C and the service manager's request are for the edge; it ends us.
  ::signal(SIGINT, SIG_IGN);
  ::signal(SIGTERM, SIG_IGN);
  // A camera's process must not outlive an edge that crashed: it holds the device.
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  Result<PixelSlots> slots = PixelSlots::Attach(kCameraPixelsDescriptor);
  if (!slots) {
    LOG(Source, Error) << slots.error().message();
    return ExitCode(slots.error());
  }
  std::optional<Status> confined;
  // After the memory is mapped, before the camera is opened.
  if (settings.sandbox) confined = EnterSandbox(*settings.sandbox);
  CameraServer(source, clock, std::move(*slots), settings.waits, std::move(confined)).Run();
  source.Close();
  return 0;
}

}  // namespace isotherm
