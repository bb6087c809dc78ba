#include "common/base/standard_error.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <utility>

namespace isotherm {
namespace {

// Whoever reads is alive and only a little slow: worth this long at the end of the program.
constexpr int kPatienceAtExit_ms = 200;

bool IsWritable(int descriptor, int patience_ms) {
  pollfd waited{descriptor, POLLOUT, 0};
  return poll(&waited, 1, patience_ms) > 0;
}

/// A second way to the same pipe or terminal. O_NONBLOCK on the descriptor itself would change it
/// for everybody who has it, such as the shell.
int OpenAgain(int descriptor) {
  const std::string path = "/proc/self/fd/" + std::to_string(descriptor);
  return open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

template <int kDescriptor>
UnblockedOutput& Standard() {
  // Never destroyed: threads may log until the very end.
  static UnblockedOutput* const output = [] {
    static_cast<void>(std::atexit([] { Standard<kDescriptor>().Flush(kPatienceAtExit_ms); }));
    return new UnblockedOutput(kDescriptor);
  }();
  return *output;
}

}  // namespace

UnblockedOutput::~UnblockedOutput() {
  if (own_ >= 0) close(own_);
}

void UnblockedOutput::LookAtDescriptor() {
  struct stat info {};
  if (fstat(descriptor_, &info) != 0) return;
  if (device_ == info.st_dev && inode_ == info.st_ino) return;
  device_ = info.st_dev;
  inode_ = info.st_ino;
  if (own_ >= 0) close(std::exchange(own_, -1));
  kind_ = Kind::kDirect;
  if (S_ISSOCK(info.st_mode)) kind_ = Kind::kSocket;
  if (!S_ISFIFO(info.st_mode) && !S_ISCHR(info.st_mode)) return;
  own_ = OpenAgain(descriptor_);
  kind_ = own_ >= 0 ? Kind::kReopened : Kind::kPolled;
}

std::ptrdiff_t UnblockedOutput::TryWrite(std::string_view text) const {
  while (true) {
    ssize_t taken = -1;
    switch (kind_) {
      case Kind::kDirect:
        taken = write(descriptor_, text.data(), text.size());
        break;
      case Kind::kReopened:
        taken = write(own_, text.data(), text.size());
        break;
      case Kind::kSocket:
        taken = send(descriptor_, text.data(), text.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
        break;
      case Kind::kPolled:
        // A pipe that polls as writable takes this much without waiting.
        if (!IsWritable(descriptor_, 0)) return 0;
        taken = write(descriptor_, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
        break;
    }
    if (taken >= 0) return taken;
    if (errno == EINTR) continue;
    return errno == EAGAIN || errno == EWOULDBLOCK ? 0 : -1;
  }
}

bool UnblockedOutput::Offer() {
  std::size_t done = 0;
  while (done < kept_.size()) {
    const std::ptrdiff_t taken = TryWrite(std::string_view(kept_).substr(done));
    if (taken == 0) break;
    // Nobody will ever read it.
    if (taken < 0) done = kept_.size();
    if (taken > 0) done += static_cast<std::size_t>(taken);
  }
  kept_.erase(0, done);
  return kept_.empty();
}

void UnblockedOutput::Write(std::string_view text) {
  const MutexLock lock(mutex_);
  LookAtDescriptor();
  Offer();
  if (kept_.size() + text.size() > kKeptBytes) {
    ++left_out_;
    return;
  }
  kept_ += text;
  Offer();
}

std::uint64_t UnblockedOutput::TakeLeftOut() {
  const MutexLock lock(mutex_);
  if (left_out_ == 0) return 0;
  return Offer() ? std::exchange(left_out_, 0) : 0;
}

void UnblockedOutput::Flush(int patience_ms) {
  const MutexLock lock(mutex_);
  // Each round either gets rid of something or is the last one.
  while (!Offer()) {
    if (!IsWritable(own_ >= 0 ? own_ : descriptor_, patience_ms)) return;
  }
}

void WriteStandardError(std::string_view text) { Standard<STDERR_FILENO>().Write(text); }

std::uint64_t TakeLeftOutOfStandardError() { return Standard<STDERR_FILENO>().TakeLeftOut(); }

void WriteStandardOutput(std::string_view text) { Standard<STDOUT_FILENO>().Write(text); }

}  // namespace isotherm
