#include "edge/spool/recording_files.h"

#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/recording/recording_parts.h"

namespace isotherm {

Result<RecordingFile> RecordingFiles::Next() {
  const bool is_device = IsDevice(description_.path);
  const int part = is_device ? 1 : NextFreePart(description_.path, part_);
  const std::filesystem::path path = PartPath(description_.path, part);
  RecordingOptions options;
  options.flush_interval = description_.flush_interval;
  options.sync = description_.sync;
  options.clock = description_.clock;
  Result<std::unique_ptr<RecordingWriter>> writer = RecordingWriter::Create(path, options);
  if (!writer) return Err(writer.error());
  if (part_ == 0 && part > 1) {
    LOG(Spool, Warning) << description_.path.string()
                        << " exists already and stays as it is; recording beside it";
  }
  part_ = is_device ? 0 : part;
  if (const Status written = WriteBeginning(**writer); !written.ok()) {
    writer->reset();
    std::error_code ignored;
    // A file without a beginning cannot be read.
    if (!is_device) std::filesystem::remove(path, ignored);
    return Err(written);
  }
  return RecordingFile{path, std::move(*writer)};
}

void RecordingFiles::Update(const RigUpdate& update) {
  if (update.rig) description_.rig = update.rig;
  description_.metadata["cameras"] = update.cameras;
}

Status RecordingFiles::WriteBeginning(RecordingWriter& writer) const {
  if (description_.rig) ISOTHERM_RETURN_IF_ERROR(writer.Write(*description_.rig));
  for (const auto& [name, values] : description_.metadata) {
    ISOTHERM_RETURN_IF_ERROR(writer.WriteMetadata(name, values));
  }
  return OkStatus();
}

}  // namespace isotherm
