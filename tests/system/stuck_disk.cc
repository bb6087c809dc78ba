// Preloaded into a program, makes its disk stuck: while the file STUCK_DISK_WHILE exists, syncing a
// file whose path contains STUCK_DISK_NAME does not return; or, if that file holds a number, takes
// so many milliseconds. That it happened is seen by the file STUCK_DISK_WHILE.reached.
#include <dlfcn.h>
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>

namespace {

bool IsMeant(int descriptor) {
  static const char* const name = std::getenv("STUCK_DISK_NAME");
  std::array<char, 4096> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = readlink(link.c_str(), path.data(), path.size());
  if (name == nullptr || length <= 0) return false;
  return std::string(path.data(), static_cast<std::size_t>(length)).find(name) != std::string::npos;
}

void WaitWhileStuck(int descriptor) {
  static const char* const file = std::getenv("STUCK_DISK_WHILE");
  if (file == nullptr || access(file, F_OK) != 0 || !IsMeant(descriptor)) return;
  close(open((std::string(file) + ".reached").c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0644));
  long left_ms = std::numeric_limits<long>::max();
  std::ifstream(file) >> left_ms;
  if (left_ms <= 0) left_ms = std::numeric_limits<long>::max();
  constexpr timespec kTick{.tv_sec = 0, .tv_nsec = 10'000'000};
  for (; left_ms > 0 && access(file, F_OK) == 0; left_ms -= 10) nanosleep(&kTick, nullptr);
}

int Sync(const char* function, int descriptor) {
  WaitWhileStuck(descriptor);
  return reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, function))(descriptor);
}

}  // namespace

extern "C" int fsync(int descriptor) { return Sync("fsync", descriptor); }
extern "C" int fdatasync(int descriptor) { return Sync("fdatasync", descriptor); }
