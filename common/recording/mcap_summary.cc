#include "common/recording/mcap_summary.h"

#include <span>

namespace isotherm::mcap {
namespace {

void AppendGroup(const SummaryContent& content, Opcode group, Bytes& out) {
  switch (group) {
    case Opcode::kSchema:
      for (const Schema& schema : content.schemas) Append(schema, out);
      break;
    case Opcode::kChannel:
      for (const Channel& channel : content.channels) Append(channel, out);
      break;
    case Opcode::kStatistics: {
      Statistics statistics = content.statistics;
      statistics.schema_count = static_cast<std::uint16_t>(content.schemas.size());
      statistics.channel_count = static_cast<std::uint32_t>(content.channels.size());
      Append(statistics, out);
      break;
    }
    case Opcode::kMetadataIndex:
      for (const MetadataIndex& index : content.metadata_indexes) Append(index, out);
      break;
    default:
      for (const ChunkIndex& index : content.chunk_indexes) Append(index, out);
  }
}

}  // namespace

void AppendSummary(const SummaryContent& content, std::uint64_t offset, Bytes& out) {
  const std::size_t summary_begin = out.size();
  std::vector<SummaryOffset> offsets;
  for (const Opcode group : {Opcode::kSchema, Opcode::kChannel, Opcode::kStatistics,
                             Opcode::kMetadataIndex, Opcode::kChunkIndex}) {
    const std::size_t begin = out.size();
    AppendGroup(content, group, out);
    if (out.size() == begin) continue;
    offsets.push_back({.group = group, .start = offset + begin, .length = out.size() - begin});
  }
  Footer footer{.summary_start = offset + summary_begin,
                .summary_offset_start = offset + out.size(),
                .summary_crc = 0};
  for (const SummaryOffset& group : offsets) Append(group, out);
  // The checksum covers the summary and the footer up to, not including, the checksum itself.
  Bytes footer_record;
  Append(footer, footer_record);
  const std::uint32_t summary_crc = Crc32(std::span(out).subspan(summary_begin));
  footer.summary_crc = Crc32(
      std::span(footer_record).first(kFooterRecordBytes - sizeof(footer.summary_crc)), summary_crc);
  Append(footer, out);
  out.insert(out.end(), kMagic.begin(), kMagic.end());
}

}  // namespace isotherm::mcap
