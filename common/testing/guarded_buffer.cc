#include "common/testing/guarded_buffer.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>

#include "common/base/check.h"

namespace isotherm::testing {

GuardedBuffer::GuardedBuffer(std::span<const std::uint8_t> bytes) : size_(bytes.size()) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const std::size_t readable = (size_ + page - 1) / page * page;
  mapped_bytes_ = readable + page;
  void* const memory =
      ::mmap(nullptr, mapped_bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  CHECK(memory != MAP_FAILED);
  memory_ = static_cast<std::uint8_t*>(memory);
  CHECK(::mprotect(memory_ + readable, page, PROT_NONE) == 0);
  data_ = memory_ + readable - size_;
  std::copy(bytes.begin(), bytes.end(), data_);
}

GuardedBuffer::GuardedBuffer(std::string_view text)
    : GuardedBuffer(std::span<const std::uint8_t>(
          reinterpret_cast<const std::uint8_t*>(text.data()), text.size())) {}

GuardedBuffer::~GuardedBuffer() { ::munmap(memory_, mapped_bytes_); }

}  // namespace isotherm::testing
