// Thousands of random histories of a link and of the daemons at its ends, in virtual time: packets
// that get lost, late, doubled and out of order, outages, links that are too narrow, and both
// daemons killed and started again at any moment.
#include <gtest/gtest.h>

#include <iostream>

#include "common/base/log.h"
#include "common/testing/sanitizers.h"
#include "common/testing/temporary_directory.h"
#include "common/testing/test_seed.h"
#include "edge/daemon/resume_scan.h"
#include "tests/link/link_history.h"

namespace isotherm::link_test {
namespace {

using namespace std::chrono_literals;

constexpr unsigned kHistories =
    testing::kAddressSanitizer || testing::kThreadSanitizer ? 300 : 10'000;
constexpr unsigned kParts = 2;  ///< These may run at the same time.
constexpr const char* kRig = "rig7";
constexpr Nanoseconds kStep = 20ms;
constexpr std::array<Nanoseconds, 2> kPeriods = {100ms, 80ms};  // By Sensor.
constexpr Nanoseconds kFlushInterval = 1s;
/// A ground that lost much, over a link that loses a tenth, has all after this at the latest.
constexpr Nanoseconds kMaxEnd = 300s;

/// Counts what happened to the scan so far, whoever did it.
struct Account {
  std::array<std::map<std::uint64_t, CaptureTime>, 2> captured;  ///< By number.
  std::uint64_t sent_again = 0;
};

/// The edge's process from its start to its end.
class EdgeEnd {
 public:
  EdgeEnd(const std::filesystem::path& record, FakeClock& clock, LossyWay<AnyFrame>& way,
          std::mt19937& random, Account& account)
      : record_(record),
        clock_(clock),
        random_(random),
        account_(account),
        link_(clock, way, random) {
    options_.mutable_source()->set_kind(CAMERAS);
    options_.mutable_source()->set_rig_file("rig.textproto");
    options_.mutable_spool()->set_record(record_);
    options_.mutable_link()->set_edge_id(kRig);
    session_.time = clock_.Now();
    session_.rig = ARig();
    const auto before = FindScanToResume(options_, session_);
    SessionBefore published;
    if (before) {
      Resume(*before, session_);
      CountBefore(*before, session_, counters_);
      published = PublishedBy(*before, session_);
      parts_ = before->parts;
    }
    next_ = session_.first_numbers;
    static_cast<void>(link_.BeginSession({}, published));
    spool_.emplace(SpoolParts{[this] { return NextFile(); },
                              [] { return Result<std::uint64_t>(std::uint64_t{1} << 40U); },
                              options_.spool(),
                              clock_,
                              counters_,
                              {},
                              before ? &*before : nullptr});
    backfill_.emplace(
        BackfillOptions{.frames_per_s = 400.0, .patience = 200s, .waits_for_ground = true},
        BackfillParts{link_, spool_->recorded_frames(), counters_, clock_,
                      [this] { return is_narrow; }});
  }

  /// Ends as a process ends that is killed: of its newest file stays what has been flushed.
  void Kill() {
    account_.sent_again += link_.backfilled();
    const std::filesystem::path file = PartPath(record_, parts_);
    const std::filesystem::path copy = file.string() + ".killed";
    std::error_code missing;
    std::filesystem::copy_file(file, copy, missing);
    backfill_.reset();
    spool_.reset();
    std::filesystem::remove(file);
    if (!missing) std::filesystem::rename(copy, file);
  }
  void End() {
    EXPECT_TRUE(spool_->Close().ok());
    backfill_->NoteEnd();
    account_.sent_again += link_.backfilled();
  }

