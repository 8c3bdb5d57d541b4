#include "src/formats/nff.h"

#include <fmt/format.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <utility>

#include "src/core/strict_tan.h"
#include "src/formats/losses.h"
#include "src/formats/printable.h"
#include "src/formats/read_file.h"
#include "src/formats/scene_values.h"
#include "src/formats/text_scanner.h"
#include "src/formats/triangulate.h"
#include "src/scene/transform.h"

namespace sheaf {
namespace {

constexpr std::size_t kMaxCorners = 1 << 20;

class NffReader {
 public:
  NffReader(std::string_view text, const std::string& name, SceneFiles& files)
      : scanner_(text), name_(name), cone_sides_(files.options().cone_sides), losses_(files) {}

  Result<Scene> Read() {
    // Haines has no ambient light; a picture is black where no light reaches.
    scene_.settings.ambient = Colour(0.0);
    // His counts stop at five levels, the eye's rays being the first.
    scene_.settings.max_depth = 4;
    scene_.settings.shadows = Shadows::kOpaque;
    while (!error_ && scanner_.NextLine()) {
      const std::string_view word = scanner_.Word();
      if (!word.empty() && word.front() != '#') ReadEntity(word);
    }
    if (error_) return *error_;
    FinishLights();
    FinishMeshes();
    if (scene_.objects.empty()) {
      return losses_.first() ? *losses_.first() : SceneError(name_, "no object");
    }
    return std::move(scene_);
  }

 private:
  void Fail(std::string_view what) {
    if (!error_) error_ = SceneErrorAt(name_, scanner_.line(), what);
  }

  // What can be told apart from the rest of the text: the others stay.
  void LeaveOut(std::size_t line, std::string_view kind, std::string_view why) {
    losses_.LeaveOut(PlaceOf(name_, line), kind, why);
  }

  void ReadEntity(std::string_view word) {
    if (word == "b") return ReadBackground();
    if (word == "v") return ReadView();
    if (word == "l") return ReadLight();
    if (word == "f") return ReadFill();
    if (word == "c") return ReadCone();
    if (word == "s") return ReadSphere();
    if (word == "p") return ReadPolygon(kFlat);
    if (word == "pp") return ReadPolygon(kPatch);
    Fail(fmt::format("unknown entity \"{}\"; there are b, v, l, f, c, s, p and pp",
                     Printable(word, 40)));
  }

  bool ReadNumber(const char* what, double* out, double low = -kMaxCoordinate,
                  double high = kMaxCoordinate) {
    const std::string_view word = scanner_.Word();
    const auto number = ParseWord<double>(word);
    if (number && *number >= low && *number <= high) {
      *out = *number;
      return true;
    }
    Fail(word.empty() ? fmt::format("{}: a number is missing", what)
                      : fmt::format("{}: expected a number in [{:g}, {:g}], found \"{}\"", what,
                                    low, high, Printable(word, 40)));
    return false;
  }

  bool ReadTriple(const char* what, Vec3d* out, double low = -kMaxCoordinate,
                  double high = kMaxCoordinate) {
    return ReadNumber(what, &out->x, low, high) && ReadNumber(what, &out->y, low, high) &&
           ReadNumber(what, &out->z, low, high);
  }

  bool IsLineDone() { return scanner_.Remainder().empty() || scanner_.Remainder().front() == '#'; }

  // The lines of an entity that takes several; blank ones and comments may stand between.
  bool NextLineOf(const char* what) {
    while (scanner_.NextLine()) {
      if (!IsLineDone()) return true;
    }
    Fail(fmt::format("the file ends within {}", what));
    return false;
  }

  void ExpectEnd() {
    const std::string_view word = scanner_.Word();
    if (!word.empty()) Fail(fmt::format("unexpected \"{}\"", Printable(word, 40)));
  }

  void ReadBackground() {
    ReadTriple("background", &scene_.settings.background, 0, kStrength.high);
    ExpectEnd();
  }

