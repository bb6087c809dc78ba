#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "ground/console/web_server.h"

namespace isotherm {

/// A file of the page, as it is compiled into the program.
struct PageFile {
  std::string_view path;  ///< "/app.js"
  std::string_view content_type;
  std::string_view gzip;  ///< Its bytes, packed.
  std::string_view etag;  ///< Changes with them, in quotes.
};

/// All files of the page. Empty if the program was built without it.
std::span<const PageFile> PageFiles();

/// Answers requests for files; 404 for everything else. Thread-compatible.
class StaticPage {
 public:
  WebReply Answer(const WebRequest& request) const;
};

/// Headers for everything that a browser may show: no foreign scripts, styles, frames or hosts.
void AddSafetyHeaders(WebReply& reply);

}  // namespace isotherm
