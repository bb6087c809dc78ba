// Preloaded into a program, lets its disk fail: while the file FAILING_DISK exists, every fdatasync
// fails with the error number that the file holds, as a disk's file system does after an error. If
// FAILING_DISK_FOLDER is set, nothing below that can be opened for writing either, as if the disk
// had been taken away.
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

using Function = int (*)(int);
using Open = int (*)(const char*, int, ...);

/// 0 = the disk works.
int ErrorNow() {
  static const char* const path = std::getenv("FAILING_DISK");
  std::FILE* const file = path == nullptr ? nullptr : std::fopen(path, "r");
  if (file == nullptr) return 0;
  int error = 0;
  if (std::fscanf(file, "%d", &error) != 1) error = EIO;
  std::fclose(file);
  return error;
}

bool IsAway(const char* path, int flags) {
  static const char* const folder = std::getenv("FAILING_DISK_FOLDER");
  return folder != nullptr && (flags & O_ACCMODE) != O_RDONLY &&
         std::string_view(path).substr(0, std::string_view(folder).size()) == folder;
}

}  // namespace

extern "C" int fdatasync(int descriptor) {
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fdatasync"));
  if (const int error = ErrorNow(); error != 0) {
    errno = error;
    return -1;
  }
  return real(descriptor);
}

extern "C" int open(const char* path, int flags, ...) {
  static const auto real = reinterpret_cast<Open>(dlsym(RTLD_NEXT, "open"));
  if (const int error = IsAway(path, flags) ? ErrorNow() : 0; error != 0) {
    errno = error;
    return -1;
  }
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return real(path, flags, mode);
}
// The same function; which name a program calls depends on how it was compiled.
extern "C" int open64(const char* path, int flags, ...) __attribute__((alias("open")));
