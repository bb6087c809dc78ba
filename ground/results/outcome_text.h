#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace isotherm {

/// Returns what the short names of reasons in stats.json mean, for people: a sentence with what to
/// do, to be read behind "N lost: ". An unknown name explains itself.
std::string ExplainLost(std::string_view reason);

/// The same for thermal frames, behind "N not used: ".
std::string ExplainLeftOut(std::string_view reason);

/// The name that occurs most often; empty without any.
std::string MainReason(const std::map<std::string, std::uint64_t>& counts);

}  // namespace isotherm
