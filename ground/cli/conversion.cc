#include "ground/cli/conversion.h"

#include <optional>

#include "common/base/partial_file.h"
#include "common/base/progress.h"
#include "common/base/service.h"
#include "common/options/nearest_name.h"

namespace isotherm {

void AddEncodingOption(CLI::App& command, ImageStorage& storage, const std::string& help) {
  const auto name = [](ImageStorage kind) { return static_cast<int>(kind); };
  command.add_option("--encoding", storage, help)
      ->transform(CLI::Validator(NumberOfName({{"viewable", name(ImageStorage::kViewable)},
                                               {"compact", name(ImageStorage::kCompact)}}),
                                 ""))
      ->type_name("KIND");
}

Result<ConvertSummary> ConvertInto(const ConversionTarget& target, ConvertRequest request) {
  const StopSignal signal;  // Before any other thread.
  const Result<PartialFile> file = PartialFile::Create(target.output, target.force);
  if (!file) return Err(file.error());
  request.output = file->path();
  request.stop = signal.token();
  std::optional<ProgressBar> progress;
  request.progress = [&](double fraction) {
    if (!progress) progress.emplace(target.verb, 0, "");
    progress->Update(fraction);
  };
  Result<ConvertSummary> summary = ConvertRecording(request);
  if (!summary) return summary;
  if (Status named = file->Commit(); !named.ok()) return Err(std::move(named));
  if (progress) progress->Finish();
  return summary;
}

}  // namespace isotherm
