#include "ground/json/json.h"

#include <nlohmann/json.hpp>

namespace isotherm {

std::string JsonText(const Json& json) {
  constexpr int kIndent = 2;
  return json.dump(kIndent, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace) + '\n';
}

}  // namespace isotherm
