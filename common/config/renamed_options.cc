#include "common/config/renamed_options.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/config/nearest_name.h"

namespace isotherm {
namespace {

struct RenamedOption {
  std::string_view type;
  std::string_view before;
  std::string_view now;
};

constexpr RenamedOption kRenamed[] = {
    {"isotherm.TrackerOptions", "outside", "external_odometry"},
    {"isotherm.ExternalOdometryOptions", "max_turn_deg_s", "max_rotation_deg_s"},
    {"isotherm.SubMapOptions", "max_turn_deg", "max_rotation_deg"},
    {"isotherm.FeedbackOptions", "done_share", "done_fraction"},
    {"isotherm.FeedbackOptions", "advise_share", "advise_fraction"},
    {"isotherm.FeedbackOptions", "withdraw_share", "withdraw_fraction"},
    {"isotherm.FeedbackOptions", "picture_width_px", "image_width_px"},
    {"isotherm.DisplayOptions", "picture_file", "image_file"},
    {"isotherm.ShutterOptions", "tells", "reports_shutter"},
    {"isotherm.ShutterOptions", "obeys", "follows_orders"},
    {"isotherm.ClockOptions", "impulse_share", "impulse_fraction"},
};

struct RenamedFlag {
  std::string_view before;
  std::string_view now;
};

constexpr RenamedFlag kRenamedFlags[] = {
    {"--outside-poses", "--external-odometry"},
};

}  // namespace

std::string_view NameSinceRenaming(const google::protobuf::Descriptor& type,
                                   std::string_view name) {
  for (const RenamedOption& option : kRenamed) {
    if (option.type == type.full_name() && option.before == name) return option.now;
  }
  return {};
}

std::string_view FlagSinceRenaming(std::string_view flag) {
  const std::string_view name = flag.substr(0, flag.find('='));
  for (const RenamedFlag& renamed : kRenamedFlags) {
    if (renamed.before == name) return renamed.now;
  }
  return {};
}

std::string WithPresentNames(std::string text) {
  constexpr std::string_view kLetters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  std::size_t begin = text.find_first_not_of(" \n");
  while (begin != std::string::npos) {
    const std::size_t length =
        std::min(text.find_first_not_of(kLetters, begin), text.size()) - begin;
    for (const RenamedOption& option : kRenamed) {
      if (text.compare(begin, length, option.before) != 0) continue;
      text.replace(begin, length, option.now);
      break;
    }
    const std::size_t line_end = text.find('\n', begin);
    begin = text.find_first_not_of(" \n", line_end);
  }
  return text;
}

std::string SuggestOption(const google::protobuf::Descriptor& type, std::string_view name) {
  const std::string_view now = NameSinceRenaming(type, name);
  if (!now.empty()) return fmt::format(" It is called '{}' now.", now);
  std::vector<std::string> known;
  for (int i = 0; i < type.field_count(); ++i) known.push_back(type.field(i)->name());
  return DidYouMean(name, known);
}

}  // namespace isotherm
