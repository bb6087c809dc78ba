#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace isotherm::lint {

/// Which folders each folder may include besides itself: its options and the folders that declare
/// its input. The order is that of the line, from what others stand on to what stands on others.
using FolderArrows = std::map<std::string, std::set<std::string>, std::less<>>;

/// The table of docs/architecture.md, "Folders and the dependency rule".
const FolderArrows& AllowedArrows();

/// Folders that lead back to the first, which is named again at the end ("a", "b", "a"); empty if
/// there is no circle.
std::vector<std::string> FindCircle(const FolderArrows& arrows);

}  // namespace isotherm::lint
