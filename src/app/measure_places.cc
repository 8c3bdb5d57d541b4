#include "src/app/measure_places.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <glm/geometric.hpp>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>
#include <variant>

#include "sheaf/target.h"
#include "sheaf/version.h"
#include "src/app/draw_chart.h"
#include "src/app/interrupt.h"
#include "src/app/json_text.h"
#include "src/app/print_message.h"
#include "src/app/render_timed.h"
#include "src/core/atomic_file.h"
#include "src/formats/printable.h"
#include "src/lab/has_program.h"
#include "src/lab/picture_metrics.h"
#include "src/lab/pov_ray.h"
#include "src/lab/rank_statistics.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

constexpr Precision kPlacePrecisions[] = {Precision::kStrict, Precision::kFast, Precision::kDouble};
constexpr char kPovRayName[] = "POV-Ray";

struct Place {
  double moved = 0, scaled = 1;
};

// Where the scene was made comes first.
std::vector<Place> ListPlaces(const ParetoRequest& request) {
  std::vector<Place> places = {{}};
  for (const double moved : request.moved) places.push_back({moved, 1});
  for (const double scaled : request.scaled) places.push_back({0, scaled});
  return places;
}

// A slanted way off, because one along an axis would leave two coordinates their bits.
Transform TransformTo(const Place& place) {
  Transform transform;
  transform.linear = glm::dmat3(place.scaled);
  transform.translation = glm::normalize(Vec3d(1, -1, 0.7)) * place.moved;
  return transform;
}

// The scene and its one camera, there. A lamp gives as much light as before.
Result<Scene> Placed(const Scene& scene, const Camera& camera, const Place& place) {
  Scene placed = scene;
  placed.cameras = {camera};
  placed.views.clear();  // which name cameras by number
  const std::string fault = TransformScene(TransformTo(place), &placed);
  if (!fault.empty()) return Error{ErrorKind::kScene, fault};
  for (Light& light : placed.lights) {
    if (PointLight* lamp = std::get_if<PointLight>(&light.source)) {
      lamp->falloff.linear /= place.scaled;
      lamp->falloff.quadratic /= place.scaled * place.scaled;
    }
  }
  return placed;
}

std::string PlaceName(const PlacePoint& point) {
  if (point.moved != 0) return fmt::format("moved {:g}", point.moved);
  return point.scaled == 1 ? "as made" : fmt::format("scaled {:g}", point.scaled);
}

std::string CsvText(const std::vector<PlacePoint>& points) {
  std::string text = "moved,scaled,precision,seconds,over,error\n";
  for (const PlacePoint& p : points) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{}\n", p.moved, p.scaled, p.precision,
                   p.seconds, p.over, p.error);
  }
  return text;
}

std::string ReportJson(const ParetoTitle& title, const std::vector<PlacePoint>& points) {
  nlohmann::ordered_json json = {{"sheaf", kVersion},
                                 {"scene", title.scene},
                                 {"camera", title.camera},
                                 {"width", title.width},
                                 {"height", title.height},
                                 {"threads", title.threads},
                                 {"repetitions", title.repetitions},
                                 {"points", nlohmann::ordered_json::array()}};
  for (const PlacePoint& p : points) {
    json["points"].push_back({{"moved", p.moved},
                              {"scaled", p.scaled},
                              {"precision", p.precision},
                              {"seconds", p.seconds},
                              {"over", p.over},
                              {"error", p.error}});
  }
  return JsonText(json);
}

