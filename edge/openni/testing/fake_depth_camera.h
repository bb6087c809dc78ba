#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/testing/temporary_directory.h"
#include "edge/openni/testing/fake_depth_script.h"

namespace isotherm {

/// Tells the fake driver what to be, for this process and its children. Every change of `script`
/// takes effect with Apply: `connected` at once, the rest when the camera is opened. Without one
/// there is no camera.
class FakeDepthCamera {
 public:
  FakeDepthCamera() { Apply(); }
  ~FakeDepthCamera() {
    std::filesystem::remove(path_);
    std::filesystem::remove(hang_mark());
  }
  FakeDepthCamera(const FakeDepthCamera&) = delete;
  FakeDepthCamera& operator=(const FakeDepthCamera&) = delete;

  void Apply() const {
    // Replaced as a whole: the driver reads it at any moment.
    const std::filesystem::path next = path_.string() + ".next";
    std::ofstream(next) << script.ToText();
    std::filesystem::rename(next, path_);
  }
  void Plug(bool in) {
    script.connected = in;
    Apply();
  }
  /// A file that is there as soon as the library hangs.
  std::filesystem::path hang_mark() const { return HangMark(path_); }
  /// The driver reads there: a sandbox must allow it.
  std::filesystem::path folder() const { return path_.parent_path(); }

  FakeDepthScript script;

 private:
  /// One file per process, told once: the driver's thread may outlive a test, and must not read the
  /// environment while the next one changes it.
  static const std::filesystem::path& Path() {
    static const testing::TemporaryDirectory folder;
    static const std::filesystem::path path = [] {
      std::filesystem::path file = folder.path() / "depth.txt";
      setenv("ISOTHERM_FAKE_DEPTH", file.c_str(), 1);
      return file;
    }();
    return path;
  }

  const std::filesystem::path path_ = Path();
};

}  // namespace isotherm
