// Milliseconds per frame and packed size of our codes and of the usual ones, on the real and
// rendered data that tests use (ISOTHERM_DATA_DIR, or ../shared/data beside the repository). Prints
// nothing for a data set that is not there.
#include <benchmark/benchmark.h>
#include <zstd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include "common/codec/codec.h"
#include "common/png/png.h"

namespace isotherm {
namespace {

using Pixels = Image<std::uint16_t>;
using Bytes = std::vector<std::uint8_t>;

std::filesystem::path DataFolder() {
  const char* const folder = std::getenv("ISOTHERM_DATA_DIR");
  return folder != nullptr ? folder : ISOTHERM_SOURCE_DIR "/../shared/data";
}

/// Some frames from all over the sequence, so that one run takes seconds.
std::vector<Pixels> Load(const std::string& data_set, const std::string& stream) {
  constexpr std::size_t kFrames = 30;
  const std::filesystem::path folder = DataFolder() / data_set;
  std::ifstream list(folder / (stream + ".txt"));
  std::vector<std::string> names;
  for (std::string line; std::getline(list, line);) {
    std::istringstream fields(line);
    std::string time;
    std::string name;
    if (line.starts_with('#') || !(fields >> time >> name)) continue;
    names.push_back(name);
  }
  std::vector<Pixels> frames;
  for (std::size_t i = 0; i < kFrames && !names.empty(); ++i) {
    std::ifstream file(folder / names[i * names.size() / kFrames], std::ios::binary);
    const Bytes bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const Result<PngHead> head = ReadPngHead(bytes);
    if (!head) continue;
    Pixels frame(static_cast<int>(head->width), static_cast<int>(head->height));
    if (DecodeGrey16Png(bytes, frame).ok()) frames.push_back(std::move(frame));
  }
  return frames;
}

/// The least of some repetitions: what a busy machine disturbs least.
double Least(const std::vector<double>& times) {
  return *std::min_element(times.begin(), times.end());
}

void Configure(benchmark::internal::Benchmark* benchmark) {
  constexpr int kRepetitions = 7;
  benchmark->Unit(benchmark::kMillisecond)
      ->MinTime(0.1)
      ->Repetitions(kRepetitions)
      ->ReportAggregatesOnly()
      ->ComputeStatistics("least", Least);
}

struct Candidate {
  std::string name;
  std::function<EncodedImage(const Pixels&)> encode;
  std::function<void(const EncodedImage&)> decode;
};

EncodedImage Packed(const Pixels& image, Bytes payload) {
  return {.encoding = Encoding::kRaw16,
          .width = image.width(),
          .height = image.height(),
          .payload = std::move(payload)};
}

Bytes Zstd(const void* data, std::size_t size, int level) {
  Bytes packed(ZSTD_compressBound(size));
  packed.resize(ZSTD_compress(packed.data(), packed.size(), data, size, level));
  return packed;
}

void UnZstd(const EncodedImage& image) {
  Pixels pixels(image.width, image.height);
  benchmark::DoNotOptimize(ZSTD_decompress(pixels.data(), pixels.size() * 2, image.payload.data(),
                                           image.payload.size()));
}

/// Differences to the western neighbour, low and high bytes apart.
Bytes DeltaPlanes(const Pixels& image) {
  Bytes planes(image.size() * 2);
  std::uint16_t previous = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const auto difference = static_cast<std::uint16_t>(image.data()[i] - previous);
    previous = image.data()[i];
    const auto folded = static_cast<std::uint16_t>(difference << 1 ^ -(difference >> 15));
    planes[i] = static_cast<std::uint8_t>(folded);
    planes[image.size() + i] = static_cast<std::uint8_t>(folded >> 8);
  }
  return planes;
}

/// Run lengths of holes and of pixels, differences in nibbles of 3 bits and a flag (Wilson, "Fast
/// Lossless Depth Image Compression", ISS 2017).
class Rvl {
 public:
  Bytes Encode(const Pixels& image) {
    out_.clear();
    nibbles_ = 0;
    int previous = 0;
    const std::span<const std::uint16_t> pixels = image.pixels();
    for (std::size_t i = 0; i < pixels.size();) {
      std::size_t end = i;
      while (end < pixels.size() && pixels[end] == 0) ++end;
      Put(end - i);
      i = end;
      while (end < pixels.size() && pixels[end] != 0) ++end;
      Put(end - i);
      for (; i < end; ++i) {
        const int difference = pixels[i] - previous;
        Put(static_cast<std::size_t>(difference << 1 ^ difference >> 31));
        previous = pixels[i];
      }
    }
    return out_;
  }

