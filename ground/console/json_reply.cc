#include "ground/console/json_reply.h"

#include <google/protobuf/util/json_util.h>

#include <utility>

#include "ground/console/text_reply.h"

namespace isotherm {

WebReply JsonReply(std::string json) {
  WebReply reply = TextReply(200, std::move(json));
  reply.content_type = "application/json";
  reply.headers = {{"Cache-Control", "no-store"}};
  return reply;
}

WebReply JsonReply(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.always_print_primitive_fields = true;
  options.preserve_proto_field_names = true;
  options.add_whitespace = true;
  std::string json;
  static_cast<void>(google::protobuf::util::MessageToJsonString(message, &json, options));
  return JsonReply(std::move(json));
}

}  // namespace isotherm
