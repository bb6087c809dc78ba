// A point cloud of somebody else.
#include "ground/evaluation/ply_reader.h"
#include "tests/fuzz/memory_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const isotherm::MemoryFile memory({data, size});
  static_cast<void>(isotherm::ReadPly(memory.path()));
  return 0;
}
