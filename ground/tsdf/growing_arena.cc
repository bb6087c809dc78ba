#include "ground/tsdf/growing_arena.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

namespace isotherm {
namespace {

/// Returns the file's descriptor; negative, with errno set, if none can be made in `dir`.
int OpenNamelessFile(const std::filesystem::path& dir) {
  return open(dir.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
}

}  // namespace

GrowingArena::GrowingArena(std::size_t reserve_bytes, const std::filesystem::path& spill_dir)
    : bytes_(reserve_bytes) {
  int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  if (!spill_dir.empty()) {
    file_ = OpenNamelessFile(spill_dir);
    if (file_ < 0 || ftruncate(file_, static_cast<off_t>(bytes_)) != 0) throw std::bad_alloc();
    flags = MAP_SHARED | MAP_NORESERVE;
  }
  void* memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, flags, file_, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  data_ = static_cast<std::byte*>(memory);
  // Kernels look voxels up all over the arena: large pages save most misses of the address cache.
  // Blocks are taken from the beginning, so they waste less than one such page.
  madvise(memory, bytes_, MADV_HUGEPAGE);
}

GrowingArena::~GrowingArena() {
  munmap(data_, bytes_);
  if (file_ >= 0) close(file_);
}

bool GrowingArena::Commit(std::size_t bytes) {
  // The disk's room is reserved in steps, so that a frame that adds a block does not wait for it;
  // at most one step is reserved too much.
  constexpr std::size_t kStep = std::size_t{16} << 20;
  if (file_ < 0 || bytes <= committed_bytes_) return true;
  const std::size_t wanted = std::min(bytes_, (bytes + kStep - 1) / kStep * kStep);
  if (posix_fallocate(file_, static_cast<off_t>(committed_bytes_),
                      static_cast<off_t>(wanted - committed_bytes_)) != 0) {
    return false;
  }
  committed_bytes_ = wanted;
  return true;
}

void GrowingArena::Decommit(std::size_t offset, std::size_t bytes) const {
  if (file_ < 0) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t begin = (offset + page - 1) / page * page;
  const std::size_t end = (offset + bytes) / page * page;
  // Of a shared file mapping this drops the pages from the process only: the file keeps them.
  if (begin < end) madvise(data_ + begin, end - begin, MADV_DONTNEED);
}

void GrowingArena::Fetch(std::size_t offset, std::size_t bytes) const {
  if (file_ < 0) return;
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  const std::size_t begin = offset / page * page;
  const std::size_t end = std::min(bytes_, offset + bytes);
  // Advice: what cannot be read ahead is read when it is touched.
  if (begin < end) madvise(data_ + begin, end - begin, MADV_WILLNEED);
}

Status CheckSpillDir(const std::filesystem::path& spill_dir) {
  if (spill_dir.empty()) return OkStatus();
  const int file = OpenNamelessFile(spill_dir);
  if (file < 0) {
    return IoError(fmt::format("volume.spill_dir: no file can be made in {}: {}",
                               spill_dir.string(), std::strerror(errno)));
  }
  close(file);
  return OkStatus();
}

}  // namespace isotherm
