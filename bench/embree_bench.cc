// Sheaf beside Embree, in one process and in turn: rays, builds and growth with the number of
// triangles. docs/benchmarking.md says how to read the tables.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/compare_builds.h"
#include "bench/compare_places.h"
#include "bench/compare_tracers.h"
#include "bench/embree_peer.h"
#include "bench/make_scenes.h"
#include "bench/read_mesh.h"
#include "sheaf/target.h"
#include "src/core/running_target.h"

namespace sheaf::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kQuickSize = 256, kQuickPrimitives = 25'000;
// Larger scenes take part where they are asked for by name, and in --growth.
constexpr std::uint32_t kUsualPrimitives = 2'000'000;

enum class Table { kRays, kBuild, kGrowth, kPlaces };

struct Request {
  CompareOptions compare;
  PlaceOptions places;
  std::string scene;               // part of the name
  std::optional<BenchScene> mesh;  // of the user, instead of the catalogue's scenes
  std::uint32_t largest = kUsualPrimitives;
  Table table = Table::kRays;
  std::string json_path, chart_path;
};

std::vector<const SceneMaker*> ChooseScenes(const Request& request) {
  std::vector<const SceneMaker*> chosen;
  for (const SceneMaker& maker : SceneCatalogue()) {
    const std::string_view name = maker.name;
    const bool is_named = name == request.scene;
    if (name.find(request.scene) == std::string_view::npos) continue;
    if (request.table == Table::kGrowth && !name.starts_with("scan-")) continue;
    if (maker.primitives > request.largest && !is_named) continue;
    chosen.push_back(&maker);
  }
  return chosen;
}

// Calls run(scene) for the user's mesh or each scene of the catalogue that is asked for, which is
// made then and forgotten after it.
template <typename Run>
void ForEachScene(const Request& request, Run run) {
  if (request.mesh) return run(*request.mesh);
  for (const SceneMaker* maker : ChooseScenes(request)) {
    BenchScene scene = maker->make();
    scene.name = maker->name;
    run(scene);
  }
}

// ---- JSON ----

Json ToJson(const Comparison& comparison) {
  Json targets = Json::array();
  for (const TargetResult& result : comparison.targets) {
    const Differences& d = result.differences;
    targets.push_back({{"target", result.target},
                       {"mrays", result.mrays},
                       {"against_embree", result.against_embree},
                       {"against_scalar", result.against_scalar},
                       {"scalar_differences", result.scalar_differences},
                       {"embree_differences",
                        {{"embree_missed", d.embree_missed},
                         {"sheaf_missed", d.sheaf_missed},
                         {"other_t", d.other_t},
                         {"other_tie", d.other_tie}}}});
  }
  return {{"scene", comparison.scene},
          {"primitives", comparison.primitives},
          {"kind", NameOf(comparison.kind)},
          {"rays", comparison.rays},
          {"embree", {{"mrays", comparison.embree_mrays}, {"call", comparison.embree_method}}},
          {"scalar", {{"mrays", comparison.scalar_mrays}}},
          {"targets", targets}};
}

Json ToJson(const BuildComparison& comparison) {
  Json times = Json::array();
  for (const BuildTimes& t : comparison.times) {
    times.push_back({{"threads", t.threads},
                     {"embree_ms", t.embree},
                     {"sheaf_ms", t.sheaf},
                     {"sheaf_tree_ms", t.sheaf_tree},
                     {"against_embree", t.against_embree}});
  }
  return {{"scene", comparison.scene},
          {"primitives", comparison.primitives},
          {"times", times},
          {"embree_bytes_a_primitive", comparison.embree_bytes_a_primitive},
          {"sheaf_bytes_a_primitive", comparison.sheaf_bytes_a_primitive}};
}

// ---- Tables ----

void PrintRayHeader() {
  fmt::print("{:<16}{:<9}{:>9}  {:>8} {:<19}{:>8}  {:<11}{:>8}{:>9}{:>9}  {}\n", "scene", "rays",
             "count", "Embree", "call flag build", "scalar", "target", "Sheaf", "/Embree",
             "/scalar", "differ: Embree missed + Sheaf missed + other t + tie (scalar)");
}

