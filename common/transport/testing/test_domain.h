#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <string>

#include "common/base/check.h"

namespace isotherm {

/// A DDS domain that no other test process on this computer uses while this object lives. For tests
/// only.
class TestDomain {
 public:
  TestDomain() {
    constexpr int kFirst = 20;  // Low ones are for people.
    // The ports of domains above 101 are those that Linux hands to other sockets (from 32768 on).
    constexpr int kCount = 80;
    for (int i = 0; i < kCount; ++i) {
      number_ = kFirst + (static_cast<int>(getpid()) + i) % kCount;
      if (Take("isotherm-test-domain-" + std::to_string(number_))) return;
    }
    CHECK(false && "no free DDS domain");
  }
  ~TestDomain() { close(lock_); }
  TestDomain(const TestDomain&) = delete;
  TestDomain& operator=(const TestDomain&) = delete;

  int number() const { return number_; }

 private:
  /// A name of a socket that is no file: gone with the process that has it, however that ends.
  bool Take(const std::string& name) {
    lock_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    CHECK(lock_ >= 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path + 1, name.data(), name.size());
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    if (bind(lock_, reinterpret_cast<const sockaddr*>(&address), size) == 0) return true;
    close(lock_);
    return false;
  }

  int number_ = 0;
  int lock_ = -1;
};

}  // namespace isotherm
