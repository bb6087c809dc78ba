#include "edge/camera_process/pixel_slots.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

constexpr std::size_t kPixelBytes =
    PixelSlots::kSlots * PixelSlots::kPixelsPerSlot * sizeof(std::uint16_t);
// A page of its own.
constexpr std::size_t kCounterBytes = 4096;
constexpr std::size_t kBytes = kPixelBytes + kCounterBytes;

}  // namespace

Result<PixelSlots> PixelSlots::Create() {
  const int descriptor = ::memfd_create("isotherm-pixels", MFD_CLOEXEC | MFD_ALLOW_SEALING);
  // Sealed: a process that reads memory which the other side took away is ended by a signal.
  if (descriptor < 0 || ::ftruncate(descriptor, static_cast<off_t>(kBytes)) != 0 ||
      ::fcntl(descriptor, F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) != 0) {
    const int error = errno;
    if (descriptor >= 0) ::close(descriptor);
    return Err(ResourceExhausted(
        fmt::format("no shared memory for a camera's frames: {}", std::strerror(error))));
  }
  return Attach(descriptor);
}

Result<PixelSlots> PixelSlots::Attach(int descriptor) {
  PixelSlots slots;
  slots.descriptor_ = descriptor;
  void* memory =
      ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_NORESERVE, descriptor, 0);
  if (memory == MAP_FAILED) {
    return Err(ResourceExhausted(
        fmt::format("the shared memory cannot be mapped: {}", std::strerror(errno))));
  }
  slots.pixels_ = static_cast<std::uint16_t*>(memory);
  static_assert(sizeof(Counters) <= kCounterBytes);
  slots.counters_ = reinterpret_cast<Counters*>(static_cast<unsigned char*>(memory) + kPixelBytes);
  return slots;
}

PixelSlots::PixelSlots(PixelSlots&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      pixels_(std::exchange(other.pixels_, nullptr)),
      counters_(std::exchange(other.counters_, nullptr)) {}

PixelSlots& PixelSlots::operator=(PixelSlots&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(pixels_, other.pixels_);
  std::swap(counters_, other.counters_);
  return *this;
}

PixelSlots::~PixelSlots() {
  if (pixels_ != nullptr) ::munmap(pixels_, kBytes);
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::span<std::uint16_t> PixelSlots::slot(int index) const {
  CHECK(index >= 0 && index < kSlots);
  return {pixels_ + static_cast<std::size_t>(index) * kPixelsPerSlot, kPixelsPerSlot};
}

}  // namespace isotherm
