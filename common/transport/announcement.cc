#include "common/transport/announcement.h"

#include "common/transport/bounded_text.h"

namespace isotherm {
namespace {

constexpr std::string_view kEdge = "isotherm-edge ";
constexpr std::string_view kGround = "isotherm-ground ";
constexpr std::size_t kMaxAnnouncementBytes = 128;

}  // namespace

std::string ToText(const Announcement& announcement) {
  const std::string_view program = announcement.role == Role::kEdge ? kEdge : kGround;
  const std::string text = std::string(program) + announcement.name + "@" + announcement.host;
  return std::string(CutText(text, kMaxAnnouncementBytes));
}

std::optional<Announcement> ParseAnnouncement(std::string_view text) {
  if (text.size() > kMaxAnnouncementBytes) return std::nullopt;
  Announcement announcement;
  if (text.starts_with(kEdge)) {
    text.remove_prefix(kEdge.size());
  } else if (text.starts_with(kGround)) {
    announcement.role = Role::kGround;
    text.remove_prefix(kGround.size());
  } else {
    return std::nullopt;
  }
  const std::size_t at = text.find('@');
  if (at == std::string_view::npos) return std::nullopt;
  announcement.name = Showable(text.substr(0, at));
  announcement.host = Showable(text.substr(at + 1));
  return announcement;
}

}  // namespace isotherm
