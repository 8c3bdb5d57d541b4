#include "src/cluster/messages.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

#include "src/cluster/wire.h"
#include "src/core/parallel.h"
#include "src/core/running_target.h"

namespace sheaf {

std::string HostName() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

RankInfo RankInfoOf(const RenderOptions& options) {
  return {HostName(), RunningTarget(options.target), ThreadCount(options.threads)};
}

std::string Pack(const RankInfo& info) {
  WireWriter writer;
  writer.AddText(info.host);
  writer.AddText(info.target);
  writer.Add(info.threads);
  return writer.Take();
}

RankInfo UnpackInfo(std::string_view bytes) {
  WireReader reader(bytes);
  RankInfo info;
  info.host = reader.GetText();
  info.target = reader.GetText();
  info.threads = std::max(reader.Get<int>(), 1);
  return info;
}

std::string Pack(const FinishedArea& area) {
  WireWriter writer;
  writer.Add(area.area);
  writer.Add(area.pixels.width);
  writer.Add(area.pixels.height);
  writer.AddFloats(area.pixels.rgb);
  for (const Film::Floats& layer : area.pixels.layers) writer.AddFloats(layer);
  return writer.Take();
}

FinishedArea UnpackArea(std::string_view bytes) {
  WireReader reader(bytes);
  FinishedArea area;
  area.area = reader.Get<PixelRect>();
  area.pixels.width = reader.Get<int>();
  area.pixels.height = reader.Get<int>();
  reader.GetFloats(&area.pixels.rgb);
  for (Film::Floats& layer : area.pixels.layers) reader.GetFloats(&layer);
  return area;
}

std::string Pack(const RenderStats& stats) {
  WireWriter writer;
  writer.Add(stats.rays);
  writer.Add(stats.wall_seconds);
  writer.Add(stats.compile_seconds);
  writer.Add(stats.phase_seconds);
  writer.Add(stats.lane_use);
  writer.Add(stats.buffer_bytes);
  writer.Add(stats.threads);
  writer.AddText(stats.target);
  for (const std::uint32_t count :
       {stats.primitives, stats.spheres, stats.triangles, stats.disks}) {
    writer.Add(count);
  }
  return writer.Take();
}

RenderStats UnpackStats(std::string_view bytes) {
  WireReader reader(bytes);
  RenderStats stats;
  stats.rays = reader.Get<RayCounts>();
  stats.wall_seconds = reader.Get<double>();
  stats.compile_seconds = reader.Get<double>();
  for (double& seconds : stats.phase_seconds) seconds = reader.Get<double>();
  for (LaneUse& use : stats.lane_use) use = reader.Get<LaneUse>();
  stats.buffer_bytes = reader.Get<std::uint64_t>();
  stats.threads = reader.Get<int>();
  stats.target = reader.GetText();
  for (std::uint32_t* count : {&stats.primitives, &stats.spheres, &stats.triangles, &stats.disks}) {
    *count = reader.Get<std::uint32_t>();
  }
  return stats;
}

std::string Pack(const RankError& error) {
  WireWriter writer;
  writer.Add(error.kind ? static_cast<int>(*error.kind) : -1);
  writer.AddText(error.message);
  return writer.Take();
}

RankError UnpackError(std::string_view bytes) {
  WireReader reader(bytes);
  RankError error;
  const int kind = reader.Get<int>();
  if (kind >= 0) error.kind = static_cast<ErrorKind>(kind);
  error.message = reader.GetText();
  return error;
}

void Patience::Rest() {
  constexpr int kQuick = 20;
  const auto time = std::chrono::microseconds(rests_ < kQuick ? 50 : 2000);
  rests_ = std::min(rests_ + 1, kQuick);
  std::this_thread::sleep_for(time);
}

}  // namespace sheaf
