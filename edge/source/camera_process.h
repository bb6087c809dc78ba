#pragma once

#include <sys/types.h>

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/time/clock.h"
#include "edge/source/camera_link.h"
#include "edge/source/frame_source.h"
#include "edge/source/pixel_slots.h"

namespace isotherm {

/// A camera whose library runs in a process of its own: if it crashes or hangs, only that process
/// is lost, and Read fails so that it is started anew.
///
///   this process                                          camera's process
///   CameraProcess <- frames, failures, signs of life ---- ServeCamera <- FrameSource of the camera
///                 -- free slots, orders ----------------->
///                 <= pixels in shared memory =============
///
/// Frames that find no free slot are left out; their numbers are missing. Reopening goes on behind
/// the last number. The process ends with this one, however that ends. Thread-bound.
class CameraProcess final : public FrameSource {
 public:
  struct Settings {
    std::string name;  ///< For messages.
    std::string program;
    std::vector<std::string> arguments;  ///< That make `program` call ServeCamera.
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
  /// Refuses to restart: closing and opening it starts another process. Other orders are answered
  /// by the camera, or by the end of its process.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<ControlAnswer> TakeControlAnswers() override { return std::exchange(answers_, {}); }
  std::optional<Rig> rig() const override { return rig_; }
  std::vector<CameraDescription> cameras() const override { return cameras_; }

  /// Of the process now; -1: none.
  pid_t pid() const { return pid_; }

 private:
  Status Start();
  Status WaitUntilOpened();
  Result<SourceItem> Take(const FromCamera& message);
  void TakeAnswer(const Status& status);
  /// Why nothing more comes.
  Status Ended();
  /// Waits for the end of the process, at most so long; kills it then. Its wait status.
  int Reap(Nanoseconds patience);

  const Settings settings_;
  const Clock& clock_;
  pid_t pid_ = -1;
  std::unique_ptr<CameraLink> link_;
  std::optional<PixelSlots> slots_;
  std::optional<Rig> rig_;
  std::vector<CameraDescription> cameras_;
  std::deque<CameraControl> open_orders_;  ///< Given and not answered, oldest first.
  std::vector<ControlAnswer> answers_;
  SteadyTime last_heard_{};
  std::uint64_t first_number_ = 0;  ///< Of this process's frames.
  std::uint64_t next_number_ = 0;
};

/// The camera's side, in a program started by CameraProcess: opens the source and hands its frames
/// over until it fails, ends, or the other side is gone. The exit status.
int ServeCamera(FrameSource& source, const Clock& clock);

}  // namespace isotherm
