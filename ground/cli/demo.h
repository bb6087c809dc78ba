#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "ground/evaluation/result_evaluation.h"

namespace isotherm {

/// Says what a demo scans and where its files go.
struct DemoRequest {
  std::string scene = "furnace-door";
  double duration_s = 20.0;
  std::filesystem::path output = "out/demo";
  double rate = 0.0;  ///< 1 = real time, 0 = as fast as this computer reconstructs.
  int domain = 0;
};

/// Frames of one sensor on their way through the link.
struct DemoCounters {
  std::uint64_t simulated = 0;
  std::uint64_t arrived = 0;  ///< In the ground's recording.
};

/// Holds what came through the link and how near the result is to the truth.
struct DemoReport {
  std::filesystem::path simulated_recording;
  DemoCounters depth, thermal;
  EvaluationReport evaluation;
};

/// Simulates a scan (cached), lets isotherm-edge and isotherm-ground carry and reconstruct it as
/// processes of their own over DDS on loopback, and compares the result with the simulation's
/// truth.
Result<DemoReport> RunDemo(const DemoRequest& request, std::stop_token stop);

std::string ToText(const DemoReport& report, const std::filesystem::path& output);

}  // namespace isotherm
