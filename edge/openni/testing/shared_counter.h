#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <filesystem>

namespace isotherm {

/// A number in a file that several processes count in, for tests. Without a file it counts for
/// itself. Thread-safe.
class SharedCounter {
 public:
  explicit SharedCounter(const std::filesystem::path& path) {
    const int file = path.empty() ? -1 : ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file < 0) return;
    void* memory = MAP_FAILED;
    if (::ftruncate(file, sizeof(own_)) == 0) {
      memory = ::mmap(nullptr, sizeof(own_), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    }
    ::close(file);
    if (memory != MAP_FAILED) shared_ = static_cast<std::atomic<std::uint64_t>*>(memory);
  }
  ~SharedCounter() {
    if (shared_ != nullptr) ::munmap(shared_, sizeof(own_));
  }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  void Count() { (shared_ != nullptr ? *shared_ : own_).fetch_add(1); }
  std::uint64_t value() const { return (shared_ != nullptr ? *shared_ : own_).load(); }

 private:
  std::atomic<std::uint64_t> own_{0};
  std::atomic<std::uint64_t>* shared_ = nullptr;
};

}  // namespace isotherm
