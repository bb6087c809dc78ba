#include "edge/camera_process/camera_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/base/log.h"
#include "edge/camera_process/camera_link.pb.h"
#include "edge/camera_process/camera_process_descriptors.h"

extern char** environ;

namespace isotherm {
namespace {

// A camera that is let go properly is there for whoever opens it next.
constexpr Nanoseconds kTimeToLeave = std::chrono::seconds(1);
// A process that is killed is gone in milliseconds, unless the kernel waits for its device.
constexpr Nanoseconds kTimeToDie = std::chrono::milliseconds(250);
// Some minutes of frames. A process that claims to have lost more is not believed.
constexpr std::uint64_t kMaxMissing = 100'000;

/// Starts `program` with the link as descriptor 3, the pixels as 4 and nothing else open.
Result<pid_t> Spawn(const std::string& program, const std::vector<std::string>& arguments, int link,
                    int pixels) {
  std::vector<std::string> words{program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  // By way of numbers that neither has: one may already have the other's.
  const int spare = std::max({link, pixels, kCameraPixelsDescriptor}) + 1;
  posix_spawn_file_actions_adddup2(&actions, link, spare);
  posix_spawn_file_actions_adddup2(&actions, pixels, spare + 1);
  posix_spawn_file_actions_adddup2(&actions, spare, kCameraLinkDescriptor);
  posix_spawn_file_actions_adddup2(&actions, spare + 1, kCameraPixelsDescriptor);
  // It inherits neither sockets nor files of the edge.
  posix_spawn_file_actions_addclosefrom_np(&actions, kCameraPixelsDescriptor + 1);
  pid_t pid = -1;
  const int error =
      ::posix_spawn(&pid, program.c_str(), &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    return Err(Unavailable(fmt::format("{} cannot be started: {}", program, std::strerror(error))));
  }
  return pid;
}

/// False: `patience` was not enough.
bool WaitForEnd(int process, Nanoseconds patience) {
  pollfd wait{process, POLLIN, 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  return process >= 0 && ::poll(&wait, 1, static_cast<int>(ms)) > 0;
}

std::string EndText(std::optional<int> status) {
  if (!status) return "its process does not end although it was killed";
  const int wait_status = *status;
  if (WIFSIGNALED(wait_status)) {
    return fmt::format("its process was ended by signal {} ({})", WTERMSIG(wait_status),
                       strsignal(WTERMSIG(wait_status)));
  }
  return fmt::format("its process left with exit status {}", WEXITSTATUS(wait_status));
}

}  // namespace

CameraProcess::CameraProcess(Settings settings, const Clock& clock)
    : settings_(std::move(settings)), clock_(clock) {}

CameraProcess::~CameraProcess() { Close(); }

Status CameraProcess::Open() {
  Close();
  ISOTHERM_RETURN_IF_ERROR(CheckLeftBehind());
  ISOTHERM_RETURN_IF_ERROR(Start());
  const Status opened = WaitUntilOpened();
  if (!opened.ok()) Close();
  return opened;
}

Status CameraProcess::Start() {
  Result<PixelSlots> slots = PixelSlots::Create();
  if (!slots) return slots.error();
  slots_.emplace(std::move(*slots));
  int ends[2];
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
    return ResourceExhausted(fmt::format("no socket for a camera: {}", std::strerror(errno)));
  }
  link_ = std::make_unique<CameraLink>(ends[0]);
  const CameraLink other_end(ends[1]);  // Closed here at the end: then only the process has it.
  const Result<pid_t> pid =
      Spawn(settings_.program, settings_.arguments, ends[1], slots_->descriptor());
  if (!pid) return pid.error();
  pid_ = *pid;
  first_number_ = next_number_;
  left_out_counted_ = {};
  last_heard_ = clock_.SteadyNow();
  return OkStatus();
}

Status CameraProcess::WaitUntilOpened() {
  while (clock_.SteadyNow() - last_heard_ < settings_.open_timeout) {
    FromCamera message;
    const CameraLink::Received received = link_->Receive(&message, kReadWait);
    if (received == CameraLink::Received::kClosed) return Ended();
    if (settings_.stop.stop_requested()) break;
    if (received == CameraLink::Received::kNothingYet) continue;
    if (message.has_failed()) return FailureFromLink(message.failed());
    if (!message.has_opened()) continue;
    Result<std::vector<CameraDescription>> cameras = CamerasOf(message.opened());
    if (!cameras) return cameras.error();
    rig_ = RigOf(message.opened());
    cameras_ = std::move(*cameras);
    if (message.opened().has_sandbox()) NoteSandbox(FromLink(message.opened().sandbox()));
    last_heard_ = clock_.SteadyNow();
    return OkStatus();
  }
  // A library in the middle of opening does not see that nobody waits for it any more.
  Reap(Nanoseconds(0));
  if (settings_.stop.stop_requested())
    return Unavailable("told to stop while its library opened it");
  return Unavailable(fmt::format("its library did not open it within {:.1f} s and was killed",
                                 ToSeconds(settings_.open_timeout)));
}

void CameraProcess::NoteSandbox(const Status& sandbox) {
  for (CameraDescription& camera : cameras_) {
    camera.settings += sandbox.ok() ? ", confined" : ", not confined";
  }
  if (sandbox.ok()) {
    LOG(Source, Info) << settings_.name << ": its process " << pid_
                      << " is confined to its camera, without a network";
  } else {
    LOG(Source, Warning) << settings_.name << ": its process " << pid_
                         << " is not confined to its camera: " << sandbox.message();
  }
}

Result<SourceItem> CameraProcess::Read(std::stop_token stop) {
  if (stop.stop_requested()) return NothingYet{};
  FromCamera message;
  const CameraLink::Received received = link_->Receive(&message, kReadWait);
  if (received == CameraLink::Received::kClosed) return Err(Ended());
  if (received == CameraLink::Received::kMessage) {
    last_heard_ = clock_.SteadyNow();
    return Take(message);
  }
  // The process reports even without frames; silence means that its library hangs.
  if (clock_.SteadyNow() - last_heard_ < settings_.hang_timeout) return NothingYet{};
  Reap(Nanoseconds(0));
  return Err(Unavailable(fmt::format("its library hung for {:.1f} s and was killed",
                                     ToSeconds(settings_.hang_timeout))));
}

Result<SourceItem> CameraProcess::Take(const FromCamera& message) {
  if (message.has_failed()) return Err(FailureFromLink(message.failed()));
  if (message.has_answer()) TakeAnswer(FromLink(message.answer()));
  if (message.has_ended()) return EndOfStream{};
  if (!message.has_frame()) return NothingYet{};
  Result<RawFrame> frame = FromLink(message.frame(), *slots_);
  if (!frame) return Err(frame.error());
  ToCamera answer;
  answer.set_free_slot(message.frame().slot());
  link_->Send(answer);  // A process that does not take it is found out by its silence.
  const std::uint64_t number = frame->frame_number + first_number_;
  if (number < next_number_ || number - next_number_ > kMaxMissing) {
    return Err(DataLoss(fmt::format("its process sent frame {} behind frame {}",
                                    frame->frame_number, next_number_ - first_number_)));
  }
  frame->frame_number = number;
  next_number_ = number + 1;
  return std::move(*frame);
}

void CameraProcess::TakeAnswer(const Status& status) {
  if (open_orders_.empty()) return;
  answers_.push_back({open_orders_.front(), status});
  open_orders_.pop_front();
}

Status CameraProcess::Ended() {
  // It closed the link, or is garbled: give it a moment to be gone.
  return Unavailable(EndText(Reap(kTimeToLeave)));
}

std::optional<int> CameraProcess::Reap(Nanoseconds patience) {
  if (pid_ < 0) return 0;
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  if (!WaitForEnd(process, patience)) {
    ::kill(pid_, SIGKILL);
    WaitForEnd(process, kTimeToDie);
  }
  if (process >= 0) ::close(process);
  const pid_t pid = std::exchange(pid_, -1);
  int status = 0;
  if (::waitpid(pid, &status, WNOHANG) != 0) return status;
  left_behind_ = pid;
  LOG(Source, Error) << settings_.name << ": process " << pid
                     << " does not end although it was killed: the kernel waits for the device. "
                        "It is left behind; unplug the camera if it does not come back";
  return std::nullopt;
}

Status CameraProcess::CheckLeftBehind() {
  if (left_behind_ < 0 || ::waitpid(left_behind_, nullptr, WNOHANG) != 0) {
    left_behind_ = -1;
    return OkStatus();
  }
  return Unavailable(
      fmt::format("its earlier process {} was killed and has not ended: the kernel still waits "
                  "for the device; unplug the camera",
                  left_behind_));
}

void CameraProcess::CountLeftOut() {
  if (!slots_) return;
  for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
    const auto index = static_cast<std::size_t>(sensor);
    const std::uint64_t now = slots_->left_out(sensor);
    const std::uint64_t before = std::exchange(left_out_counted_[index], now);
    if (now > before) left_out_[index] += std::min(now - before, kMaxMissing);
  }
}

std::array<std::uint64_t, 2> CameraProcess::TakeLeftOut() {
  CountLeftOut();
  return std::exchange(left_out_, {});
}

void CameraProcess::Close() {
  // First: what it captures after it was told to leave is nobody's loss.
  CountLeftOut();
  link_.reset();  // The process leaves when it sees it.
  Reap(kTimeToLeave);
  slots_.reset();
  while (!open_orders_.empty()) TakeAnswer(Unavailable("the camera was closed before it answered"));
}

std::optional<Status> CameraProcess::Control(const CameraControl& control) {
  if (!link_) return Unavailable("the camera is closed");
  ToCamera order;
  if (std::holds_alternative<TriggerNuc>(control)) {
    order.set_trigger_nuc(true);
  } else if (const auto* automatic = std::get_if<SetAutomaticNuc>(&control)) {
    order.set_automatic_nuc(automatic->on);
  } else {
    // SupervisedSource closes and opens it instead, which starts another process.
    return FailedPrecondition("the camera's process takes no such order");
  }
  if (!link_->Send(order)) return Unavailable("the camera's process does not listen");
  open_orders_.push_back(control);
  return std::nullopt;
}

}  // namespace isotherm
