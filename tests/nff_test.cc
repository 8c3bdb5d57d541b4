// NFF: what sound files become, and what is said of others.
#include "src/formats/nff.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "model_files.h"

namespace sheaf {
namespace {

const std::string kNff = R"(# a comment
b 0.1 0.2 0.3
v
from 0 0 5
at 0 0 0
up 0 1 0
angle 45
hither 1
resolution 64 48
l 1 2 3
l 4 5 6 0.5 0.25 1
f 1 0.5 0.25 0.8 0.2 10 0 1
s 0 0 0 1
p 4
-1 -1 0
1 -1 0
1 1 0
-1 1 0
f 1 1 1 0.1 0.1 50 0.9 1.5
c 0 0 0 0.5 0 1 0 0.25
f 1 0.5 0.25 0.8 0.2 10 0 1
pp 3
0 0 1 0 0 2
1 0 1 0 0 2
0 1 1 0 1 1
)";

TEST_CASE("NFF") {
  const Folder folder;
  const Scene scene = ReadOrFail(folder.Write("a.nff", kNff));
  CHECK(scene.settings.width == 64);
  CHECK(scene.settings.height == 48);
  CHECK(scene.settings.max_depth == 4);
  CHECK(scene.settings.background == Colour(0.1, 0.2, 0.3));
  CHECK(std::get<Perspective>(scene.cameras.at(0).projection).fov_y == 45);
  CHECK(scene.cameras[0].eye == Vec3d(0, 0, 5));
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].intensity == doctest::Approx(std::sqrt(0.5)));
  CHECK(scene.lights[1].colour == Colour(0.5, 0.25, 1));
  CHECK(scene.lights[1].intensity == 1);
  // Equal fills are one material.
  REQUIRE(scene.materials.size() == 2);
  CHECK(scene.materials[0].kd == 0.8);
  CHECK(scene.materials[0].reflect == Colour(0.2));
  CHECK(scene.materials[1].transmit == Colour(0.9));
  CHECK(scene.materials[1].ior == 1.5);
  REQUIRE(scene.objects.size() == 4);
  CHECK(std::holds_alternative<Sphere>(scene.objects[0].shape));
  CHECK(MeshAt(scene, 1).triangles.size() == 2);  // the square
  CHECK(MeshAt(scene, 1).normals.empty());
  CHECK(MeshAt(scene, 2).triangles.size() == 1);  // the patch
  CHECK(MeshAt(scene, 2).normals.size() == 3);
  CHECK(MeshAt(scene, 3).triangles.size() == 64);  // the cone
  for (std::size_t i = 0; i < MeshAt(scene, 3).positions.size(); ++i) {
    const glm::vec3 p = MeshAt(scene, 3).positions[i], n = MeshAt(scene, 3).normals[i];
    CHECK(std::hypot(p.x, p.z) == doctest::Approx(0.5 - 0.25 * p.y));
    CHECK(n.y == doctest::Approx(0.25 / std::hypot(1, 0.25)));  // of a slope of 1 to 4
    CHECK(p.x * n.x + p.z * n.z > 0);
  }
  CheckSurvives(folder, "a.nff", kNff);
}

TEST_CASE("NFF: a cone on three lines, as Haines has it, or on one") {
  const Folder folder;
  const std::string sphere = "s 0 0 0 1\n";
  const Scene one = ReadOrFail(folder.Write("one.nff", "c 0 0 0 0.5 0 1 0 0.25\n" + sphere));
  for (const char* text : {"c\n0 0 0 0.5\n0 1 0 0.25\n", "c\n\n# base\n0 0 0 0.5\n0 1 0 0.25\n",
                           "c 0 0 0 0.5\n0 1 0 0.25\n"}) {
    const Scene scene = ReadOrFail(folder.Write("a.nff", text + sphere));
    REQUIRE(scene.objects.size() == 2);
    CHECK(MeshAt(scene, 1).positions == MeshAt(one, 1).positions);
    CHECK(MeshAt(scene, 1).normals == MeshAt(one, 1).normals);
    CHECK(MeshAt(scene, 1).triangles == MeshAt(one, 1).triangles);
  }
}

TEST_CASE("NFF that is wrong") {
  const Folder folder;
  const auto refused = [&](const std::string& text, const std::string& part) {
    CheckRefused(folder.Write("bad.nff", text), part);
  };
  refused("x 1 2 3\n", ":1: unknown entity \"x\"");
  refused("b 0 0\n", ":1: background: a number is missing");
  refused("b 0 0 nan\n", ":1: background: expected a number");
  refused("\ns 1 2 3 inf\n", ":2: sphere radius");
  refused("p 3\n0 0 0\n1 0 0\n", ":3: the file ends within a polygon");
  refused("p 2\n0 0 0\n1 0 0\n", ":1: number of vertices");
  refused("p 2147483648\n0 0 0\n", ":1: number of vertices");
  refused("v\nfrom 0 0 0\nat 0 0 0\n", "the file ends within the view");
  refused("v\nfrom 0 0 0\nto 0 0 0\n", ":3: expected \"at\"");
  refused("f 1 1 1 1 0 1 0.5 0\n", ":1: fill index");
  refused("c 0 0 0 1 0 0 0 1\n", "one point");
  refused("c\n0 0 0 1\n", ":2: the file ends within a cone");
  refused("c\n0 0 0 1\ns 1 2 3 4\n", ":3: cone apex: expected a number");
}

TEST_CASE("NFF: what is not sound is left out where the rest can be read") {
  const Folder folder;
  const std::string sphere = "s 0 0 0 1\n";
  const auto left_out = [&](const std::string& text, const std::string& warning) {
    const std::string path = folder.Write("a.nff", sphere + text + sphere);
    const auto read = ReadScene(path);
    CAPTURE(MessageOf(read));
    REQUIRE(read.ok());
    CHECK(read.value().warnings == std::vector<std::string>{path + ":" + warning});
    CHECK(std::count_if(read.value().scene.objects.begin(), read.value().scene.objects.end(),
                        [](const Object& object) {
                          return std::holds_alternative<Sphere>(object.shape);
                        }) == 2);
  };
  left_out("c 0 0 0 1 0 0 0 1\nc 1 0 0 1 1 0 0 1\n",
           "2: cone left out: its base and apex are one point (2 in all)");
  left_out("p 2\n0 0 0\n1 0 0\n", "2: polygon left out: number of vertices: 2");
  left_out("pp 0\n", "2: polygon left out: number of vertices: 0");
  const std::string view =
      "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n";
  left_out(view + view, "15: view left out: a second view");
  left_out("v\nfrom 0 0 5\nat 0 0 5\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n",
           "8: view left out: it looks along its own up direction, or at its own eye");
}

}  // namespace
}  // namespace sheaf
