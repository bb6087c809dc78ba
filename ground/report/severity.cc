#include "ground/report/severity.h"

#include <fmt/format.h>

#include "common/options/text_proto.h"

namespace isotherm {

Result<SeverityTables> ReadSeverityTables(const std::filesystem::path& path) {
  SeverityTables tables;
  if (Status status = LoadTextProto(path, tables); !status.ok()) return Err(status);
  if (Status status = Validate(tables); !status.ok()) return Err(status.WithContext(path.string()));
  return tables;
}

Status Validate(const SeverityTables& tables) {
  if (tables.table().empty()) return InvalidArgument("there is no table in it");
  for (const SeverityTable& table : tables.table()) {
    if (table.basis() != "similar" && table.basis() != "ambient")
      return InvalidArgument("a table's basis must be \"similar\" or \"ambient\"");
    double end_k = 0.0;
    for (int i = 0; i < table.row_size(); ++i) {
      const SeverityRow& row = table.row(i);
      const bool is_open = !row.has_up_to_k();
      if (row.above_k() < end_k || (!is_open && row.up_to_k() <= row.above_k()) ||
          (is_open && i + 1 < table.row_size())) {
        return InvalidArgument(
            fmt::format("row {} of the table \"{}\" does not lie above the one before it", i + 1,
                        table.title()));
      }
      end_k = row.up_to_k();
    }
  }
  return OkStatus();
}

const SeverityRow* FindSeverity(const SeverityTables& tables, const std::string& basis,
                                double difference_k) {
  for (const SeverityTable& table : tables.table()) {
    if (table.basis() != basis) continue;
    for (const SeverityRow& row : table.row()) {
      if (difference_k > row.above_k() && (!row.has_up_to_k() || difference_k <= row.up_to_k()))
        return &row;
    }
  }
  return nullptr;
}

}  // namespace isotherm
