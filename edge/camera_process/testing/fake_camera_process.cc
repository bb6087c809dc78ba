// A camera's process whose library does what its arguments say: WHAT AFTER_FRAMES. WHAT is one of
// crash, hang, fail, end, go-on, patient (it waits for whoever reads it); with cannot-open and
// hang-at-open it does so at once; refuse: orders are refused; hang-at-order: it does when it gets
// one. What no sound process does: bad-sensor, bad-nuc-state, bad-nuc-source, bad-status,
// bad-number, ok-as-failure; bad-camera at once; shrink: it takes the shared memory away. With a
// third argument, a folder: it is confined to the file "allowed" in it, and the pixels of each
// frame are what ProbeSandbox says; free: it is not confined; local: it may have local sockets;
// unit-filter: a request for Landlock would end it.

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "edge/camera_process/camera_process.h"
#include "edge/camera_process/camera_process_descriptors.h"
#include "edge/camera_process/testing/sandbox_probe.h"

namespace isotherm {
namespace {

class FakeCamera final : public FrameSource {
 public:
  FakeCamera(std::string what, int after_frames, std::string probed_folder)
      : what_(std::move(what)),
        after_frames_(after_frames),
        probed_folder_(std::move(probed_folder)) {}

  std::string_view name() const override { return "fake"; }
  Status Open() override {
    if (what_ == "cannot-open") return InvalidArgument("no such mode");
    if (what_ == "hang-at-open") Hang();
    return OkStatus();
  }
  Result<SourceItem> Read(std::stop_token) override {
    if (frames_ == after_frames_) {
      if (what_ == "crash") std::abort();
      if (what_ == "hang") Hang();
      if (what_ == "fail") return Err(DataLoss("the camera sends nonsense"));
      if (what_ == "end") return EndOfStream{};
      if (what_ == "bad-status") return Err(Status(static_cast<StatusCode>(99), "?"));
      if (what_ == "ok-as-failure") return Err(OkStatus());
      if (what_ == "shrink" && ::ftruncate(kCameraPixelsDescriptor, 0) == 0) ::_exit(0);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // The camera's period.
    RawFrame frame = Frame();
    if (frame.frame_number == static_cast<std::uint64_t>(after_frames_)) Spoil(frame);
    return frame;
  }
  void Close() override {}
  std::optional<Status> Control(const CameraControl& control) override {
    if (what_ == "refuse") return FailedPrecondition("its shutter is glued");
    if (what_ == "hang-at-order") Hang();
    nuc_ordered_ = std::holds_alternative<TriggerNuc>(control);
    const auto* const automatic = std::get_if<SetAutomaticNuc>(&control);
    automatic_ordered_ = automatic != nullptr && automatic->on;
    return OkStatus();
  }
  std::optional<Rig> rig() const override {
    Rig rig;
    rig.depth = CameraModel{.width = 5, .height = 3, .fx = 6.5, .fy = 6.25, .cx = 2, .cy = 1};
    rig.method = "nominal";
    return rig;
  }
  std::vector<CameraDescription> cameras() const override {
    const Sensor sensor = what_ == "bad-camera" ? static_cast<Sensor>(7) : Sensor::kThermal;
    return {{sensor, "fake", "Fake 1", "S-9", 5, 3, 40.0, "all on", true, kScale}};
  }

 private:
  [[noreturn]] static void Hang() {
    while (true) ::pause();
  }

  void Spoil(RawFrame& frame) const {
    if (what_ == "bad-sensor") frame.sensor = static_cast<Sensor>(2);
    if (what_ == "bad-nuc-state") frame.camera_nuc->state = static_cast<NucState>(99);
    if (what_ == "bad-nuc-source") frame.camera_nuc->source = static_cast<NucSource>(99);
    if (what_ == "bad-scale") frame.thermal_scale = {0.0, 0.0};
    if (what_ == "bad-number") frame.frame_number = std::uint64_t{1} << 60U;
  }

  RawFrame Frame() {
    RawFrame frame;
    frame.sensor = Sensor::kThermal;
    frame.frame_number = static_cast<std::uint64_t>(frames_);
    frame.device_ticks = DeviceTicks(std::chrono::microseconds(1000 + 2000 * frames_));
    frame.has_device_clock = false;
    frame.arrival_wall = clock_.Now();
    frame.arrival_steady = clock_.SteadyNow();
    frame.pixels = Image<std::uint16_t>(5, 3);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
      frame.pixels.data()[i] =
          static_cast<std::uint16_t>(1000 * i + static_cast<std::size_t>(frames_));
    }
    if (!probed_folder_.empty()) {
      const SandboxResults results = ProbeSandbox(probed_folder_);
      std::copy(results.begin(), results.end(), frame.pixels.data());
    }
    frame.depth_scale = 10'000.0;
    frame.thermal_scale = kScale;
    frame.shutter_closed = nuc_ordered_;
    frame.camera_nuc = CameraNuc{automatic_ordered_ ? NucState::kDesired : NucState::kSettling,
                                 NucSource::kPolled, 1.5};
    frame.housekeeping = {30.5F, 31.5F, 32.5F};
    ++frames_;
    return frame;
  }

  static constexpr RadiometricScale kScale{0.02, 5.0};
  const std::string what_;
  const int after_frames_;
  const std::string probed_folder_;  ///< Empty: none.
  const SystemClock clock_{};
  int frames_ = 0;
  bool nuc_ordered_ = false;
  bool automatic_ordered_ = false;
};

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 3 && argc != 4) return 64;
  const std::string what = argv[1];
  const std::string folder = argc == 4 ? argv[3] : "";
  isotherm::FakeCamera camera(what, std::atoi(argv[2]), folder);
  isotherm::ServeSettings settings;
  settings.waits = what == "patient";
  if (!folder.empty() && what != "free") {
    isotherm::CameraSandbox& sandbox = settings.sandbox.emplace();
    sandbox.read = {folder + "/allowed", folder + "/missing", "/proc/self"};
    sandbox.local_sockets = what == "local";
  }
  if (what == "unit-filter") isotherm::ForbidLandlock();
  return isotherm::ServeCamera(camera, isotherm::SystemClock(), settings);
}
