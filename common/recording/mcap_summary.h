#pragma once

#include <cstdint>
#include <vector>

#include "common/recording/mcap_records.h"

namespace isotherm::mcap {

/// Holds what a summary tells of a file.
struct SummaryContent {
  std::vector<Schema> schemas;
  std::vector<Channel> channels;
  Statistics statistics;  ///< They count messages; numbers of schemas and channels are filled in.
  std::vector<MetadataIndex> metadata_indexes;
  std::vector<ChunkIndex> chunk_indexes;
};

/// Appends the summary, the footer and the closing magic of a file to `out`, which stands at
/// `offset` in it and ends with the record of the end of the data.
void AppendSummary(const SummaryContent& content, std::uint64_t offset, Bytes& out);

}  // namespace isotherm::mcap
