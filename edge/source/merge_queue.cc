#include "edge/source/merge_queue.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"

namespace isotherm {
namespace {

CaptureTime ArrivalOf(const SourceItem& item) {
  const auto* frame = std::get_if<RawFrame>(&item);
  return frame ? frame->arrival_wall : CaptureTime{};  // Anything else goes first.
}

}  // namespace

MergeQueue::MergeQueue(std::size_t cameras, std::size_t capacity, OverflowPolicy policy,
                       std::function<void(Sensor)> on_drop)
    : cameras_(cameras), capacity_(capacity), policy_(policy), on_drop_(std::move(on_drop)) {
  CHECK(cameras > 0 && cameras <= kMaxCameras && capacity > 0);
}

void MergeQueue::Push(std::size_t camera, SourceItem item, const std::stop_token& stop) {
  CHECK(camera < cameras_);
  MutexLock lock(mutex_);
  CameraQueue& queue = queues_[camera];
  if (policy_ == OverflowPolicy::kBlock) {
    // At the end it may hold one more: what was captured is not lost.
    changed_.wait(lock, stop, [&] { return queue.items.size() < capacity_; });
  } else if (queue.items.size() == capacity_) {
    if (const auto* frame = std::get_if<RawFrame>(&queue.items.front())) on_drop_(frame->sensor);
    queue.items.pop_front();
  }
  queue.items.push_back(std::move(item));
  changed_.notify_all();
}

void MergeQueue::End(std::size_t camera) {
  MutexLock lock(mutex_);
  queues_[camera].ended = true;
  changed_.notify_all();
}

SourceItem MergeQueue::Pop(Nanoseconds timeout, const std::stop_token& stop) {
  MutexLock lock(mutex_);
  changed_.wait_for(lock, stop, timeout,
                    [this]() REQUIRES(mutex_) { return Next() != nullptr || AllEnded(); });
  CameraQueue* queue = Next();
  if (queue == nullptr) return AllEnded() ? SourceItem(EndOfStream{}) : SourceItem(NothingYet{});
  SourceItem item = std::move(queue->items.front());
  queue->items.pop_front();
  changed_.notify_all();
  return item;
}

MergeQueue::CameraQueue* MergeQueue::Next() {
  CameraQueue* next = nullptr;
  for (CameraQueue& queue : queues_) {
    if (queue.items.empty()) continue;
    // Only the frames at the fronts are compared: an empty queue is not waited for, since its
    // camera may be gone. So order of arrival holds as far as both deliver in time.
    if (next == nullptr || ArrivalOf(queue.items.front()) < ArrivalOf(next->items.front())) {
      next = &queue;
    }
  }
  return next;
}

bool MergeQueue::AllEnded() const {
  return std::all_of(queues_.begin(), queues_.begin() + static_cast<std::ptrdiff_t>(cameras_),
                     [](const CameraQueue& queue) { return queue.ended; });
}

}  // namespace isotherm
