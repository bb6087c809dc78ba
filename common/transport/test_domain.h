#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <string>

#include "common/base/check.h"

namespace isotherm {

/// A DDS domain that no other test process on this computer uses while this object lives. For tests
/// only.
class TestDomain {
 public:
  TestDomain() {
    constexpr int kFirst = 20;  // Low ones are for people.
    constexpr int kCount = 200;
    for (int i = 0; i < kCount; ++i) {
      number_ = kFirst + (static_cast<int>(getpid()) + i) % kCount;
      const std::string path = "/tmp/isotherm-test-domain-" + std::to_string(number_);
      lock_ = open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
      if (lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0) return;
      if (lock_ >= 0) close(lock_);
    }
    CHECK(false && "no free DDS domain");
  }
  ~TestDomain() { close(lock_); }
  TestDomain(const TestDomain&) = delete;
  TestDomain& operator=(const TestDomain&) = delete;

  int number() const { return number_; }

 private:
  int number_ = 0;
  int lock_ = -1;
};

}  // namespace isotherm