  void Capture() {
    for (const Sensor sensor : kSensors) {
      Nanoseconds& due = due_.at(IndexOf(sensor));
      if ((due -= kStep) > Nanoseconds(0)) continue;
      due += kPeriods.at(IndexOf(sensor));
      const std::uint64_t number = next_.at(IndexOf(sensor))++;
      const FrameHeader header{
          .session = session(), .frame_number = number, .capture_time = clock_.Now()};
      const bool is_new =
          account_.captured.at(IndexOf(sensor)).emplace(number, header.capture_time).second;
      EXPECT_TRUE(is_new) << "frame number " << number << " for a second frame";
      Add(sensor, header);
    }
    spool_->Tend(/*idle=*/false);
  }
  void Step() {
    while (backfill_->Step()) {
    }
  }

  EdgeLink& link() { return link_; }
  const EdgeLink& link() const { return link_; }
  std::uint64_t session() const { return session_.session(); }
  bool is_settled() const { return backfill_->is_settled(); }
  std::uint64_t lacking() const { return backfill_->lacking(); }
  /// Returns how many numbers of the scan so far are said not to be recorded.
  std::uint64_t lost(Sensor sensor) const { return counters_.Get(sensor).lost_by_restart; }
  int parts() const { return parts_; }

  bool is_narrow = false;  ///< Every second live frame finds no room.

 private:
  static Rig ARig() {
    Rig rig;
    rig.depth =
        CameraModel{.width = 64, .height = 48, .fx = 60.0, .fy = 60.0, .cx = 31.5, .cy = 23.5};
    return rig;
  }
  /// As RecordingFiles, but quick: nothing waits for the disk.
  Result<RecordingFile> NextFile() {
    parts_ = NextFreePart(record_, parts_);
    const std::filesystem::path path = PartPath(record_, parts_);
    Result<std::unique_ptr<RecordingWriter>> writer =
        RecordingWriter::Create(path, {.flush_interval = kFlushInterval, .sync = false});
    if (!writer) return Err(writer.error());
    Status described = (*writer)->Write(*session_.rig);
    if (described.ok()) {
      const auto metadata = RecordingMetadata(options_, session_);
      const std::string name(kScanMetadata);
      described = (*writer)->WriteMetadata(name, metadata.at(name));
    }
    if (!described.ok()) return Err(described);
    return RecordingFile{path, std::move(*writer)};
  }
  void Add(Sensor sensor, const FrameHeader& header) {
    const EncodedImage image{
        .encoding = Encoding::kRaw16, .width = 1, .height = 1, .payload = {0x77, 0x74}};
    if (sensor == Sensor::kDepth) {
      EncodedDepthFrame frame;
      frame.header = header;
      frame.depth_scale = 1000.0;
      frame.image = image;
      Add(frame);
    } else {
      EncodedThermalFrame frame;
      frame.header = header;
      frame.image = image;
      Add(frame);
    }
  }
  template <typename Frame>
  void Add(const Frame& frame) {
    spool_->Add(EncodedFrame{frame, frame.header.capture_time});
    const bool has_room = !is_narrow || random_() % 2 == 0;
    if (has_room) static_cast<void>(link_.Publish(frame, {}));
  }