// A name as gnuplot may have it.
std::string BlockName(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// Pixels above, milliseconds below, a line a precision.
Status DrawPlaces(const ParetoTitle& title, const std::vector<PlacePoint>& points,
                  const std::string& stem) {
  std::string data, above, below;
  std::vector<std::string> names;
  for (const PlacePoint& p : points) {
    if (std::find(names.begin(), names.end(), p.precision) == names.end()) {
      names.push_back(p.precision);
    }
  }
  for (const std::string& name : names) {
    data += fmt::format("${} << END\n", BlockName(name));
    for (const PlacePoint& p : points) {
      if (p.precision != name) continue;
      data += fmt::format("{} {} {}\n", GnuplotString(PlaceName(p)), p.over, 1e3 * p.seconds);
    }
    data += "END\n";
    const auto line = [&](const char* column) {
      return fmt::format("${} using {}:xtic(1) with linespoints title \"{}\", ", BlockName(name),
                         column, name);
    };
    above += line("2");
    below += line("3");
  }
  const std::string text =
      fmt::format("{}, {}, {}x{}", std::filesystem::path(title.scene).filename().string(),
                  title.camera, title.width, title.height);
  const std::string plot = fmt::format(
      "set multiplot layout 2,1 title {} noenhanced\n"
      "set yrange [0:*]\nset grid\nset key outside noenhanced\nset xtics noenhanced\n"
      "set ylabel \"pixels over 1/255\"\nplot {}\n"
      "set ylabel \"milliseconds a frame\"\nplot {}\nunset multiplot\n",
      GnuplotString(text), above, below);
  return DrawChart(data, plot, stem);
}

// The frames of every place, round by round.
class PlaceFrames {
 public:
  // `made`: what the others are compared with, the scene where it was made, in double.
  explicit PlaceFrames(Film made) : made_(std::move(made)) {}

  // The first of a place and a name has the error of all.
  void Add(const Place& place, const std::string& name, double seconds, const Film& film) {
    std::size_t at = 0;
    while (at < points_.size() && !IsOf(points_[at], place, name)) ++at;
    if (at == points_.size()) {
      const PictureMetrics metrics = MeasurePictures(made_, film, Transfer::kLinear);
      points_.push_back({place.moved, place.scaled, name, 0, metrics.over, metrics.rmse});
      seconds_.emplace_back();
    }
    seconds_[at].push_back(seconds);
  }

  std::vector<PlacePoint> Points() {
    for (std::size_t i = 0; i < points_.size(); ++i) points_[i].seconds = Median(seconds_[i]);
    return points_;
  }

 private:
  static bool IsOf(const PlacePoint& point, const Place& place, const std::string& name) {
    return point.moved == place.moved && point.scaled == place.scaled && point.precision == name;
  }

  Film made_;
  std::vector<PlacePoint> points_;
  std::vector<std::vector<double>> seconds_;
};

}  // namespace

Result<std::vector<PlacePoint>> MeasurePlaces(const ParetoRequest& request, const Scene& scene,
                                              const Camera& camera, const RenderOptions& base,
                                              int repetitions) {
  RenderOptions options = base;
  options.samples = 1;
  bool has_peer = HasPovRay() && std::holds_alternative<Perspective>(camera.projection);
  options.precision = Precision::kDouble;
  const Result<TimedFrame> exact = RenderTimed(scene, camera, options);
  if (!exact) return exact.error();
  PlaceFrames frames(exact.value().film);
  const std::vector<Place> places = ListPlaces(request);
  StepWatch watch(
      StyleOf(request), fmt::format("{}: places", Printable(camera.name)),
      static_cast<std::size_t>(repetitions) * places.size() * std::size(kPlacePrecisions));
  // Round by round over all places, because a machine's clock drifts. The first has the errors.
  for (int round = 0; round < repetitions; ++round) {
    for (const Place& place : places) {
      const Result<Scene> placed = Placed(scene, camera, place);
      if (!placed) return placed.error();
      const Camera& eye = placed.value().cameras[0];
      for (const Precision precision : kPlacePrecisions) {
        options.precision = precision;
        const Result<TimedFrame> timed = RenderTimed(placed.value(), eye, options);
        if (!timed) return timed.error();
        watch.Advance();
        frames.Add(place, PrecisionName(precision), timed.value().seconds, timed.value().film);
      }
      if (!has_peer) continue;
      const Result<PovRender> peer = RenderWithPovRay(placed.value(), eye, options.width,
                                                      options.height, "-A", PovPicture::kRead);
      if (const Status going = CheckInterrupted(); !going) return going.error();
      if (!peer) {
        PrintMessage(fmt::format("sheaf: {}; the report goes on without it", peer.error().message));
        has_peer = false;
        continue;
      }
      frames.Add(place, kPovRayName, peer.value().seconds, peer.value().film);
    }
  }
  return frames.Points();
}

std::string PlaceText(const PlacePoint& point) {
  return fmt::format(
      "moved by {:<8g} scaled by {:<8g} {:7} {:>9.2f} ms  {} pixels over 1/255, {:.2g}\n",
      point.moved, point.scaled, point.precision, 1e3 * point.seconds, point.over, point.error);
}

Result<std::vector<std::string>> WritePlaceReport(const ParetoTitle& title,
                                                  const std::vector<PlacePoint>& points,
                                                  const std::string& stem) {
  std::vector<std::string> paths = {stem + "-places.csv", stem + "-places.json"};
  const Status table = WriteFileWhole(paths[0], CsvText(points));
  if (!table) return table.error();
  const Status json = WriteFileWhole(paths[1], ReportJson(title, points));
  if (!json) return json.error();
  if (!HasProgram("gnuplot")) return paths;
  const Status drawn = DrawPlaces(title, points, stem + "-places");
  if (!drawn) return drawn.error();
  paths.insert(paths.end(), {stem + "-places.svg", stem + "-places.png"});
  return paths;
}

}  // namespace sheaf
