#include "ground/results/older_configuration.h"

#include <google/protobuf/descriptor.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string_view>
#include <vector>

#include "common/options/renamed_options.h"

namespace isotherm {
namespace {

namespace pb = google::protobuf;

/// Sets the field that is called `path` ("expert.max_step_m") from `type` on.
void SetAt(std::string_view path, const Json& value, const pb::Descriptor& type, Json& options) {
  const std::size_t dot = path.find('.');
  const std::string name(path.substr(0, dot));
  const pb::FieldDescriptor* field = type.FindFieldByName(name);
  if (field == nullptr) return;
  if (dot == std::string_view::npos) {
    if (field->message_type() == nullptr) {
      options[name] = value;
    } else if (value.is_structured()) {
      options[name] = WithPresentNames(value, *field->message_type());
    }
  } else if (field->message_type() != nullptr) {
    SetAt(path.substr(dot + 1), value, *field->message_type(), options[name]);
  }
}

/// Returns a repeated message with present names. An entry that stands alone is a list of one;
/// text, which is of an older grammar, is left out.
Json ListWithPresentNames(const Json& list, const pb::Descriptor& type) {
  Json present = Json::array();
  for (const Json& item : list.is_array() ? list : Json::array({list}))
    if (item.is_object()) present.push_back(WithPresentNames(item, type));
  return present;
}

/// The group that is called so last, within `parent`.
Json& Newest(Json& parent, const std::string& name) {
  Json& group = parent[name];
  return group.is_array() ? group.back() : group;
}

/// Another group of that name makes it a list.
void Open(Json& parent, const std::string& name) {
  Json& group = parent[name];
  if (group.is_object()) group = Json::array({group});
  if (group.is_array()) {
    group.push_back(Json::object());
  } else {
    group = Json::object();
  }
}

/// The value behind "name: " in text format.
Json ValueOf(const std::string& text) {
  Json value = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  return value.is_discarded() ? Json(text) : value;  // Enums stand there without quotes.
}

}  // namespace

Json WithPresentNames(const Json& options, const pb::Descriptor& type) {
  if (!options.is_object()) return options;
  Json present = Json::object();
  for (const auto& [name, value] : options.items()) {
    const pb::FieldDescriptor* field = type.FindFieldByName(name);
    if (const RenamedOption* renamed = field == nullptr ? FindRenamed(type, name) : nullptr) {
      if (renamed->place == RenamedOption::Place::kOptions)
        SetAt(renamed->now, value, type, present);
    } else if (field == nullptr || field->message_type() == nullptr) {
      present[name] = value;
    } else if (field->is_repeated()) {
      present[name] = ListWithPresentNames(value, *field->message_type());
    } else if (value.is_object()) {
      present[name].update(WithPresentNames(value, *field->message_type()));
    }
  }
  return present;
}

Json OptionsFromLines(const std::string& text) {
  Json options = Json::object();
  std::vector<std::string> groups;
  std::istringstream lines(text);
  const auto current = [&]() -> Json& {
    Json* group = &options;
    for (const std::string& name : groups) group = &Newest(*group, name);
    return *group;
  };
  for (std::string line; std::getline(lines, line);) {
    line.erase(0, line.find_first_not_of(' '));
    if (line == "}") {
      if (!groups.empty()) groups.pop_back();
    } else if (line.ends_with(" {")) {
      const std::string name = line.substr(0, line.size() - 2);
      Open(current(), name);
      groups.push_back(name);
    } else if (const std::size_t colon = line.find(": "); colon != std::string::npos) {
      current()[line.substr(0, colon)] = ValueOf(line.substr(colon + 2));
    }
  }
  return options;
}

}  // namespace isotherm
