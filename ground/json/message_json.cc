#include "ground/json/message_json.h"

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/message.h>
#include <google/protobuf/util/json_util.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>

namespace isotherm {
namespace {

namespace pb = google::protobuf;

Json NumberJson(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}

/// The double with the fewest digits that reads back as `value`: 0.1, not 0.10000000149.
double ShortestDouble(float value) {
  return std::isfinite(value) ? std::strtod(fmt::format("{}", value).c_str(), nullptr) : value;
}

/// The value of a field, or the element `index` of a repeated one. Default if it is absent.
Json ValueJson(const pb::Message& message, const pb::FieldDescriptor* field, int index) {
  const pb::Reflection& r = *message.GetReflection();
  const bool repeated = field->is_repeated();
  switch (field->cpp_type()) {
    case pb::FieldDescriptor::CPPTYPE_INT32:
      return repeated ? r.GetRepeatedInt32(message, field, index) : r.GetInt32(message, field);
    case pb::FieldDescriptor::CPPTYPE_INT64:
      return repeated ? r.GetRepeatedInt64(message, field, index) : r.GetInt64(message, field);
    case pb::FieldDescriptor::CPPTYPE_UINT32:
      return repeated ? r.GetRepeatedUInt32(message, field, index) : r.GetUInt32(message, field);
    case pb::FieldDescriptor::CPPTYPE_UINT64:
      return repeated ? r.GetRepeatedUInt64(message, field, index) : r.GetUInt64(message, field);
    case pb::FieldDescriptor::CPPTYPE_DOUBLE:
      return NumberJson(repeated ? r.GetRepeatedDouble(message, field, index)
                                 : r.GetDouble(message, field));
    case pb::FieldDescriptor::CPPTYPE_FLOAT:
      return NumberJson(ShortestDouble(repeated ? r.GetRepeatedFloat(message, field, index)
                                                : r.GetFloat(message, field)));
    case pb::FieldDescriptor::CPPTYPE_BOOL:
      return repeated ? r.GetRepeatedBool(message, field, index) : r.GetBool(message, field);
    case pb::FieldDescriptor::CPPTYPE_ENUM:
      return (repeated ? r.GetRepeatedEnum(message, field, index) : r.GetEnum(message, field))
          ->name();
    case pb::FieldDescriptor::CPPTYPE_STRING:
      return repeated ? r.GetRepeatedString(message, field, index) : r.GetString(message, field);
    case pb::FieldDescriptor::CPPTYPE_MESSAGE:
      return ToJson(repeated ? r.GetRepeatedMessage(message, field, index)
                             : r.GetMessage(message, field));
  }
  return {};
}

bool HasRequiredFields(const pb::Descriptor& type) {
  for (int i = 0; i < type.field_count(); ++i) {
    if (type.field(i)->is_required()) return true;
  }
  return false;
}

/// Returns whether an absent field has a value all the same. A calibration that is absent stays
/// absent.
bool HasDefault(const pb::FieldDescriptor* field) {
  const pb::Descriptor* type = field->message_type();
  return type != nullptr ? !HasRequiredFields(*type) : field->has_default_value();
}

}  // namespace

Json ToJson(const pb::Message& message) {
  const pb::Descriptor& type = *message.GetDescriptor();
  const pb::Reflection& reflection = *message.GetReflection();
  Json json = Json::object();
  for (int i = 0; i < type.field_count(); ++i) {
    const pb::FieldDescriptor* field = type.field(i);
    if (field->is_repeated()) {
      for (int k = 0; k < reflection.FieldSize(message, field); ++k)
        json[field->name()].push_back(ValueJson(message, field, k));
    } else if (reflection.HasField(message, field) || HasDefault(field)) {
      json[field->name()] = ValueJson(message, field, 0);
    }
  }
  return json;
}

Status FromJson(const Json& json, std::string_view source_name, pb::Message& message) {
  const auto parsed = pb::util::JsonStringToMessage(JsonText(json), &message);
  if (parsed.ok()) return OkStatus();
  return InvalidArgument(fmt::format("{}: {}", source_name, std::string(parsed.message())));
}

}  // namespace isotherm