  void ReadView() {
    ExpectEnd();
    Camera camera;
    camera.name = "nff";
    double angle = 45, hither = 0, width = 512, height = 512;
    const auto line = [&](const char* key, auto read) {
      if (error_ || !NextLineOf("the view")) return;
      const std::string_view word = scanner_.Word();
      if (word != key) {
        return Fail(
            fmt::format("expected \"{}\" of the view, found \"{}\"", key, Printable(word, 40)));
      }
      read();
      ExpectEnd();
    };
    line("from", [&] { ReadTriple("from", &camera.eye); });
    line("at", [&] { ReadTriple("at", &camera.look_at); });
    line("up", [&] { ReadTriple("up", &camera.up); });
    line("angle", [&] { ReadNumber("angle", &angle, 1e-6, 179.999); });
    // Nothing is cut off: a ray tracer needs no near plane.
    line("hither", [&] { ReadNumber("hither", &hither); });
    line("resolution", [&] {
      if (ReadNumber("resolution", &width, 1, kMaxImageSide)) {
        ReadNumber("resolution", &height, 1, kMaxImageSide);
      }
    });
    if (error_) return;
    const std::size_t line_of_view = scanner_.line();
    if (!scene_.cameras.empty()) return LeaveOut(line_of_view, "view left out", "a second view");
    const Vec3d towards = camera.look_at - camera.eye;
    if (glm::length(glm::cross(towards, camera.up)) <=
        1e-6 * glm::length(towards) * glm::length(camera.up)) {
      return LeaveOut(line_of_view, "view left out",
                      "it looks along its own up direction, or at its own eye");
    }
    camera.projection = Perspective{angle};
    scene_.cameras.push_back(camera);
    scene_.settings.width = static_cast<int>(width);
    scene_.settings.height = static_cast<int>(height);
  }

  void ReadLight() {
    Light light;
    PointLight point;
    point.falloff = {1, 0, 0};
    if (!ReadTriple("light", &point.position)) return;
    light.name = fmt::format("light {}", scene_.lights.size() + 1);
    light.source = point;
    const std::string_view rest = scanner_.Remainder();
    if (!rest.empty()) {
      if (!ReadTriple("light colour", &light.colour, 0, kStrength.high)) return;
      light.intensity = 1;
    } else {
      light.intensity = 0;  // its share is known when all lights are
    }
    ExpectEnd();
    scene_.lights.push_back(light);
  }

  // "the intensity of each light is 1 / sqrt(number of lights)", unless it has a colour.
  void FinishLights() {
    const double share = 1 / std::sqrt(static_cast<double>(scene_.lights.size()));
    for (Light& light : scene_.lights) {
      if (light.intensity == 0) light.intensity = share;
    }
  }

  void ReadFill() {
    Colour colour;
    double kd = 0, ks = 0, shine = 0, transmit = 0, ior = 1;
    const bool is_read = ReadTriple("fill colour", &colour, 0, kStrength.high) &&
                         ReadNumber("fill Kd", &kd, 0, kStrength.high) &&
                         ReadNumber("fill Ks", &ks, 0, kStrength.high) &&
                         ReadNumber("fill shine", &shine, 0, kShininess.high) &&
                         ReadNumber("fill T", &transmit, 0, 1) &&
                         ReadNumber("fill index", &ior, 0, kIor.high);
    if (!is_read) return;
    ExpectEnd();
    if (transmit > 0 && ior < kIor.low)
      return Fail("fill index: a transparent fill needs one above 0");
    Material material;
    material.base_colour = colour;
    material.kd = kd;
    material.ks = ks;
    material.shininess = shine;
    // A mirror as strong as the highlight, and no more in all than arrives.
    material.reflect = Colour(std::min(ks, 1 - transmit));
    material.transmit = Colour(transmit);
    material.ior = transmit > 0 ? ior : 1;
    // Equal fills are one material: rays are shaded in batches of one.
    const std::array<double, 8> key = {colour.x, colour.y, colour.z, kd, ks, shine, transmit, ior};
    const auto [entry, is_new] =
        material_of_.try_emplace(key, static_cast<std::uint32_t>(scene_.materials.size()));
    if (is_new) {
      material.name = fmt::format("fill {}", entry->second + 1);
      scene_.materials.push_back(material);
    }
    material_ = entry->second;
  }

  // What is drawn before any fill is white and matt.
  std::uint32_t CurrentMaterial() {
    if (!material_) {
      Material plain;
      plain.name = "no fill";
      plain.kd = 1;
      material_ = static_cast<std::uint32_t>(scene_.materials.size());
      scene_.materials.push_back(plain);
    }
    return *material_;
  }

  // One mesh a material and kind: flat polygons, and those with normals.
  enum Kind { kFlat, kPatch };
  Mesh& MeshOf(Kind kind) { return meshes_[{CurrentMaterial(), kind}]; }

