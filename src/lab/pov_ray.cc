#include "src/lab/pov_ray.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <iterator>
#include <optional>
#include <variant>

#include "src/core/match.h"
#include "src/lab/has_program.h"
#include "src/scene/direction.h"
#include "src/scene/placed_groups.h"
#include "src/scene/resolve_gloss.h"

namespace sheaf {
namespace {

using Out = std::back_insert_iterator<std::string>;

std::string Vector(const Vec3d& v) { return fmt::format("<{}, {}, {}>", v.x, v.y, v.z); }

bool Transmits(const Material& material) { return glm::length(material.transmit) > 0; }

std::string Finish(const Scene& scene, const Material& material) {
  const Vec3d ambient =
      material.ambient * scene.settings.ambient.value_or(scene.settings.background);
  std::string finish =
      fmt::format("finish {{ ambient rgb {} diffuse {} specular {} roughness {}", Vector(ambient),
                  material.kd, material.ks, 1 / std::max(material.shininess, 1e-3));
  if (Transmits(material)) {
    // From the material's own reflectance at normal incidence to all light at grazing incidence.
    finish += fmt::format(" reflection {{ rgb {}, rgb 1 fresnel on }} conserve_energy",
                          Vector(material.reflect));
  } else if (glm::length(material.reflect) > 0) {
    finish += fmt::format(" reflection {{ rgb {} }}", Vector(material.reflect));
  }
  return finish + " }";
}

// POV-Ray's checker fills space with unit cubes. One layer of cubes is moved so that the quad cuts
// it in the middle.
std::string CheckerPigment(const Checker& checker, const Quad* quad) {
  std::string pattern =
      fmt::format("pigment {{ checker rgb {} rgb {}", Vector(checker.even), Vector(checker.odd));
  if (quad != nullptr) {
    const Vec3d u = (quad->corners[1] - quad->corners[0]) / checker.cells.x;
    const Vec3d v = (quad->corners[3] - quad->corners[0]) / checker.cells.y;
    const Vec3d n = glm::normalize(glm::cross(u, v));
    const Vec3d origin = quad->corners[0] - 0.5 * n;
    pattern += fmt::format(" matrix <{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}>", u.x, u.y,
                           u.z, n.x, n.y, n.z, v.x, v.y, v.z, origin.x, origin.y, origin.z);
  }
  return pattern + " }";
}

std::string Pigment(const Material& material, const Quad* quad) {
  const Checker* checker = nullptr;
  const Colour colour = Match(
      material.base_colour, [](const Colour& constant) { return constant; },
      [&](const Checker& squares) {
        checker = &squares;
        return squares.even;
      },
      [](const Texture& texture) { return texture.factor; });
  if (checker) return CheckerPigment(*checker, quad);
  // Energy is conserved: what is reflected in any case is taken off once.
  const double transmit =
      std::min(material.transmit.x / std::max(1 - material.reflect.x, 1e-6), 1.0);
  return fmt::format("pigment {{ rgb {} transmit {} }}", Vector(colour), transmit);
}

std::string TextureText(const Scene& scene, const Material& given, const Quad* quad) {
  const Material material = ResolveGloss(given, GlossModel::kFading);
  return fmt::format("texture {{ {} {} }}", Pigment(material, quad), Finish(scene, material));
}

// A light of POV-Ray's at a point that falls off with the square of the distance, open for more.
void WriteFadingLight(Out out, const Vec3d& position, const Vec3d& colour) {
  constexpr double kNear = 1e-3;
  fmt::format_to(out, "light_source {{ {} rgb {} fade_distance {} fade_power 2", Vector(position),
                 Vector(colour / (2 * kNear * kNear)), kNear);
}

// Across the square or, `around`, the ball whose edges or diameters these are.
void WriteArea(Out out, const Vec3d& u, const Vec3d& v, const char* around) {
  fmt::format_to(out, " area_light {}, {}, 17, 17 adaptive 1 jitter {}", Vector(u), Vector(v),
                 around);
}

void WriteLight(Out out, const Scene& scene, const Light& light) {
  Vec3d colour = light.colour * light.intensity * scene.settings.exposure;
  Match(
      light.source,
      [&](const DirectionalLight& sun) {
        fmt::format_to(out, "light_source {{ {} rgb {} parallel point_at 0", Vector(-sun.direction),
                       Vector(colour));
      },
      [&](const RectangleLight& rectangle) {
        WriteFadingLight(out, rectangle.center, colour);
        WriteArea(out, rectangle.u, rectangle.v, "area_illumination on");
      },
      [&](const DiskLight& disk) {
        const Vec3d axis = Normalized(disk.direction);
        const Vec3d aside = std::abs(axis.x) > 0.5 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
        const Vec3d u = glm::normalize(glm::cross(axis, aside)), v = glm::cross(axis, u);
        WriteFadingLight(out, disk.center, colour);
        WriteArea(out, u * (2 * disk.radius), v * (2 * disk.radius),
                  "circular area_illumination on");
      },
      [&](const SphereLight& sphere) {
        WriteFadingLight(out, sphere.center, colour);
        WriteArea(out, {2 * sphere.radius, 0, 0}, {0, 2 * sphere.radius, 0}, "circular orient");
      },
      [&](const PointLight& point) {
        // At distance d POV-Ray's light has 2 / (1 + (d / fade_distance)^fade_power) of its colour.
        constexpr double kNear = 1e-3;
        std::string fade;
        if (point.falloff.quadratic > 0) {
          colour /= 2 * kNear * kNear * point.falloff.quadratic;
          fade = fmt::format(" fade_distance {} fade_power 2", kNear);
        } else if (point.falloff.linear > 0) {
          colour /= 2 * kNear * point.falloff.linear;
          fade = fmt::format(" fade_distance {} fade_power 1", kNear);
        } else {
          colour /= point.falloff.constant;
        }
        fmt::format_to(out, "light_source {{ {} rgb {}{}", Vector(point.position), Vector(colour),
                       fade);
      });
  fmt::format_to(out, "{} }}\n", light.casts_shadows ? "" : " shadowless");
}

void WriteSphere(Out out, const Scene& scene, const Sphere& sphere, std::uint32_t index) {
  const Material& material = scene.materials[index];
  const std::string center = Vector(sphere.center);
  fmt::format_to(out, "sphere {{ {}, {} texture {{ T{} }}", center, sphere.radius, index);
  if (Transmits(material)) {
    fmt::format_to(out, " interior {{ ior {} }}", material.ior);
    // An opaque shadow is that of an opaque core which shadow rays alone see.
    if (scene.settings.shadows == Shadows::kOpaque) {
      fmt::format_to(out, " }}\nsphere {{ {}, {} no_image no_reflection pigment {{ rgb 0 }}",
                     center, 0.9999 * sphere.radius);
    }
  }
  fmt::format_to(out, " }}\n");
}

void WriteTriangle(Out out, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  fmt::format_to(out, "triangle {{ {}, {}, {} }}\n", Vector(a), Vector(b), Vector(c));
}

// Leaves the mesh open for its texture.
void WriteMesh(Out out, const Mesh& mesh) {
  fmt::format_to(out, "mesh {{\n");
  for (const auto& corners : mesh.triangles) {
    const auto position = [&](std::size_t i) { return Vec3d(mesh.positions[corners[i]]); };
    if (mesh.normals.empty()) {
      WriteTriangle(out, position(0), position(1), position(2));
      continue;
    }
    const auto corner = [&](std::size_t i) {
      return fmt::format("{}, {}", Vector(position(i)), Vector(Vec3d(mesh.normals[corners[i]])));
    };
    fmt::format_to(out, "smooth_triangle {{ {}, {}, {} }}\n", corner(0), corner(1), corner(2));
  }
}

// A folder that goes away with the object; its path is empty where none could be made.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (std::filesystem::temp_directory_path(error) / "sheaf-XXXXXX").string();
    if (!error && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// The seconds in "using 1 thread(s) with 0.845 CPU-seconds total", which follows "Trace Time: ...".
std::optional<double> TraceSeconds(std::FILE* output) {
  std::optional<double> seconds;
  bool in_trace = false;
  std::array<char, 512> line;
  while (std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr) {
    const std::string text = line.data();
    if (text.find("Time:") != std::string::npos) {
      in_trace = text.find("Trace Time:") != std::string::npos;
    }
    const std::size_t at = text.find("with ");
    double value = 0;
    if (in_trace && at != std::string::npos &&
        std::sscanf(text.c_str() + at, "with %lf CPU-seconds", &value) == 1) {
      seconds = value;
    }
  }
  return seconds;
}

// A binary PPM of 16 bits, big endian, as POV-Ray writes it. Empty where it is anything else.
Film ReadPpm16(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  int width = 0, height = 0, most = 0;
  file >> magic;
  // Comments, of whole lines, may come before the numbers.
  while (file >> std::ws && file.peek() == '#') {
    std::string comment;
    std::getline(file, comment);
  }
  file >> width >> height >> most;
  file.get();
  const bool sound = file && magic == "P6" && most == 65535 && width > 0 && height > 0 &&
                     width <= kMaxImageSide && height <= kMaxImageSide;
  if (!sound) return {};
  Film film(width, height);
  std::string bytes(2 * film.rgb.size(), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) return {};
  for (std::size_t i = 0; i < film.rgb.size(); ++i) {
    const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(bytes[2 * i + k]); };
    film.rgb[i] = static_cast<float>((byte(0) << 8 | byte(1)) / 65535.0);
  }
  return film;
}

}  // namespace

std::string PovText(const Scene& scene, const Camera& camera) {
  std::string text;
  const Out out(text);
  const double aspect = static_cast<double>(scene.settings.width) / scene.settings.height;
  const double fov_y = std::get<Perspective>(camera.projection).fov_y;
  const double half_width = std::tan(glm::radians(fov_y) / 2) * aspect;
  fmt::format_to(out,
                 "#version 3.7;\n"
                 "global_settings {{ assumed_gamma 1 max_trace_level {} ambient_light rgb 1 "
                 "adc_bailout 1/1000 }}\n"
                 "background {{ rgb {} }}\n"
                 "camera {{ location {} right -x*{} up y sky {} angle {} look_at {} }}\n",
                 scene.settings.max_depth + 1, Vector(scene.settings.background),
                 Vector(camera.eye), aspect, Vector(camera.up),
                 glm::degrees(2 * std::atan(half_width)), Vector(camera.look_at));
  for (const Light& light : scene.lights) WriteLight(out, scene, light);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    fmt::format_to(out, "#declare T{} = {}\n", i, TextureText(scene, scene.materials[i], nullptr));
  }
  for (const Object& object : scene.objects) {
    const Material& material = scene.materials[object.material];
    Match(
        object.shape,
        [&](const Sphere& sphere) { WriteSphere(out, scene, sphere, object.material); },
        [&](const Disk& disk) {
          fmt::format_to(out, "disc {{ {}, {}, {} texture {{ T{} }} }}\n", Vector(disk.center),
                         Vector(disk.normal), disk.radius, object.material);
        },
        [&](const Quad& quad) {
          fmt::format_to(out, "mesh {{\n");
          WriteTriangle(out, quad.corners[0], quad.corners[1], quad.corners[2]);
          WriteTriangle(out, quad.corners[0], quad.corners[2], quad.corners[3]);
          fmt::format_to(out, "{} }}\n", TextureText(scene, material, &quad));
        },
        [](const Triangle&) {},  // below
        [&](const Mesh& mesh) {
          WriteMesh(out, mesh);
          fmt::format_to(out, "texture {{ T{} }}", object.material);
          if (Transmits(material)) fmt::format_to(out, " interior {{ ior {} }}", material.ior);
          fmt::format_to(out, " }}\n");
        });
  }
  // One mesh a material, because POV-Ray builds a tree for each mesh.
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    bool is_open = false;
    for (const Object& object : scene.objects) {
      const auto* triangle = std::get_if<Triangle>(&object.shape);
      if (triangle == nullptr || object.material != i) continue;
      if (!is_open) fmt::format_to(out, "mesh {{\n");
      is_open = true;
      WriteTriangle(out, triangle->vertices[0], triangle->vertices[1], triangle->vertices[2]);
    }
    if (is_open) fmt::format_to(out, "texture {{ T{} }} }}\n", i);
  }
  return text;
}

