#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/time/clock.h"
#include "edge/camera_process/camera_link.h"
#include "edge/camera_process/camera_sandbox.h"
#include "edge/camera_process/pixel_slots.h"
#include "edge/source/frame_source.h"

namespace isotherm {

/// A camera whose library runs in a process of its own: if it crashes or hangs, only that process
/// is lost, and Read fails so that it is started anew.
///
///   this process                                          camera's process
///   CameraProcess <- frames, failures, signs of life ---- ServeCamera <- FrameSource of the camera
///                 -- free slots, orders ----------------->
///                 <= pixels in shared memory =============
///
/// Frames that find no free slot are left out and counted; their numbers are missing. Reopening
/// goes on behind the last number. The process ends with this one, however that ends. One that
/// cannot be ended, because the kernel waits for the device, is left behind: nothing here waits for
/// it, and no other is started until it is gone. Thread-bound.
class CameraProcess final : public FrameSource {
 public:
  /// Says which program is started and how long it may be silent.
  struct Settings {
    std::string name;  ///< For messages.
    std::string program;
    std::vector<std::string> arguments;  ///< With these `program` calls ServeCamera.
    /// Without a sign of life for this long the process is killed.
    Nanoseconds hang_timeout = std::chrono::seconds(2);
    /// Libraries load firmware when they open a camera.
    Nanoseconds open_timeout = std::chrono::seconds(15);
    std::stop_token stop = {};  ///< Ends an opening early.
  };

  /// `clock` must outlive it.
  CameraProcess(Settings settings, const Clock& clock);
  ~CameraProcess() override;

  std::string_view name() const override { return settings_.name; }
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override;
  std::array<std::uint64_t, 2> TakeLeftOut() override;
  /// Refuses to restart: closing and opening it starts another process. Other orders are answered
  /// by the camera, or by the end of its process.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<ControlAnswer> TakeControlAnswers() override { return std::exchange(answers_, {}); }
  std::optional<Rig> rig() const override { return rig_; }
  std::vector<CameraDescription> cameras() const override { return cameras_; }

  /// The process that runs now; -1: none.
  pid_t pid() const { return pid_; }

 private:
  Status Start();
  Status WaitUntilOpened();
  /// Logs whether the process is confined, and adds it to its cameras' settings.
  void NoteSandbox(const Status& sandbox);
  Result<SourceItem> Take(const FromCamera& message);
  void TakeAnswer(const Status& status);
  /// Returns why nothing more comes.
  Status Ended();
  /// Waits for the end of the process, at most this long, and kills it then. Its wait status;
  /// nullopt if it does not end even so.
  std::optional<int> Reap(Nanoseconds patience);
  /// Fails while a process that could not be ended is still there.
  Status CheckLeftBehind();
  void CountLeftOut();

  const Settings settings_;
  const Clock& clock_;
  pid_t pid_ = -1;
  pid_t left_behind_ = -1;  ///< Killed and not gone; -1: none.
  std::unique_ptr<CameraLink> link_;
  std::optional<PixelSlots> slots_;
  std::optional<Rig> rig_;
  std::vector<CameraDescription> cameras_;
  std::deque<CameraControl> open_orders_;  ///< Given and not answered, oldest first.
  std::vector<ControlAnswer> answers_;
  std::array<std::uint64_t, 2> left_out_counted_{};  ///< Counts of the process that runs now.
  std::array<std::uint64_t, 2> left_out_{};          ///< And not taken yet.
  SteadyTime last_heard_{};
  std::uint64_t first_number_ = 0;  ///< Number of this process's first frame.
  std::uint64_t next_number_ = 0;
};

/// Says how a camera's process serves it.
struct ServeSettings {
  std::optional<CameraSandbox> sandbox = std::nullopt;  ///< Absent: not confined.
  /// The source waits until there is room for its next frame; otherwise that is left out.
  bool waits = false;
};

/// The camera's side, in a program started by CameraProcess: confines itself, opens the source and
/// hands its frames over until it fails, ends, or the other side is gone. A sandbox that cannot be
/// had is no failure; the other side says so. The exit status.
int ServeCamera(FrameSource& source, const Clock& clock, const ServeSettings& settings = {});

}  // namespace isotherm
