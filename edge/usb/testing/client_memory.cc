#include "edge/usb/testing/client_memory.h"

#include <sys/uio.h>

namespace isotherm {

std::vector<std::uint8_t> ClientMemory::Read(std::uintptr_t address, std::size_t size) const {
  std::vector<std::uint8_t> bytes(size);
  const iovec local{bytes.data(), size};
  const iovec remote{reinterpret_cast<void*>(address), size};
  if (size > 0) static_cast<void>(process_vm_readv(process_, &local, 1, &remote, 1, 0));
  return bytes;
}

void ClientMemory::Write(std::uintptr_t address, const void* bytes, std::size_t size) const {
  const iovec local{const_cast<void*>(bytes), size};
  const iovec remote{reinterpret_cast<void*>(address), size};
  if (size > 0) static_cast<void>(process_vm_writev(process_, &local, 1, &remote, 1, 0));
}

}  // namespace isotherm
