#include "src/app/statistics_json.h"

#include <nlohmann/json.hpp>

#include "sheaf/version.h"
#include "src/app/json_text.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

Json SecondsJson(const FrameRecord& frame) {
  Json seconds = {{"wall", frame.stats.wall_seconds}, {"compile", frame.stats.compile_seconds}};
  // The scalar baseline traces ray by ray and has no phases to time.
  if (frame.options.target.is_scalar()) return seconds;
  Json& phases = seconds["phases"] = Json::object();
  for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
    phases[PhaseName(static_cast<Phase>(i))] = frame.stats.phase_seconds[i];
  }
  return seconds;
}

// Of the phases that run kernels.
Json LaneUseJson(const RenderStats& stats) {
  Json phases = Json::object();
  for (int i = 0; i < static_cast<int>(Phase::kCount); ++i) {
    const LaneUse& use = stats.lane_use[i];
    if (use.lanes == 0) continue;
    phases[PhaseName(static_cast<Phase>(i))] = {
        {"batches", use.batches},
        {"live", use.live},
        {"lanes", use.lanes},
        {"share", static_cast<double>(use.live) / static_cast<double>(use.lanes)}};
  }
  return phases;
}

Json RanksJson(const std::vector<RankRecord>& ranks) {
  Json json = Json::array();
  for (std::size_t rank = 0; rank < ranks.size(); ++rank) {
    const RankRecord& record = ranks[rank];
    json.push_back(
        {{"rank", rank},
         {"host", record.info.host},
         {"target", record.info.target},
         {"threads", record.info.threads},
         {"rays", record.stats.rays.traced()},
         {"seconds",
          {{"wall", record.stats.wall_seconds}, {"compile", record.stats.compile_seconds}}},
         {"idle", record.idle}});
  }
  return json;
}

Json FrameJson(const FrameRecord& frame) {
  const RenderOptions& options = frame.options;
  const RenderStats& stats = frame.stats;
  const double rays = static_cast<double>(stats.rays.traced());
  if (frame.is_kept) {
    Json kept = {{"camera", frame.camera}, {"picture", frame.picture}, {"kept", true}};
    if (frame.frame) kept["frame"] = *frame.frame;
    return kept;
  }
  Json json = {
      {"camera", frame.camera},
      {"picture", frame.picture},
      {"width", options.width},
      {"height", options.height},
      {"samples", options.samples},
      {"max_depth", options.max_depth},
      {"target", stats.target},
      {"precision", PrecisionName(options.precision)},
      {"threads", stats.threads},
      {"tile", options.tile_size},
      {"primitives",
       {{"total", stats.primitives},
        {"spheres", stats.spheres},
        {"triangles", stats.triangles},
        {"disks", stats.disks}}},
      {"rays",
       {{"primary", stats.rays.primary},
        {"shadow", stats.rays.shadow},
        {"reflected", stats.rays.reflected},
        {"refracted", stats.rays.refracted},
        {"diffuse", stats.rays.diffuse},
        {"beyond_depth", stats.rays.beyond_depth},
        {"traced", stats.rays.traced()}}},
      {"seconds", SecondsJson(frame)},
      {"rays_per_second", stats.wall_seconds > 0.0 ? rays / stats.wall_seconds : 0.0},
  };
  if (frame.frame) json["frame"] = *frame.frame;
  if (frame.resumed_rows > 0) json["resumed_rows"] = frame.resumed_rows;
  if (!options.target.is_scalar()) json["lane_use"] = LaneUseJson(stats);
  if (!frame.ranks.empty()) json["ranks"] = RanksJson(frame.ranks);
  if (options.integrator) json["integrator"] = IntegratorName(*options.integrator);
  if (options.error) json["error"] = *options.error;
  if (options.budget) json["budget"] = *options.budget;
  if (stats.reached.rounds > 0) {
    json["reached"] = {{"error", stats.reached.error},
                       {"rounds", stats.reached.rounds},
                       {"samples", stats.reached.samples}};
  }
  if (options.contrast) json["adaptive"] = *options.contrast;
  if (options.min_throughput > 0) json["min_weight"] = options.min_throughput;
  if (options.crop) {
    json["crop"] = {options.crop->x0, options.crop->y0, options.crop->x1, options.crop->y1};
  }
  return json;
}

}  // namespace

std::string StatisticsJson(const std::string& scene_path, const std::vector<FrameRecord>& frames) {
  Json json = {{"sheaf", kVersion}, {"scene", scene_path}, {"frames", Json::array()}};
  for (const FrameRecord& frame : frames) json["frames"].push_back(FrameJson(frame));
  return JsonText(json);
}

}  // namespace sheaf