void PrintRays(const Comparison& comparison) {
  std::string left = fmt::format("{:<16}{:<9}{:>9}  {:>8.2f} {:<19}{:>8.2f}", comparison.scene,
                                 NameOf(comparison.kind), comparison.rays, comparison.embree_mrays,
                                 comparison.embree_method, comparison.scalar_mrays);
  for (const TargetResult& result : comparison.targets) {
    const Differences& d = result.differences;
    fmt::print("{}  {:<11}{:>8.2f}{:>9.2f}{:>9.2f}  {}: {} + {} + {} + {} ({})\n", left,
               result.target, result.mrays, result.against_embree, result.against_scalar, d.total(),
               d.embree_missed, d.sheaf_missed, d.other_t, d.other_tie, result.scalar_differences);
    left.assign(left.size(), ' ');
  }
  std::fflush(stdout);
}

Json RunRays(const Request& request) {
  Json rows = Json::array();
  PrintRayHeader();
  ForEachScene(request, [&](const BenchScene& scene) {
    CompareTracers(scene, request.compare, [&](const Comparison& comparison) {
      PrintRays(comparison);
      rows.push_back(ToJson(comparison));
    });
  });
  return rows;
}

Json RunBuild(const Request& request) {
  Json rows = Json::array();
  fmt::print("{:<16}{:>11}{:>8}{:>12}{:>11}{:>11}{:>9}{:>13}{:>12}\n", "scene", "primitives",
             "threads", "Embree ms", "Sheaf ms", "tree ms", "/Embree", "Embree B/pr", "Sheaf B/pr");
  ForEachScene(request, [&](const BenchScene& scene) {
    const BuildComparison comparison = CompareBuilds(scene, request.compare.repetitions);
    for (const BuildTimes& t : comparison.times) {
      fmt::print("{:<16}{:>11}{:>8}{:>12.2f}{:>11.2f}{:>11.2f}{:>9.2f}{:>13.1f}{:>12.1f}\n",
                 comparison.scene, comparison.primitives, t.threads, t.embree, t.sheaf,
                 t.sheaf_tree, t.against_embree, comparison.embree_bytes_a_primitive,
                 comparison.sheaf_bytes_a_primitive);
    }
    std::fflush(stdout);
    rows.push_back(ToJson(comparison));
  });
  return rows;
}

Json RunPlaces(const Request& request) {
  Json rows = Json::array();
  fmt::print("{:<16}{:>9}{:>9}  {:<14}{:>9}  {:<26}{:>11}{:>11}\n", "scene", "moved", "scaled",
             "tracer", "rays", "off: hit-or-miss + other t", "median", "most of t");
  PlaceOptions options = request.places;
  options.picture_size = request.compare.picture_size;
  ForEachScene(request, [&](const BenchScene& scene) {
    ComparePlaces(scene, options, [&](const PlaceErrors& e) {
      const std::string off =
          fmt::format("{}: {} + {}", e.hit_or_miss + e.other_t, e.hit_or_miss, e.other_t);
      fmt::print("{:<16}{:>9g}{:>9g}  {:<14}{:>9}  {:<26}{:>11.2g}{:>11.2g}\n", scene.name, e.moved,
                 e.scaled, e.tracer, e.rays, off, e.median, e.most);
      rows.push_back({{"scene", scene.name},
                      {"moved", e.moved},
                      {"scaled", e.scaled},
                      {"tracer", e.tracer},
                      {"rays", e.rays},
                      {"hit_or_miss", e.hit_or_miss},
                      {"other_t", e.other_t},
                      {"median", e.median},
                      {"most", e.most}});
    });
  });
  return rows;
}

