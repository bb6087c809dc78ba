// A camera's process whose library does what its arguments say: WHAT AFTER_FRAMES. WHAT is one of
// crash, hang, fail, end, go-on; with cannot-open and hang-at-open it does so at once; refuse:
// orders are refused; hang-at-order: it does when it gets one.

#include <unistd.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <thread>

#include "edge/source/camera_process.h"

namespace isotherm {
namespace {

class FakeCamera final : public FrameSource {
 public:
  FakeCamera(std::string what, int after_frames)
      : what_(std::move(what)), after_frames_(after_frames) {}

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
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));  // The camera's period.
    return Frame();
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
    return {{Sensor::kThermal, "fake", "Fake 1", "S-9", 5, 3, 40.0, "all on", true}};
  }

 private:
  [[noreturn]] static void Hang() {
    while (true) ::pause();
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
    frame.depth_scale = 10'000.0;
    frame.shutter_closed = nuc_ordered_;
    frame.camera_nuc = CameraNuc{automatic_ordered_ ? NucState::kDesired : NucState::kSettling,
                                 NucSource::kPolled, 1.5};
    frame.housekeeping = {30.5F, 31.5F, 32.5F};
    ++frames_;
    return frame;
  }

  const std::string what_;
  const int after_frames_;
  const SystemClock clock_;
  int frames_ = 0;
  bool nuc_ordered_ = false;
  bool automatic_ordered_ = false;
};

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  isotherm::FakeCamera camera(argv[1], std::atoi(argv[2]));
  return isotherm::ServeCamera(camera, isotherm::SystemClock());
}
