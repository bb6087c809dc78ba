#include "ground/console/result_downloads.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>
#include <vector>

#include "ground/console/json_reply.h"
#include "ground/console/text_reply.h"
#include "ground/export/result_files.h"
#include "ground/json/json.h"

namespace isotherm {
namespace {

namespace fs = std::filesystem;

/// While a scan goes on, its folder may hold the results of another that had the same name.
bool AreWritten(const live::Scan& scan) {
  return scan.phase() == live::Scan::ENDED || scan.phase() == live::Scan::FINISHED;
}

/// Returns the results' files that can be sent: no links that lead elsewhere.
std::vector<fs::path> FilesOf(const live::Scan& scan) {
  if (!AreWritten(scan) || scan.folder().empty()) return {};
  std::vector<fs::path> files = ResultFilesIn(scan.folder());
  std::erase_if(files, [](const fs::path& file) {
    std::error_code ignored;
    return !fs::is_regular_file(fs::symlink_status(file, ignored));
  });
  return files;
}

std::string NameOf(const fs::path& file, const live::Scan& scan) {
  return file.lexically_relative(scan.folder()).generic_string();
}

}  // namespace

WebReply ResultDownloads::List(const live::Scan& scan) const {
  Json list{{"scan", scan.name()}, {"written", AreWritten(scan)}, {"files", Json::array()}};
  for (const fs::path& file : FilesOf(scan)) {
    std::error_code error;
    const std::uintmax_t bytes = fs::file_size(file, error);
    if (!error) list["files"].push_back({{"name", NameOf(file, scan)}, {"bytes", bytes}});
  }
  return JsonReply(JsonText(list));
}

WebReply ResultDownloads::Answer(const WebRequest& request, const live::Scan& scan) const {
  if (request.method != "GET" && request.method != "HEAD")
    return TextReply(405, "only GET is answered here\n");
  if (request.path == kPath) return List(scan);
  const std::string_view asked = std::string_view(request.path).substr(kPath.size() + 1);
  const std::vector<fs::path> files = FilesOf(scan);
  const auto found =
      std::ranges::find(files, asked, [&](const fs::path& file) { return NameOf(file, scan); });
  if (found == files.end()) {
    return TextReply(404, AreWritten(scan) ? "the results have no such file\n"
                                           : "results are written when the scan has ended\n");
  }
  WebReply reply;
  reply.file = *found;
  reply.content_type = "application/octet-stream";
  reply.headers = {{"Content-Disposition",
                    fmt::format("attachment; filename=\"{}\"", found->filename().string())},
                   {"Cache-Control", "no-store"}};
  return reply;
}

}  // namespace isotherm
