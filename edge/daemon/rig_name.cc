#include "edge/daemon/rig_name.h"

#include <algorithm>
#include <cctype>

#include "common/base/host_name.h"

namespace isotherm {
namespace {

// As long as the key of the link's topics.
constexpr std::size_t kMaxBytes = 32;

}  // namespace

std::string RigNameOf(std::string_view host_name) {
  std::string name(host_name.substr(0, std::min(host_name.find('.'), kMaxBytes)));
  std::replace_if(
      name.begin(), name.end(),
      [](unsigned char c) { return c > 127 || (std::isalnum(c) == 0 && c != '_' && c != '-'); },
      '-');
  return name.empty() ? "edge" : name;
}

std::string HostRigName() { return RigNameOf(HostName()); }

}  // namespace isotherm