 private:
  void Put(std::size_t value) {
    do {
      const std::size_t nibble = (value & 7) | (value > 7 ? 8 : 0);
      if (nibbles_++ % 2 == 0) {
        out_.push_back(static_cast<std::uint8_t>(nibble));
      } else {
        out_.back() = static_cast<std::uint8_t>(out_.back() | nibble << 4);
      }
      value >>= 3;
    } while (value != 0);
  }

  Bytes out_;
  std::size_t nibbles_ = 0;
};

Candidate Png() {
  return {"png",
          [](const Pixels& image) {
            EncodedImage encoded = Packed(image, *EncodeGrey16Png(image));
            encoded.encoding = Encoding::kPng16;
            return encoded;
          },
          [](const EncodedImage& image) { benchmark::DoNotOptimize(Decode(image)); }};
}

std::vector<Candidate> Candidates(bool depth) {
  const auto decode = [](const EncodedImage& image) { benchmark::DoNotOptimize(Decode(image)); };
  std::vector<Candidate> candidates;
  if (depth) {
    candidates.push_back(
        {"isotherm",
         [e = std::make_shared<DepthEncoder>()](const Pixels& i) { return e->Encode(i); }, decode});
  } else {
    candidates.push_back({"isotherm",
                          [e = std::make_shared<ThermalEncoder>()](const Pixels& i) {
                            return e->Encode(i, kCentikelvin);
                          },
                          decode});
  }
  candidates.push_back(
      {"zstd_1",
       [](const Pixels& image) { return Packed(image, Zstd(image.data(), image.size() * 2, 1)); },
       UnZstd});
  candidates.push_back({"delta_planes_zstd_1",
                        [](const Pixels& image) {
                          const Bytes planes = DeltaPlanes(image);
                          return Packed(image, Zstd(planes.data(), planes.size(), 1));
                        },
                        UnZstd});
  if (depth) {
    candidates.push_back(
        {"rvl", [](const Pixels& image) { return Packed(image, Rvl().Encode(image)); }, nullptr});
    candidates.push_back({"rvl_zstd_1",
                          [](const Pixels& image) {
                            const Bytes rvl = Rvl().Encode(image);
                            return Packed(image, Zstd(rvl.data(), rvl.size(), 1));
                          },
                          nullptr});
  }
  candidates.push_back(Png());
  return candidates;
}

void Register(const std::string& data_set, const std::string& stream) {
  const auto frames = std::make_shared<std::vector<Pixels>>(Load(data_set, stream));
  if (frames->empty()) return;
  for (const Candidate& candidate : Candidates(stream == "depth")) {
    std::vector<EncodedImage> packed;
    double packed_bytes = 0;
    double raw_bytes = 0;
    for (const Pixels& frame : *frames) {
      packed_bytes +=
          static_cast<double>(packed.emplace_back(candidate.encode(frame)).payload.size());
      raw_bytes += static_cast<double>(frame.size() * sizeof(std::uint16_t));
    }
    const double percent = 100 * packed_bytes / raw_bytes;
    const std::string name = data_set + "/" + stream + "/" + candidate.name;
    const auto run = [percent, frames](benchmark::State& state, const auto& work) {
      for (std::size_t i = 0; auto _ : state) work(i++ % frames->size());
      state.counters["percent_of_raw"] = percent;
    };
    Configure(benchmark::RegisterBenchmark(
        ("BM_Encode/" + name).c_str(), [run, candidate, frames](benchmark::State& state) {
          run(state,
              [&](std::size_t i) { benchmark::DoNotOptimize(candidate.encode((*frames)[i])); });
        }));
    if (!candidate.decode) continue;
    Configure(benchmark::RegisterBenchmark(
        ("BM_Decode/" + name).c_str(), [run, candidate, packed](benchmark::State& state) {
          run(state, [&](std::size_t i) { candidate.decode(packed[i]); });
        }));
  }
}

}  // namespace
}  // namespace isotherm

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  isotherm::Register("furnace_dev", "depth");
  isotherm::Register("furnace_dev", "thermal");
  isotherm::Register("kinect_kitchen", "depth");
  isotherm::Register("optris_desk", "thermal");
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
