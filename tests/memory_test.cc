// A tile's buffers are as large as the scene needs them: docs/memory-layout.md has these figures.
#include <doctest/doctest.h>

#include <string>

#include "same_bits.h"
#include "scene_text.h"
#include "sheaf/render.h"
#include "simd/streams.h"

namespace sheaf {
namespace {

// All rays of a tile meet one sphere or one quad of one material.
Scene SceneOf(const std::string& shape, const std::string& material, const std::string& lights) {
  return scene_text::Parse(R"({"cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1],
    "fov_y": 20}], "materials": [{"name": "m", )" +
                           material + R"(}], "lights": [)" + lights +
                           R"(], "objects": [{"material": "m", )" + shape + "}]}");
}

const std::string kSphere = R"("sphere": {"center": [0, 0, -3], "radius": 2})";
const std::string kMesh = R"("mesh": {"positions": [[-9, -9, -3], [9, -9, -3], [0, 9, -3]],
  "normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1]], "triangles": [[0, 1, 2]]})";
const std::string kLight = R"({"point": {"position": [0, 3, 3]}, "intensity": 1})";
const std::string kChecker =
    R"("base_colour": {"checker": {"even": [1, 0, 0], "odd": [0, 0, 1], "cells": [9, 9]}})";
const std::string kFlat = R"("base_colour": [1, 1, 1], "ambient": 1, "kd": 1)";

// Bytes for each of the elements that a stream of a tile's pixels has room for.
double BytesEach(const Scene& scene, Precision precision) {
  RenderOptions options;
  options.width = options.height = 32;
  options.threads = 1;
  options.precision = precision;
  RenderStats stats;
  RenderOrFail(scene, scene.cameras[0], options, &stats);
  return static_cast<double>(stats.buffer_bytes) / StreamCapacity(32 * 32);
}

// The binner's runs and what pixels do not pad make up for less than two bytes.
void CheckBytes(const Scene& scene, double floats, double doubles) {
  const double in_float = BytesEach(scene, Precision::kStrict);
  const double in_double = BytesEach(scene, Precision::kDouble);
  CAPTURE(in_float);
  CAPTURE(in_double);
  CHECK(in_float <= floats);
  CHECK(in_float > floats - 2);
  CHECK(in_double <= doubles);
  CHECK(in_double > doubles - 2);
}

TEST_CASE("a scene pays in memory for what it has") {
  CheckBytes(SceneOf(kSphere, kFlat, ""), 124, 220);
  CheckBytes(SceneOf(kSphere, kFlat, kLight), 184, 324);
  CheckBytes(SceneOf(kMesh, kFlat, ""), 124 + 12, 220 + 24);
  CheckBytes(SceneOf(kMesh, kFlat, kLight), 184 + 12 + 16, 324 + 24 + 32);
  CheckBytes(SceneOf(kSphere, kChecker, ""), 124 + 8, 220 + 16);
  // One depth of reflected rays, which all miss, and their colours.
  CheckBytes(SceneOf(kSphere, R"("reflect": 1)", ""), 124 + 48 + 12, 220 + 84 + 24);
}

}  // namespace
}  // namespace sheaf