bool HasPovRay() { return HasProgram("povray"); }

Result<PovRender> RenderWithPovRay(const Scene& scene, const Camera& camera, int width, int height,
                                   const std::string& antialiasing, PovPicture picture) {
  const auto failed = [](const std::string& what) {
    return Error{ErrorKind::kInputOutput, "POV-Ray: " + what};
  };
  const TemporaryFolder folder;
  if (folder.path().empty()) return failed("no temporary folder");
  Result<Scene> flat = Flattened(scene);
  if (!flat) return flat.error();
  Scene shown = std::move(flat).value();  // PovText takes the aspect from its size
  shown.settings.width = width;
  shown.settings.height = height;
  std::ofstream(folder.path() + "/scene.pov") << PovText(shown, camera);
  const std::string output =
      picture == PovPicture::kNone
          ? "-F"
          : fmt::format("+FP16 File_Gamma=1.0 +O'{}/picture.ppm'", folder.path());
  const std::string command = fmt::format("povray +I'{}/scene.pov' +W{} +H{} {} -D +WT1 {} 2>&1",
                                          folder.path(), width, height, antialiasing, output);
  std::FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return failed("it did not start");
  const std::optional<double> seconds = TraceSeconds(pipe);
  if (pclose(pipe) != 0 || !seconds) return failed("it did not render the scene");
  PovRender render{*seconds, {}};
  if (picture == PovPicture::kRead) {
    render.film = ReadPpm16(folder.path() + "/picture.ppm");
    if (render.film.width != width || render.film.height != height) {
      return failed("its picture cannot be read");
    }
  }
  return render;
}

}  // namespace sheaf
