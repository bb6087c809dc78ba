#include "common/base/sync_folder.h"

#include <fcntl.h>
#include <unistd.h>

namespace isotherm {

void SyncFolder(const std::filesystem::path& folder) {
  const int descriptor =
      open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  fsync(descriptor);
  close(descriptor);
}

}  // namespace isotherm
