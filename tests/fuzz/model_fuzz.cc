// The head of a saved model and, if the volume is small, its blocks. Checksums are set right.
#include <zlib.h>

#include <cstring>
#include <vector>

#include "ground/model/load_model.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kSizeAt = 12, kCrcAt = 16, kHead = 20;
  std::vector<std::uint8_t> file(data, data + size);
  std::uint32_t bytes = 0;
  if (size >= kHead) std::memcpy(&bytes, file.data() + kSizeAt, sizeof(bytes));
  if (size >= kHead && bytes <= size - kHead) {
    const auto crc = static_cast<std::uint32_t>(crc32(0, file.data() + kHead, bytes));
    std::memcpy(file.data() + kCrcAt, &crc, sizeof(crc));
  }
  const isotherm::MemoryFile memory(file);
  isotherm::GroundOptions options;
  options.mutable_volume()->mutable_expert()->set_max_memory_bytes(64 << 20);
  static_cast<void>(isotherm::LoadModel(memory.path(), options));
  return 0;
}