// Draws `table`, tab-separated with a line of names first, both axes logarithmic. Returns whether
// gnuplot was there and content.
bool DrawChart(const std::string& table, const std::string& path) {
  const std::string quoted = [&] {
    std::string result;
    for (const char c : path) result += c == '\'' ? std::string("''") : std::string(1, c);
    return result;
  }();
  std::FILE* gnuplot = popen("gnuplot", "w");
  if (gnuplot == nullptr) return false;
  const std::string script = fmt::format(
      "$table << EOD\n{}EOD\nset terminal svg size 800,500\nset output '{}'\n"
      "set logscale xy\nset grid\nset key left top\nset format x '%.0s%c'\n"
      "set xlabel 'triangles'\nset ylabel 'nanoseconds a primary ray'\n"
      "set datafile separator tab\n"
      "stats $table skip 1 nooutput\n"
      "plot for [i=2:int(STATS_columns)] $table using 1:i with linespoints title "
      "columnheader(i)\n",
      table, quoted);
  // Without gnuplot the shell ends at once, and a write to it must not end this program.
  std::signal(SIGPIPE, SIG_IGN);
  std::fputs(script.c_str(), gnuplot);
  return pclose(gnuplot) == 0;
}

Json RunGrowth(const Request& request) {
  Json rows = Json::array();
  std::string table = "triangles\tEmbree\tscalar";
  for (const std::string& target : request.compare.targets) table += "\t" + target;
  table += "\n";
  fmt::print("# nanoseconds a primary ray\n{}", table);
  ForEachScene(request, [&](const BenchScene& scene) {
    CompareTracers(scene, request.compare, [&](const Comparison& comparison) {
      std::string row = fmt::format("{}\t{:.2f}\t{:.2f}", comparison.primitives,
                                    1e3 / comparison.embree_mrays, 1e3 / comparison.scalar_mrays);
      for (const TargetResult& result : comparison.targets) {
        row += fmt::format("\t{:.2f}", 1e3 / result.mrays);
      }
      fmt::print("{}\n", row);
      std::fflush(stdout);
      table += row + "\n";
      rows.push_back(ToJson(comparison));
    });
  });
  if (!request.chart_path.empty() && !DrawChart(table, request.chart_path)) {
    fmt::print(stderr, "embree_bench: no chart, gnuplot is not there or failed\n");
  }
  return rows;
}

Json RunTable(const Request& request) {
  switch (request.table) {
    case Table::kBuild:
      return RunBuild(request);
    case Table::kGrowth:
      return RunGrowth(request);
    case Table::kPlaces:
      return RunPlaces(request);
    case Table::kRays:
      break;
  }
  return RunRays(request);
}

void PrintCatalogue() {
  for (const SceneMaker& maker : SceneCatalogue()) {
    fmt::print("{:<16}{:>10} primitives{}\n", maker.name, maker.primitives,
               maker.primitives > kUsualPrimitives ? ", if named or with --growth" : "");
  }
}

// ---- The command line ----

std::optional<std::vector<RayKind>> ParseKinds(const std::vector<std::string>& names) {
  std::vector<RayKind> kinds;
  for (const std::string& name : names) {
    const auto* kind = std::find_if(std::begin(kRayKinds), std::end(kRayKinds),
                                    [&](RayKind k) { return name == NameOf(k); });
    if (kind == std::end(kRayKinds)) return std::nullopt;
    kinds.push_back(*kind);
  }
  return kinds;
}

// "best" is the best usable target, "all" are all of them.
std::optional<std::vector<std::string>> ParseTargets(const std::vector<std::string>& names) {
  const std::vector<std::string> usable = UsableTargets();
  std::vector<std::string> targets;
  for (const std::string& name : names) {
    if (name == "all") return usable;
    const std::string& target = name == "best" ? usable.front() : name;
    if (std::find(usable.begin(), usable.end(), target) == usable.end()) return std::nullopt;
    targets.push_back(target);
  }
  return targets;
}

int Fail(const std::string& message) {
  fmt::print(stderr, "embree_bench: {}\n", message);
  return EXIT_FAILURE;
}

std::array<CLI::Option*, 2> AddPlaceOptions(CLI::App& app, PlaceOptions& places) {
  return {app.add_option("--moved", places.moved, "errors of t instead: scenes moved by these")
              ->delimiter(','),
          app.add_option("--scaled", places.scaled, "errors of t instead: scenes times these")
              ->delimiter(',')};
}

