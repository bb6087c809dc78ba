#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>

#include <charconv>
#include <limits>
#include <vector>

#include "common/options/nearest_name.h"
#include "common/options/renamed_options.h"
#include "common/options/text_proto.h"

namespace isotherm {
namespace {

namespace pb = google::protobuf;
using pb::FieldDescriptor;

bool IsListOfTexts(const FieldDescriptor& field) {
  return field.is_repeated() && field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
}

/// Returns what an assignment can name: a value is added to a list of texts, other lists are for
/// files.
std::vector<std::string> FieldNames(const pb::Descriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.field_count(); ++i) {
    if (!type.field(i)->is_repeated() || IsListOfTexts(*type.field(i)))
      names.push_back(type.field(i)->name());
  }
  return names;
}

// The whole of `text` as a number; locale independent.
template <typename T>
Result<T> ParseNumber(std::string_view text, std::string_view kind) {
  std::string_view digits = text;
  // std::from_chars takes no plus sign, and people write one.
  if (digits.starts_with('+')) digits.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) {
    return Err(InvalidArgument(fmt::format("'{}' is out of range, expected {} between {} and {}",
                                           text, kind, std::numeric_limits<T>::lowest(),
                                           std::numeric_limits<T>::max())));
  }
  if (error != std::errc() || end != digits.data() + digits.size()) {
    return Err(InvalidArgument(fmt::format("'{}' is not {}", text, kind)));
  }
  return value;
}

Result<bool> ParseBool(std::string_view text) {
  if (text == "true" || text == "1" || text == "on" || text == "yes") return true;
  if (text == "false" || text == "0" || text == "off" || text == "no") return false;
  return Err(
      InvalidArgument(fmt::format("'{}' is not a truth value, expected true or false", text)));
}

Result<const pb::EnumValueDescriptor*> ParseEnum(std::string_view text,
                                                 const pb::EnumDescriptor& type) {
  std::vector<std::string> names;
  for (int i = 0; i < type.value_count(); ++i) names.push_back(type.value(i)->name());
  const pb::EnumValueDescriptor* value = type.FindValueByName(std::string(text));
  if (value != nullptr) return value;
  return Err(InvalidArgument(
      fmt::format("'{}' is not one of {}.{}", text, JoinNames(names), DidYouMean(text, names))));
}

std::string_view Unquoted(std::string_view text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                      text.back() == text.front();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

Status SetScalar(pb::Message& message, const FieldDescriptor* field, std::string_view text) {
  const pb::Reflection& reflection = *message.GetReflection();
  if (IsListOfTexts(*field)) {
    // Shells take quotes away, configuration management may not.
    reflection.AddString(&message, field, std::string(Unquoted(text)));
    return OkStatus();
  }
  const auto set = [&](const auto& value, auto setter) {
    if (!value) return value.error();
    (reflection.*setter)(&message, field, *value);
    return OkStatus();
  };
  constexpr std::string_view kInteger = "an integer";
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_INT32:
      return set(ParseNumber<std::int32_t>(text, kInteger), &pb::Reflection::SetInt32);
    case FieldDescriptor::CPPTYPE_INT64:
      return set(ParseNumber<std::int64_t>(text, kInteger), &pb::Reflection::SetInt64);
    case FieldDescriptor::CPPTYPE_UINT32:
      return set(ParseNumber<std::uint32_t>(text, kInteger), &pb::Reflection::SetUInt32);
    case FieldDescriptor::CPPTYPE_UINT64:
      return set(ParseNumber<std::uint64_t>(text, kInteger), &pb::Reflection::SetUInt64);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return set(ParseNumber<double>(text, "a number"), &pb::Reflection::SetDouble);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return set(ParseNumber<float>(text, "a number"), &pb::Reflection::SetFloat);
    case FieldDescriptor::CPPTYPE_BOOL:
      return set(ParseBool(text), &pb::Reflection::SetBool);
    case FieldDescriptor::CPPTYPE_ENUM:
      return set(ParseEnum(text, *field->enum_type()), &pb::Reflection::SetEnum);
    case FieldDescriptor::CPPTYPE_STRING:
      reflection.SetString(&message, field, std::string(Unquoted(text)));
      return OkStatus();
    case FieldDescriptor::CPPTYPE_MESSAGE:
      break;
  }
  return InvalidArgument(fmt::format("names a group of options; name one of its fields: {}",
                                     JoinNames(FieldNames(*field->message_type()))));
}

}  // namespace

Status ApplyOverride(std::string_view assignment, pb::Message& message) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    return InvalidArgument(fmt::format("'{}': expected stage.field=value", assignment));
  }
  const std::string_view path = assignment.substr(0, equals);
  const std::string_view value = assignment.substr(equals + 1);
  pb::Message* target = &message;
  for (std::size_t begin = 0;;) {
    const std::size_t dot = path.find('.', begin);
    const std::string name(path.substr(begin, dot == std::string_view::npos ? dot : dot - begin));
    const pb::Descriptor& type = *target->GetDescriptor();
    const FieldDescriptor* field = type.FindFieldByName(name);
    const std::string_view where = begin == 0 ? std::string_view() : path.substr(0, begin - 1);
    if (field == nullptr || (field->is_repeated() && !IsListOfTexts(*field))) {
      const std::vector<std::string> known = FieldNames(type);
      return InvalidArgument(fmt::format("'{}': there is no {} '{}'{}.{} Known: {}.", assignment,
                                         begin == 0 ? "stage or option" : "option", name,
                                         where.empty() ? "" : fmt::format(" in '{}'", where),
                                         SuggestOption(type, name, where), JoinNames(known)));
    }
    if (dot == std::string_view::npos) return SetScalar(*target, field, value).WithContext(path);
    if (field->message_type() == nullptr) {
      return InvalidArgument(fmt::format("'{}': '{}' is a single value and has no fields",
                                         assignment, path.substr(0, dot)));
    }
    target = target->GetReflection()->MutableMessage(target, field);
    begin = dot + 1;
  }
}

}  // namespace isotherm
