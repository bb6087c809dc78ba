#include "edge/source/camera_process.h"

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

#include "common/base/check.h"
#include "edge/source/camera_link.pb.h"
#include "edge/source/camera_process_descriptors.h"

extern char** environ;

namespace isotherm {
namespace {

constexpr Nanoseconds kLongestWait = std::chrono::milliseconds(50);
// A camera that is let go properly is there for whoever opens it next.
constexpr Nanoseconds kTimeToLeave = std::chrono::seconds(1);

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

std::string EndText(int wait_status) {
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
  last_heard_ = clock_.SteadyNow();
  return OkStatus();
}

Status CameraProcess::WaitUntilOpened() {
  while (clock_.SteadyNow() - last_heard_ < settings_.open_timeout) {
    FromCamera message;
    const CameraLink::Received received = link_->Receive(&message, kLongestWait);
    if (received == CameraLink::Received::kClosed) return Ended();
    if (settings_.stop.stop_requested()) break;
    if (received == CameraLink::Received::kNothingYet) continue;
    if (message.has_failed()) return FromLink(message.failed());
    if (!message.has_opened()) continue;
    rig_ = RigOf(message.opened());
    cameras_ = CamerasOf(message.opened());
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

Result<SourceItem> CameraProcess::Read(std::stop_token stop) {
  if (stop.stop_requested()) return NothingYet{};
  FromCamera message;
  const CameraLink::Received received = link_->Receive(&message, kLongestWait);
  if (received == CameraLink::Received::kClosed) return Err(Ended());
  if (received == CameraLink::Received::kMessage) {
    last_heard_ = clock_.SteadyNow();
    return Take(message);
  }
  if (clock_.SteadyNow() - last_heard_ < settings_.hang_timeout) return NothingYet{};
  Reap(Nanoseconds(0));
  return Err(Unavailable(fmt::format("its library hung for {:.1f} s and was killed",
                                     ToSeconds(settings_.hang_timeout))));
}

Result<SourceItem> CameraProcess::Take(const FromCamera& message) {
  if (message.has_failed()) return Err(FromLink(message.failed()));
  if (message.has_answer()) TakeAnswer(FromLink(message.answer()));
  if (message.has_ended()) return EndOfStream{};
  if (!message.has_frame()) return NothingYet{};
  Result<RawFrame> frame = FromLink(message.frame(), *slots_);
  if (!frame) return Err(frame.error());
  ToCamera answer;
  answer.set_free_slot(message.frame().slot());
  link_->Send(answer);  // A process that does not take it is found out by its silence.
  frame->frame_number += first_number_;
  next_number_ = frame->frame_number + 1;
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

int CameraProcess::Reap(Nanoseconds patience) {
  if (pid_ < 0) return 0;
  const int process = static_cast<int>(::syscall(SYS_pidfd_open, pid_, 0));
  pollfd wait{process, POLLIN, 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(patience).count();
  if (process < 0 || ::poll(&wait, 1, static_cast<int>(ms)) <= 0) ::kill(pid_, SIGKILL);
  if (process >= 0) ::close(process);
  int status = 0;
  ::waitpid(std::exchange(pid_, -1), &status, 0);
  return status;
}

void CameraProcess::Close() {
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
    // Whoever supervises it closes and opens it instead, which starts another process.
    return FailedPrecondition("the camera's process takes no such order");
  }
  if (!link_->Send(order)) return Unavailable("the camera's process does not listen");
  open_orders_.push_back(control);
  return std::nullopt;
}

}  // namespace isotherm
