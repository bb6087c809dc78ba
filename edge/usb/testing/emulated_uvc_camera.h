#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "edge/usb/testing/emulated_device.h"
#include "edge/usb/testing/fault_script.h"
#include "edge/usb/testing/uvc_descriptor_data.h"
#include "edge/usb/uvc_probe.h"

namespace isotherm {

/// A UVC camera that does what a script says: descriptors, agreement on a mode, payloads with
/// headers over isochronous or bulk transfers, extension units. What the images show is the
/// business of derived classes.
class EmulatedUvcCamera : public EmulatedDevice {
 public:
  EmulatedUvcCamera(EmulatedIdentity identity, UvcCameraLayout layout, int header_bytes,
                    std::string_view script);

  EmulatedIdentity identity() const override { return identity_; }
  std::optional<std::vector<std::uint8_t>> Control(const UsbControl& control, Bytes data,
                                                   std::size_t read_bytes) override;
  void SetAlternate(int interface, int alternate) override;
  void ClearHalt(std::uint8_t endpoint) override;
  EmulatedPacket Isochronous(std::uint8_t endpoint, Nanoseconds time, std::size_t most) override;
  std::optional<std::vector<std::uint8_t>> Bulk(std::uint8_t endpoint, Nanoseconds time,
                                                std::size_t most) override;
  std::optional<Unplugged> TakeUnplugged() override;

  /// Frames begun so far, and the alternate setting that is active. Thread-safe.
  int frames_sent() const { return frames_sent_; }
  int alternate() const { return alternate_; }
  /// Returns whether a camera with bulk transfers streams: it does between agreement on a mode and
  /// ClearHalt. Thread-safe.
  bool bulk_streaming() const { return bulk_streaming_; }

 protected:
  /// The bytes of the next frame.
  virtual std::vector<std::uint8_t> MakeFrame(const FaultStep& step) = 0;
  /// Requests to extension units and other vendor requests.
  virtual std::optional<std::vector<std::uint8_t>> VendorControl(const UsbControl& control,
                                                                 Bytes data,
                                                                 std::size_t read_bytes) = 0;
  const UvcCameraLayout& layout() const { return layout_; }
  const UvcProbe& committed() const { return committed_; }

 private:
  /// Begins what is due at `time`; false if nothing is.
  bool HasFrame(Nanoseconds time);
  void Begin(const FaultStep& step);
  /// The next payload of at most `most` bytes.
  EmulatedPacket NextPayload(Nanoseconds time, std::size_t most);
  bool HasBulkPayload(Nanoseconds time);
  std::vector<std::uint8_t> Header(Nanoseconds time, bool last) const;

  EmulatedIdentity identity_;
  const UvcCameraLayout layout_;
  const std::size_t header_bytes_;
  FaultScript script_;
  UvcProbe probe_;
  UvcProbe committed_;
  bool stalled_ = false;
  std::optional<Unplugged> unplugged_;
  std::atomic<int> alternate_{0};
  std::atomic<int> frames_sent_{0};
  std::vector<std::uint8_t> bulk_payload_;  ///< Empty: none under way.
  std::size_t bulk_sent_ = 0;
  std::atomic<bool> bulk_streaming_{false};

  std::optional<Nanoseconds> next_frame_at_;
  FaultStep step_;
  std::vector<std::uint8_t> frame_;
  std::size_t sent_ = 0;
  std::size_t end_ = 0;  ///< Where the frame ends on the bus; less than its size if cut short.
  bool in_frame_ = false;
  bool fault_done_ = false;
  bool frame_id_ = false;
  Nanoseconds frame_time_{0};
};

}  // namespace isotherm