  std::uint32_t AddVertex(Mesh& mesh, const Vec3d& position) {
    mesh.positions.emplace_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
  }

  void FinishMeshes() {
    for (auto& [key, mesh] : meshes_) {
      if (mesh.triangles.empty()) continue;
      scene_.objects.push_back({"", std::move(mesh), key.first});
    }
  }

  void ReadSphere() {
    Sphere sphere;
    if (!ReadTriple("sphere", &sphere.center) ||
        !ReadNumber("sphere radius", &sphere.radius, -kMaxCoordinate, kMaxCoordinate)) {
      return;
    }
    ExpectEnd();
    sphere.radius = std::abs(sphere.radius);  // below 0 it is seen from inside, which needs no sign
    scene_.objects.push_back({"", sphere, CurrentMaterial()});
  }

  void ReadPolygon(Kind kind) {
    double count = 0;
    const std::size_t line = scanner_.line();
    if (!ReadNumber("number of vertices", &count, 0, kMaxCorners)) return;
    ExpectEnd();
    if (count != std::floor(count)) return Fail("number of vertices: expected a whole number");
    Mesh& mesh = MeshOf(kind);
    polygon_.clear();
    for (int i = 0; i < static_cast<int>(count) && !error_; ++i) {
      Vec3d position, normal;
      if (!NextLineOf("a polygon") || !ReadTriple("vertex", &position)) return;
      if (kind == kPatch) {
        if (!ReadTriple("normal", &normal)) return;
        const double length = glm::length(normal);
        mesh.normals.emplace_back(length > 0 ? normal / length : normal);
      }
      ExpectEnd();
      polygon_.push_back(AddVertex(mesh, position));
    }
    if (error_) return;
    if (polygon_.size() < 3) {
      LeaveOut(line, "polygon left out", fmt::format("number of vertices: {}", polygon_.size()));
    }
    Triangulate(mesh.positions, polygon_, mesh.triangles);
  }

  // A frustum without caps, its normals those of the cone.
  void ReadCone() {
    Vec3d base, apex;
    double base_radius = 0, apex_radius = 0;
    // Haines has three lines, others write one.
    const auto go_on = [this] { return !IsLineDone() || NextLineOf("a cone"); };
    if (!go_on() || !ReadTriple("cone base", &base) || !go_on() ||
        !ReadNumber("cone base radius", &base_radius) || !go_on() ||
        !ReadTriple("cone apex", &apex) || !go_on() ||
        !ReadNumber("cone apex radius", &apex_radius)) {
      return;
    }
    ExpectEnd();
    base_radius = std::abs(base_radius);
    apex_radius = std::abs(apex_radius);
    const Vec3d axis = apex - base;
    const double height = glm::length(axis);
    if (!(height > 0)) {
      return LeaveOut(scanner_.line(), "cone left out", "its base and apex are one point");
    }
    const Vec3d up = axis / height;
    const Vec3d side =
        glm::normalize(glm::cross(up, std::abs(up.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
    Mesh& mesh = MeshOf(kPatch);
    const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < cone_sides_; ++i) {
      const Vec3d out = RotationAbout(up, 360.0 * i / cone_sides_).Vector(side);
      const Vec3d normal = glm::normalize(out * height + up * (base_radius - apex_radius));
      AddVertex(mesh, base + out * base_radius);
      AddVertex(mesh, apex + out * apex_radius);
      mesh.normals.insert(mesh.normals.end(), 2, glm::vec3(normal));
    }
    const auto sides = static_cast<std::uint32_t>(cone_sides_);
    for (std::uint32_t i = 0; i < sides; ++i) {
      const std::uint32_t a = first + 2 * i, b = first + 2 * ((i + 1) % sides);
      // A tip needs one triangle a side.
      if (base_radius > 0) mesh.triangles.push_back({a, b, b + 1});
      if (apex_radius > 0) mesh.triangles.push_back({a, b + 1, a + 1});
    }
  }

  TextScanner scanner_;
  const std::string& name_;
  int cone_sides_;
  Losses losses_;
  Scene scene_;
  std::optional<Error> error_;
  std::map<std::array<double, 8>, std::uint32_t> material_of_;
  std::optional<std::uint32_t> material_;
  std::map<std::pair<std::uint32_t, Kind>, Mesh> meshes_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

Result<Scene> ParseNffScene(std::string_view text, const std::string& name, SceneFiles& files) {
  return NffReader(text, name, files).Read();
}

}  // namespace sheaf
