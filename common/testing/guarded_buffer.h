#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace isotherm::testing {

/// A copy of some bytes that ends where readable memory ends: whoever reads or writes one byte
/// beyond them is ended by a signal, also in a program without a sanitizer. Thread-compatible.
class GuardedBuffer {
 public:
  explicit GuardedBuffer(std::span<const std::uint8_t> bytes);
  explicit GuardedBuffer(std::string_view text);
  ~GuardedBuffer();
  GuardedBuffer(const GuardedBuffer&) = delete;
  GuardedBuffer& operator=(const GuardedBuffer&) = delete;

  std::span<std::uint8_t> bytes() const { return {data_, size_}; }
  std::string_view text() const { return {reinterpret_cast<const char*>(data_), size_}; }

 private:
  std::uint8_t* memory_ = nullptr;
  std::size_t mapped_bytes_ = 0;
  std::uint8_t* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace isotherm::testing