  const std::filesystem::path record_;
  FakeClock& clock_;
  std::mt19937& random_;
  Account& account_;
  EdgeLink link_;
  EdgeSession session_;
  int parts_ = 0;
  std::array<std::uint64_t, 2> next_{};
  std::array<Nanoseconds, 2> due_{};
  EdgeOptions options_;
  FrameCounters counters_;
  std::optional<Spool> spool_;
  std::optional<Backfill> backfill_;
};

/// One history.
class History {
 public:
  History(const std::filesystem::path& record, unsigned seed)
      : record_(record), random_(seed), clock_(CaptureTime(1'700'000'000s)) {
    edge_.emplace(record_, clock_, way_, random_, account_);
    ground_.emplace(clock_);
  }

  void Run() {
    Pass(2500ms);  // Something of the scan is recorded.
    for (int part = 0; part < 8; ++part) {
      Happen();
      Pass(100ms * (1 + random_() % 15));
    }
    way_.carries = back_.carries = true;
    way_.loss = back_.loss = Chance(2) ? 0.0 : 0.1;
    if (!edge_) edge_.emplace(record_, clock_, way_, random_, account_);
    edge_->is_narrow = false;
    Pass(200ms);
    edge_->End();
    is_capturing_ = false;
    for (Nanoseconds passed{0}; passed < kMaxEnd && !edge_->is_settled(); passed += 1s) Pass(1s);
    Expect();
  }

 private:
  bool Chance(unsigned one_in) { return random_() % one_in == 0; }

  void Happen() {
    way_.carries = !Chance(4);
    back_.carries = way_.carries && !Chance(8);
    way_.loss = Chance(2) ? 0.0 : 0.001 * static_cast<double>(random_() % 300);
    way_.doubled = Chance(3) ? 0.1 : 0.0;
    way_.delay = 1ms * (1 + random_() % 150);
    back_.loss = way_.loss;
    back_.delay = way_.delay;
    if (Chance(6)) {
      // With its recording, or with an empty disk.
      GroundEnd::Recording on_disk = Chance(3) ? GroundEnd::Recording() : ground_->Kill();
      ground_.emplace(clock_, std::move(on_disk), 100ms * (random_() % 10));
      ++grounds_;
    }
    if (edge_ && Chance(4)) {
      edge_->Kill();
      edge_.reset();
      clock_.Advance(100ms * (random_() % 50));
      if (Chance(3)) Pass(500ms);  // The ground is alone.
    }
    if (!edge_) {
      edge_.emplace(record_, clock_, way_, random_, account_);
      ++edges_;
    }
    edge_->is_narrow = Chance(5);
  }

  void Pass(Nanoseconds time) {
    for (Nanoseconds passed{0}; passed < time; passed += kStep) {
      if (edge_) {
        if (is_capturing_) edge_->Capture();
        edge_->Step();
      }
      for (const AnyFrame& frame : way_.Arrived(clock_.SteadyNow())) ground_->Take(frame);
      // The rig announces its session; the ground knows no other one.
      if (edge_) session_ = edge_->session();
      if (const std::optional<Receipt> receipt = ground_->Step(session_))
        back_.Send(*receipt, clock_.SteadyNow(), random_);
      for (const Receipt& receipt : back_.Arrived(clock_.SteadyNow())) {
        if (!edge_) continue;
        EXPECT_EQ(receipt.session, edge_->session()) << "the scan goes on";
        EXPECT_TRUE(edge_->link().TakeReceipt(receipt)) << "an honest ground was not believed";
      }
      clock_.Advance(kStep);
    }
  }

  /// Returns the numbers that the rig's files have, read one by one.
  std::array<std::set<std::uint64_t>, 2> Recorded() const {
    std::array<std::set<std::uint64_t>, 2> recorded;
    for (int part = 1; part <= edge_->parts(); ++part) {
      const auto reader = RecordingReader::Open(PartPath(record_, part));
      if (!reader) continue;
      for (auto item = (*reader)->Next(); item && *item; item = (*reader)->Next()) {
        if (const auto* depth = std::get_if<RecordedDepth>(&**item))
          recorded[0].insert(depth->frame.header.frame_number);
        if (const auto* thermal = std::get_if<RecordedThermal>(&**item))
          recorded[1].insert(thermal->frame.header.frame_number);
      }
    }
    return recorded;
  }

  void Expect() const {
    EXPECT_TRUE(edge_->is_settled());
    EXPECT_EQ(edge_->lacking(), 0U);
    const std::array<std::set<std::uint64_t>, 2> recorded = Recorded();
    std::uint64_t frames = 0;
    for (const Sensor sensor : kSensors) {
      const auto& captured = account_.captured.at(IndexOf(sensor));
      const auto& has = recorded.at(IndexOf(sensor));
      const GroundEnd::Used& used = ground_->used(sensor);
      std::set<std::uint64_t> got;
      for (const auto* list : {&used.live, &used.late}) {
        for (const FrameHeader& header : *list) {
          EXPECT_TRUE(got.insert(header.frame_number).second) << "used twice";
          const auto sent = captured.find(header.frame_number);
          ASSERT_NE(sent, captured.end()) << "a frame that nobody captured";
          EXPECT_EQ(header.capture_time, sent->second) << "a wrong frame";
        }
      }
      // A frame that came once more before it was known to be recorded is in two files.
      for (const auto& [number, header] : ground_->before(sensor)) {
        const auto sent = captured.find(number);
        ASSERT_NE(sent, captured.end()) << "a frame that nobody captured";
        EXPECT_EQ(header.capture_time, sent->second) << "a wrong frame";
        got.insert(number);
      }
      EXPECT_TRUE(std::ranges::is_sorted(used.live, {}, &FrameHeader::frame_number));
      EXPECT_TRUE(std::ranges::is_sorted(used.live, {}, &FrameHeader::capture_time));
      std::uint64_t nowhere = 0;
      for (const auto& [number, time] : captured) {
        EXPECT_TRUE(got.contains(number) || !has.contains(number))
            << "recorded and not on the ground: " << number;
        if (!has.contains(number)) ++nowhere;
      }
      EXPECT_LE(nowhere, edge_->lost(sensor)) << "not recorded, and not counted";
      EXPECT_LE(nowhere, edges_ * (kFlushInterval / kPeriods.at(IndexOf(sensor)) + 1))
          << "more than was not flushed";
      const PublisherStats stats = edge_->link().stats();
      const StreamPublished& sent = sensor == Sensor::kDepth ? stats.depth : stats.thermal;
      EXPECT_GE(sent.published, got.size()) << "the ground has what was not published";
      frames += captured.size();
    }
    // What is sent again, and what is live for as long as a packet may take.
    // An edge that is started at once may send while packets of the one before are under way.
    constexpr std::size_t kMaxAtOnce = 2 * kMaxFlowWindowFrames + 16;
    EXPECT_LE(way_.most_under_way(), kMaxAtOnce) << "in the network at once";
    EXPECT_LE(ground_->most_held(), kMaxAtOnce) << "waiting for others";
    // A receipt may be older than what is under way: some frames come twice, never many.
    EXPECT_LE(account_.sent_again, (2 + grounds_ + edges_) * frames);
  }

  const std::filesystem::path record_;
  std::mt19937 random_;
  FakeClock clock_;
  Account account_;
  LossyWay<AnyFrame> way_;
  LossyWay<Receipt> back_;
  std::optional<EdgeEnd> edge_;
  std::optional<GroundEnd> ground_;
  std::uint64_t session_ = 0;
  bool is_capturing_ = true;
  std::uint64_t grounds_ = 0;  ///< Started again.
  std::uint64_t edges_ = 0;
};

class LinkHistoryTest : public ::testing::TestWithParam<unsigned> {};
INSTANTIATE_TEST_SUITE_P(Parts, LinkHistoryTest, ::testing::Range(0U, kParts));

TEST_P(LinkHistoryTest, WhateverHappensTheGroundGetsAllThatIsRecordedOnceAndInOrder) {
  SetLogLevel(LogLevel::kError);
  const std::uint32_t seed = testing::Seed();
  const testing::TemporaryDirectory folder;
  for (unsigned i = GetParam(); i < kHistories && !HasFailure(); i += kParts) {
    SCOPED_TRACE("history " + std::to_string(i) + " of seed " + std::to_string(seed));
    const std::filesystem::path own = folder.path() / std::to_string(i);
    History(own / "scan.mcap", seed + i).Run();
    std::filesystem::remove_all(own);
  }
  SetLogLevel(LogLevel::kInfo);
}

}  // namespace
}  // namespace isotherm::link_test
