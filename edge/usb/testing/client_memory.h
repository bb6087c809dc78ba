#pragma once

#include <sys/types.h>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace isotherm {

/// Memory of the process that uses an emulated device. Reads of memory that is not there return
/// zeros, writes there are lost: the process has ended.
class ClientMemory {
 public:
  explicit ClientMemory(pid_t process) : process_(process) {}

  std::vector<std::uint8_t> Read(std::uintptr_t address, std::size_t size) const;
  void Write(std::uintptr_t address, const void* bytes, std::size_t size) const;

  template <typename T>
  T Get(std::uintptr_t address) const {
    const std::vector<std::uint8_t> bytes = Read(address, sizeof(T));
    T value;
    __builtin_memcpy(&value, bytes.data(), sizeof(T));
    return value;
  }
  template <typename T>
  void Put(std::uintptr_t address, const T& value) const {
    Write(address, &value, sizeof(T));
  }

 private:
  pid_t process_;
};

}  // namespace isotherm