int Main(int argc, char** argv) {
  CLI::App app("Sheaf beside Embree: million rays a second, builds, growth", "embree_bench");
  Request request;
  bool lists = false, builds = false, grows = false, is_quick = false, no_hints = false;
  std::vector<std::string> targets = {"best"}, kinds = {"primary", "shadow", "mirror", "diffuse"};
  app.add_flag("--list", lists, "name the scenes");
  app.add_option("--scene", request.scene, "only scenes whose name contains this");
  std::string mesh_path;
  auto* mesh = app.add_option("--mesh", mesh_path, "a model or scene file instead of these scenes");
  app.add_option("--rays", kinds, "primary, shadow, mirror, diffuse")->delimiter(',');
  app.add_option("--target", targets, "Sheaf's targets; best, or all")->delimiter(',');
  app.add_option("--repetitions", request.compare.repetitions, "medians of this many runs (7)")
      ->check(CLI::Range(1, 1000));
  auto* build = app.add_flag("--build", builds, "the build table instead");
  app.add_option("--embree-isa", request.compare.embree_isa,
                 "what Embree may use: avx512, avx2, avx, sse4.2, sse2; the widest")
      ->check(CLI::IsMember({"avx512", "avx2", "avx", "sse4.2", "sse2"}))
      ->excludes(build);
  app.add_flag("--no-hints", no_hints, "do not tell Sheaf how coherent rays are");
  app.add_flag("--quick", is_quick, "256x256 rays and small scenes");
  auto* growth = app.add_flag("--growth", grows, "primary rays from 1k to 10M triangles, as TSV");
  build->excludes(growth);
  mesh->excludes(growth);
  for (CLI::Option* places : AddPlaceOptions(app, request.places)) {
    places->excludes(build)->excludes(growth);
  }
  app.add_option("--chart", request.chart_path, "draw --growth with gnuplot, as SVG")
      ->needs(growth);
  app.add_option("--json", request.json_path, "also write the results to this file");
  CLI11_PARSE(app, argc, argv);

  if (lists) {
    PrintCatalogue();
    return EXIT_SUCCESS;
  }
  const bool is_placed = !request.places.moved.empty() || !request.places.scaled.empty();
  request.table = builds      ? Table::kBuild
                  : grows     ? Table::kGrowth
                  : is_placed ? Table::kPlaces
                              : Table::kRays;
  if (grows) kinds = {"primary"}, request.largest = UINT32_MAX;
  if (is_quick) {
    request.compare.picture_size = kQuickSize;
    request.largest = kQuickPrimitives;
  }
  if (no_hints) request.compare.hints = Hints::kNone;
  const auto parsed_kinds = ParseKinds(kinds);
  if (!parsed_kinds) return Fail("--rays takes primary, shadow, mirror and diffuse");
  request.compare.kinds = *parsed_kinds;
  const auto parsed_targets = ParseTargets(targets);
  if (!parsed_targets) {
    return Fail(fmt::format("usable targets: {}", fmt::join(UsableTargets(), ", ")));
  }
  request.compare.targets = *parsed_targets;
  if (!mesh_path.empty()) {
    const MeshView view = is_placed ? MeshView::kCamera : MeshView::kFramed;
    Result<BenchScene> read = ReadMesh(mesh_path, view);
    if (!read) return Fail(read.error().message);
    request.mesh = std::move(read).value();
  } else if (ChooseScenes(request).empty())
    return Fail("no scene has such a name (--list)");

  const std::string embree =
      fmt::format("{} isa={}", RTC_VERSION_STRING, request.compare.embree_isa);
  fmt::print("# Embree {}; Sheaf on {}; medians of {}{}\n", embree,
             fmt::join(request.compare.targets, ", "), request.compare.repetitions,
             request.table == Table::kBuild ? "" : "; one thread, million rays a second");
  const Json rows = RunTable(request);
  if (!request.json_path.empty()) {
    std::ofstream file(request.json_path);
    file << Json{{"embree", embree},
                 {"targets", request.compare.targets},
                 {"repetitions", request.compare.repetitions},
                 {"rows", rows}}
                .dump(2)
         << "\n";
    if (!file.flush()) return Fail("cannot write " + request.json_path);
  }
  return EXIT_SUCCESS;
}

}  // namespace
}  // namespace sheaf::bench

int main(int argc, char** argv) { return sheaf::bench::Main(argc, argv); }
