#pragma once

#include <memory>
#include <string>
#include <utility>

#include "ground/console/web_server.h"

namespace isotherm {

/// A reply of plain text, for people who read what a program was told.
inline WebReply TextReply(int status, std::string text) {
  WebReply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(std::move(text));
  return reply;
}

}  // namespace isotherm
