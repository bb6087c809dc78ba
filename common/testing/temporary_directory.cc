#include "common/testing/temporary_directory.h"

#include <cstdlib>
#include <string>
#include <system_error>

#include "common/base/check.h"

namespace isotherm::testing {

TemporaryDirectory::TemporaryDirectory() {
  std::string name = (std::filesystem::temp_directory_path() / "isotherm-test-XXXXXX").string();
  CHECK(mkdtemp(name.data()) != nullptr);
  path_ = name;
}

TemporaryDirectory::~TemporaryDirectory() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace isotherm::testing
