#pragma once

#include <filesystem>
#include <string_view>

#include "ground/console/live.pb.h"
#include "ground/console/web_server.h"

namespace isotherm {

/// Hands out the results of the scan that is shown, once they are written, and nothing else of
/// their folder: /api/files lists them, /api/files/NAME sends one. Thread-compatible.
class ResultDownloads {
 public:
  static constexpr std::string_view kPath = "/api/files";

  static bool IsFor(const WebRequest& request) {
    return request.path == kPath || request.path.starts_with("/api/files/");
  }
  WebReply Answer(const WebRequest& request, const live::Scan& scan) const;

 private:
  WebReply List(const live::Scan& scan) const;
};

}  // namespace isotherm
