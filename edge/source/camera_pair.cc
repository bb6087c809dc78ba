#include "edge/source/camera_pair.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/processor_time.h"
#include "common/frame/sensor_name.h"

namespace isotherm {
namespace {

std::string CameraNameOf(Sensor sensor) { return fmt::format("{} camera", NameOf(sensor)); }

}  // namespace

CameraPair::CameraPair(std::vector<Camera> cameras, Queue queue)
    : waits_(queue.policy == OverflowPolicy::kBlock),
      queue_(cameras.size(), queue.capacity, queue.policy, std::move(queue.on_drop)) {
  for (Camera& camera : cameras) {
    members_.push_back(std::make_unique<Member>());
    members_.back()->camera = std::move(camera);
  }
}

CameraPair::~CameraPair() { Close(); }

Status CameraPair::Open() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    // Promises are used up by an opening; the pair may be opened again.
    members_[i]->opened = {};
    members_[i]->may_run = {};
    members_[i]->ended = false;
    members_[i]->thread = std::jthread([this, i](const std::stop_token& stop) { Run(i, stop); });
  }
  std::string missing;
  std::optional<Status> impossible;  // Trying again would not help.
  std::size_t working = 0;
  for (const std::unique_ptr<Member>& member : members_) {
    // All are opened at the same time, each on its thread: a camera that takes seconds to fail does
    // not add to the other's.
    const Opened opened = member->opened.get_future().get();
    AddDescription(opened);
    if (opened.status.ok()) {
      ++working;
      continue;
    }
    const Status named = opened.status.WithContext(CameraNameOf(member->camera.sensor));
    if (named.code() == StatusCode::kInvalidArgument) impossible = named;
    missing += (missing.empty() ? "" : "; ") + named.message();
  }
  // Nobody reads a camera before it is known that the pair works: otherwise one would deliver while
  // the other ends the program.
  const bool runs = working > 0 && !impossible;
  for (const std::unique_ptr<Member>& member : members_) member->may_run.set_value(runs);
  if (runs) {
    if (!missing.empty()) {
      LOG(Source, Warning) << "starting without a camera, which is tried again: " << missing;
    }
    return OkStatus();
  }
  Close();
  return impossible ? *impossible : Unavailable("no camera: " + missing);
}

void CameraPair::AddDescription(const Opened& opened) {
  descriptions_.insert(descriptions_.end(), opened.descriptions.begin(), opened.descriptions.end());
  if (!opened.rig) return;
  if (!rig_) {
    rig_ = opened.rig;
    return;
  }
  if (opened.rig->depth) rig_->depth = opened.rig->depth;
  if (opened.rig->thermal) rig_->thermal = opened.rig->thermal;
}

Result<SourceItem> CameraPair::Read(std::stop_token stop) {
  reading_ = true;
  return queue_.Pop(kReadWait, stop);
}

void CameraPair::Close() {
  // All are asked to stop before any is waited for, so that their times do not add up.
  for (const std::unique_ptr<Member>& member : members_) member->thread.request_stop();
  for (const std::unique_ptr<Member>& member : members_) {
    if (member->thread.joinable()) member->thread.join();
  }
}

std::optional<RawFrame> CameraPair::TakeUnread() {
  while (true) {
    SourceItem item = queue_.Pop(Nanoseconds(0), {});
    if (auto* frame = std::get_if<RawFrame>(&item)) return std::move(*frame);
    // The cameras' threads are gone: the end comes after the last item.
    if (std::holds_alternative<EndOfStream>(item)) return std::nullopt;
  }
}

CameraPair::Member* CameraPair::Thermal() const {
  for (const std::unique_ptr<Member>& member : members_) {
    if (member->camera.sensor == Sensor::kThermal) return member.get();
  }
  return nullptr;
}

std::optional<Status> CameraPair::Control(const CameraControl& control) {
  Member* const thermal = Thermal();
  if (thermal == nullptr) return FailedPrecondition("there is no thermal camera");
  if (open_orders_ == kMaxOrders) {
    return Unavailable(
        fmt::format("the thermal camera has not answered the last {} orders", kMaxOrders));
  }
  ++open_orders_;
  // Never waits: the queue has room for kMaxOrders, and no more are open.
  thermal->orders.Push(control, {});
  return std::nullopt;
}

std::vector<ControlAnswer> CameraPair::TakeControlAnswers() {
  std::vector<ControlAnswer> answers;
  Member* const thermal = Thermal();
  if (thermal == nullptr) return answers;
  const bool ended = thermal->ended;  // First: then its thread has given all the answers it will.
  while (thermal->answers.size() > 0) answers.push_back(std::move(*thermal->answers.Pop({})));
  while (ended && thermal->orders.size() > 0) {
    answers.push_back({*thermal->orders.Pop({}), Unavailable("the thermal camera is closed")});
  }
  open_orders_ -= answers.size();
  return answers;
}

void CameraPair::Run(std::size_t index, const std::stop_token& stop) {
  NameThread("camera");
  Member& member = *members_[index];
  SupervisedSource& source = *member.camera.source;
  const Status opened = source.Open();
  member.opened.set_value({opened, opened.ok() ? source.rig() : std::nullopt, source.cameras()});
  const bool runs = member.may_run.get_future().get();
  if (runs && !opened.ok()) source.KeepTrying(opened);
  while (runs && !stop.stop_requested()) {
    PassOrders(member);
    // Before the first Read the camera is kept going and its frames thrown away, so that the scan
    // begins with fresh ones; a recording that waits must lose none.
    source.SetIdle(!reading_ && !waits_);
    Result<SourceItem> item = source.Read(stop);
    if (!item || std::holds_alternative<EndOfStream>(*item)) break;
    if (!std::holds_alternative<NothingYet>(*item)) queue_.Push(index, std::move(*item), stop);
  }
  source.Close();
  for (ControlAnswer& answer : source.TakeControlAnswers()) {
    member.answers.Push(std::move(answer), {});
  }
  // Behind the last answer, so that whoever sees it finds all answers in the queue
  // (TakeControlAnswers).
  member.ended = true;
  queue_.End(index);
}

void CameraPair::PassOrders(Member& member) {
  SupervisedSource& source = *member.camera.source;
  while (member.orders.size() > 0) {
    const CameraControl order = *member.orders.Pop({});
    if (std::optional<Status> answer = source.Control(order)) {
      member.answers.Push({order, std::move(*answer)}, {});
    }
  }
  for (ControlAnswer& answer : source.TakeControlAnswers()) {
    member.answers.Push(std::move(answer), {});
  }
}

}  // namespace isotherm
