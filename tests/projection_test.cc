// Panoramas: directions against a reference in long double, the kernel against its twin, whole
// frames on every target, and projections by name.
#include "src/scene/projection.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "random_scene.h"
#include "same_bits.h"
#include "simd/kernels.h"
#include "src/core/vec3.h"
#include "src/formats/scene_json.h"
#include "src/formats/write_scene_json.h"
#include "src/render/compile_scene.h"
#include "src/scalar/camera_ray.h"
#include "src/stream/stream.h"
#include "targets.h"

namespace sheaf {
namespace {

static_assert(LDBL_MANT_DIG >= 64);
using Wide3 = Vec3<long double>;

const std::vector<Projection> kPanoramas = {Equirectangular{}, Fisheye{}, Fisheye{20},
                                            Fisheye{360}};
constexpr std::pair<int, int> kSizes[] = {{640, 320}, {641, 479}, {1, 1}, {16, 1000}, {2, 3}};

Camera RandomCamera(Random& random) {
  Camera camera;
  camera.eye = UniformPoint(random, -10, 10);
  camera.look_at = UniformPoint(random, -10, 10);
  camera.up = UniformPoint(random, -1, 1);
  return camera;
}

// Where the point (a, b), in picture heights to the right of the middle and up, lies in the
// camera's frame: right, up, forward.
Wide3 LocalDirection(const Projection& projection, long double a, long double b,
                     long double aspect) {
  const long double pi = std::numbers::pi_v<long double>;
  if (const auto* lens = std::get_if<Fisheye>(&projection)) {
    const long double distance = std::hypot(a, b);
    if (distance == 0) return {0, 0, 1};
    const long double angle = distance * lens->fov * pi / 180;
    return {std::sin(angle) * a / distance, std::sin(angle) * b / distance, std::cos(angle)};
  }
  const long double longitude = a / aspect * 2 * pi, latitude = b * pi;
  return {std::cos(latitude) * std::sin(longitude), std::sin(latitude),
          std::cos(latitude) * std::cos(longitude)};
}

// Of a direction. Angles are rounded twice, of up to a whole turn and, in corners of wide pictures,
// several.
template <typename Real>
constexpr long double kBound = 1e-14L;
template <>
constexpr long double kBound<float> = 3e-6L;

TEST_CASE_TEMPLATE("directions are those of the formulas", Real, float, double) {
  Random random(60);
  long double worst = 0;
  for (const Projection& projection : kPanoramas) {
    for (const auto& [width, height] : kSizes) {
      Camera camera = RandomCamera(random);
      camera.projection = projection;
      const auto data = CompileCamera<Real>(camera, width, height);
      const Wide3 f = Normalize((ToVec3(camera.look_at) - ToVec3(camera.eye)).To<long double>());
      const Wide3 r = Normalize(Cross(f, ToVec3(camera.up).To<long double>()));
      const Wide3 u = Cross(r, f);
      for (int i = 0; i < 500; ++i) {
        const int x = static_cast<int>(random() % static_cast<unsigned>(width));
        const int y = static_cast<int>(random() % static_cast<unsigned>(height));
        const Real sx = i % 2 ? Real(0.5) : Real(0), sy = i % 3 ? Real(0.5) : Real(0);
        const auto ray =
            scalar::CameraRay(data, static_cast<Real>(x), static_cast<Real>(y), sx, sy);
        const long double a = (x + static_cast<long double>(sx) - width / 2.0L) / height;
        const long double b = (height / 2.0L - y - static_cast<long double>(sy)) / height;
        const Wide3 local =
            LocalDirection(projection, a, b, static_cast<long double>(width) / height);
        const Wide3 want = r * local.x + u * local.y + f * local.z;
        const Wide3 off = ray.direction.template To<long double>() - want;
        worst = std::max(worst, std::sqrt(Dot(off, off)));
        CHECK(ray.origin.template To<double>().x ==
              static_cast<double>(static_cast<Real>(camera.eye.x)));
      }
    }
  }
  MESSAGE("largest error: ", static_cast<double>(worst));
  CHECK(worst <= kBound<Real>);
}

TEST_CASE_TEMPLATE("the kernel has the bits of its twin", Real, float, double) {
  ForEachTarget([](Target target) {
    const Kernels<Real> kernels = StrictKernels<Real>(target.id());
    Random random(61);
    for (const Projection& projection : kPanoramas) {
      Camera camera = RandomCamera(random);
      camera.projection = projection;
      const auto data = CompileCamera<Real>(camera, 64, 33);
      for (const std::uint32_t count : {1u, 7u, 16u, 33u, 2112u}) {
        RayStream<Real> rays;
        rays.Allocate(count);
        AlignedArray<Real> x, y;
        x.Allocate(StreamCapacity(count)), y.Allocate(StreamCapacity(count));
        for (std::uint32_t i = 0; i < count; ++i) {
          x[i] = static_cast<Real>(i % 64), y[i] = static_cast<Real>(i / 64);
        }
        // The middle of the middle pixel is the picture's middle, where a fisheye divides by 0.
        for (const auto& [sx, sy] : {std::pair(Real(0), Real(0.5)), {Real(0.5), Real(0.3)}}) {
          kernels.generate_primary(data, x.data(), y.data(), sx, sy, {}, count, rays.output());
          const auto got = rays.view();
          for (std::uint32_t i = 0; i < count; ++i) {
            const auto want = scalar::CameraRay(data, x[i], y[i], sx, sy);
            REQUIRE(std::isfinite(want.direction.x));
            REQUIRE(std::signbit(want.direction.z) == std::signbit(got.direction_z[i]));
            REQUIRE(want.direction.x == got.direction_x[i]);
            REQUIRE(want.direction.y == got.direction_y[i]);
            REQUIRE(want.direction.z == got.direction_z[i]);
            REQUIRE(want.origin.x == got.origin_x[i]);
          }
        }
      }
    }
  });
}

Scene CrystalBall() {
  Result<Scene> scene = ReadSceneJson(SHEAF_SOURCE_DIR "/scenes/crystal-ball.json");
  REQUIRE(scene.ok());
  return std::move(scene).value();
}

TEST_CASE("frames have the same bits on every target, thread, tile and crop") {
  const Scene scene = CrystalBall();
  for (const Projection& projection : kPanoramas) {
    for (const Precision precision : {Precision::kStrict, Precision::kDouble}) {
      Camera camera = scene.cameras[0];
      camera.projection = projection;
      RenderOptions options;
      options.width = 64, options.height = 48;
      options.samples = 2;
      options.precision = precision;
      CheckSameBits(scene, camera, options);
    }
  }
}

TEST_CASE("every projection by name, and back") {
  for (const std::string_view name : ProjectionNames()) {
    CAPTURE(std::string(name));
    const auto projection = ProjectionNamed(name);
    REQUIRE(projection.has_value());
    CHECK(KindOf(*projection).name == name);
    CHECK(ParameterOf(*projection) == KindOf(*projection).usual);
  }
  CHECK(!ProjectionNamed("panorama").has_value());
  // The usual numbers stand in the table and in the structs.
  CHECK(ParameterOf(Perspective()) == KindOf(Perspective()).usual);
  CHECK(ParameterOf(Orthographic()) == KindOf(Orthographic()).usual);
  CHECK(ParameterOf(Fisheye()) == KindOf(Fisheye()).usual);
}

// A scene of one camera with this member.
Result<Scene> SceneWith(const std::string& member) {
  return ParseSceneJson(R"({"materials": [], "objects": [], "lights": [],
    "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1], )" +
                            member + "}]}",
                        "f");
}

TEST_CASE("scene files name projections") {
  const auto read = [](const std::string& member) {
    Result<Scene> scene = SceneWith("\"projection\": " + member);
    if (!scene) FAIL_CHECK(scene.error().message);
    return scene ? scene.value().cameras[0].projection : Projection();
  };
  CHECK(std::holds_alternative<Equirectangular>(read("\"equirectangular\"")));
  CHECK(std::get<Fisheye>(read("\"fisheye\"")).fov == 180);
  CHECK(std::get<Fisheye>(read(R"({"fisheye": {"fov": 200}})")).fov == 200);
  CHECK(std::get<Fisheye>(read(R"({"fisheye": {}})")).fov == 180);
  CHECK(std::get<Orthographic>(read(R"({"orthographic": {"height": 3}})")).height == 3);
  CHECK(std::get<Perspective>(read(R"({"perspective": {"fov_y": 30}})")).fov_y == 30);

  const auto message = [](const std::string& member) {
    const Result<Scene> scene = SceneWith(member);
    return scene ? std::string("read") : scene.error().message;
  };
  const auto complains = [&](const std::string& member, const std::string& part) {
    CAPTURE(message(member));
    CHECK(message(member).find(part) != std::string::npos);
  };
  complains(R"("projection": "fish-eye")", "did you mean \"fisheye\"?");
  complains(R"("projection": {"fisheye": {"fov": 361}})", "a number in (0, 360]");
  complains(R"("projection": {"fisheye": {"fov_y": 61}})", "unknown key");
  complains(R"("projection": {"equirectangular": {"fov": 61}})", "unknown key");
  complains(R"("projection": {})", "one projection");
  complains(R"("projection": {"fisheye": {}, "equirectangular": {}})", "one projection");
  complains(R"("projection": "fisheye", "fov_y": 40)", "conflicts with \"fov_y\"");
}

TEST_CASE("what is written is read again") {
  Scene scene = CrystalBall();
  for (const Projection& projection : kPanoramas) {
    scene.cameras[0].projection = projection;
    const Result<Scene> again = ParseSceneJson(SceneJsonText(scene), "f");
    REQUIRE(again.ok());
    const Projection& got = again.value().cameras[0].projection;
    CHECK(got.index() == projection.index());
    CHECK(ParameterOf(got) == ParameterOf(projection));
  }
}

}  // namespace
}  // namespace sheaf
