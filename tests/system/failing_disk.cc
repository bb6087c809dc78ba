// Preloaded into a program, lets its disk fail: while the file FAILING_DISK exists, every fdatasync
// fails with the error number that the file holds, as a disk's file system does after an error.
#include <dlfcn.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace {

using Function = int (*)(int);

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

}  // namespace

extern "C" int fdatasync(int descriptor) {
  static const auto real = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "fdatasync"));
  if (const int error = ErrorNow(); error != 0) {
    errno = error;
    return -1;
  }
  return real(descriptor);
}
