#include "common/transport/announced_peers.h"

#include <dds/dds.h>
#include <fmt/format.h>

#include <array>
#include <string_view>

#include "common/transport/peer_guid.h"

namespace isotherm {

Status AnnouncedPeers::Open(const Participant& participant) {
  reader_ = DdsHandle(
      dds_create_reader(participant.handle(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr));
  if (reader_.value() > 0) return OkStatus();
  return Internal(
      fmt::format("cannot look for other participants: {}", dds_strretcode(reader_.value())));
}

std::map<PeerHandle, Announcement> AnnouncedPeers::Of(Role role) const {
  std::map<PeerHandle, Announcement> peers;
  // Whoever floods the domain with participants hides others from this watch.
  constexpr std::size_t kMaxPeers = 256;
  std::array<void*, kMaxPeers> samples{};
  std::array<dds_sample_info_t, kMaxPeers> infos{};
  const dds_return_t count =
      dds_read_mask(reader_.value(), samples.data(), infos.data(), kMaxPeers, kMaxPeers,
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (dds_return_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!infos[at].valid_data) continue;
    const auto& sample = *static_cast<const dds_builtintopic_participant_t*>(samples[at]);
    void* text = nullptr;
    std::size_t size = 0;
    if (sample.qos == nullptr || !dds_qget_userdata(sample.qos, &text, &size)) continue;
    const auto announcement =
        ParseAnnouncement({static_cast<const char*>(text), text == nullptr ? 0 : size});
    dds_free(text);
    if (announcement && announcement->role == role)
      peers.emplace(PeerOfGuid(sample.key), *announcement);
  }
  if (count > 0) static_cast<void>(dds_return_loan(reader_.value(), samples.data(), count));
  return peers;
}

}  // namespace isotherm
