// Small models, and what every reader of models must do.
#ifndef SHEAF_TESTS_MODEL_FILES_H_
#define SHEAF_TESTS_MODEL_FILES_H_

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "folder.h"
#include "random_scene.h"
#include "sheaf/formats.h"

namespace sheaf {

using nlohmann::json;

inline std::string MessageOf(const Result<ReadSceneResult>& result) {
  return result ? "" : result.error().message;
}

// One line, of kScene, that begins with the file.
inline void CheckRefused(const std::string& path, const std::string& part,
                         const ReadOptions& options = {}) {
  const auto result = ReadScene(path, options);
  CAPTURE(part);
  REQUIRE_FALSE(result.ok());
  CAPTURE(result.error().message);
  CHECK(result.error().kind == ErrorKind::kScene);
  CHECK(result.error().message.starts_with(path));
  CHECK(result.error().message.find(part) != std::string::npos);
  CHECK(result.error().message.find('\n') == std::string::npos);
}

inline Scene ReadOrFail(const std::string& path) {
  auto result = ReadScene(path);
  CAPTURE(path);
  CAPTURE(MessageOf(result));
  REQUIRE(result.ok());
  return std::move(result.value().scene);
}

inline const Mesh& MeshAt(const Scene& scene, std::size_t object) {
  return std::get<Mesh>(scene.objects.at(object).shape);
}

// Every prefix, and flips of single bytes: whatever comes, an answer.
inline void CheckSurvives(const Folder& folder, const std::string& name, const std::string& bytes) {
  const std::size_t step = std::max<std::size_t>(1, bytes.size() / 150);
  for (std::size_t size = 0; size < bytes.size(); size += step) {
    const auto result = ReadScene(folder.Write("cut-" + name, bytes.substr(0, size)));
    if (!result) CHECK(result.error().message.find('\n') == std::string::npos);
  }
  Random random(11);
  for (int round = 0; round < 400; ++round) {
    std::string changed = bytes;
    for (int flips = 0; flips < 1 + round % 4; ++flips) {
      changed[random() % changed.size()] = static_cast<char>(random());
    }
    const auto result = ReadScene(folder.Write("changed-" + name, changed));
    if (!result) CHECK(result.error().message.find('\n') == std::string::npos);
  }
  std::string noise(4096, '\0');
  for (char& c : noise) c = static_cast<char>(random());
  CheckRefused(folder.Write("noise-" + name, noise), "");
  CheckRefused(folder.Write("empty-" + name, ""), "");
}

// A picture of one red pixel.
inline const std::string kRedPng(
    "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90wS\xde\0\0\0\x0cIDATx\x9c"
    "c\xf8\xcf\xc0\0\0\3\1\1\0\xc9\xfe\x92\xef\0\0\0\0IEND\xae"
    "B`\x82",
    69);

inline std::string PlyHeader(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\nproperty double y\n"
         "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
         "property float quality\nelement face 2\nproperty list uchar int vertex_indices\n"
         "property uchar flags\nelement edge 1\nproperty int vertex1\nend_header\n";
}

template <typename T>
inline void Put(std::string& bytes, T value, bool is_big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (is_big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

inline constexpr double kSquare[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};

inline std::string AsciiPly() {
  return PlyHeader("ascii") +
         "0 0 0 255 0 128 7\n1 0 0 255 0 128 7\n1 1 0 255 0 128 7\n0 1 0.5 255 0 128 7\n"
         "4 0 1 2 3 9\n3 0 2 1 9\n3\n";
}

inline std::string Base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (int k = 0; k < 4; ++k) {
      text +=
          i + static_cast<std::size_t>(k) > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * k) & 63];
    }
  }
  return text;
}

// Four corners of a square, six indices, quantised positions and one sparse replacement.
inline std::string GltfBuffer() {
  std::string bytes;
  for (const auto& p : kSquare) {
    for (const double x : p) Put(bytes, static_cast<float>(x), false);
  }  // 48 bytes
  for (const int i : {0, 1, 2, 0, 2, 3}) Put(bytes, static_cast<std::uint16_t>(i), false);  // 12
  for (const int i : {0, 0, 0, 0, 32767, 0, 0, 0, 0, 32767, 0, 0})
    Put(bytes, static_cast<std::int16_t>(i), false);  // 24
  Put(bytes, std::uint16_t{3}, false);                // sparse index
  Put(bytes, std::uint16_t{0}, false);
  for (const float x : {0.0f, 2.0f, 0.0f}) Put(bytes, x, false);  // sparse value
  return bytes;
}

inline json SquareGltf() {
  const std::string buffer = GltfBuffer();
  json gltf;
  gltf["asset"]["version"] = "2.0";
  gltf["extensionsUsed"] = {"KHR_lights_punctual", "KHR_mesh_quantization"};
  gltf["buffers"] = {{{"byteLength", buffer.size()},
                      {"uri", "data:application/octet-stream;base64," + Base64(buffer)}}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 48}},
                         {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}},
                         {{"buffer", 0}, {"byteOffset", 60}, {"byteLength", 24}, {"byteStride", 8}},
                         {{"buffer", 0}, {"byteOffset", 84}, {"byteLength", 4}},
                         {{"buffer", 0}, {"byteOffset", 88}, {"byteLength", 12}}};
  const auto accessor = [](int view, int type, int count, const char* shape) {
    return json{{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}};
  };
  json quantised = accessor(2, 5122, 3, "VEC3");
  quantised["normalized"] = true;
  json sparse = accessor(0, 5126, 4, "VEC3");
  sparse["sparse"] = {{"count", 1},
                      {"indices", {{"bufferView", 3}, {"componentType", 5123}}},
                      {"values", {{"bufferView", 4}}}};
  gltf["accessors"] = {accessor(0, 5126, 4, "VEC3"), accessor(1, 5123, 6, "SCALAR"), quantised,
                       sparse};
  gltf["materials"] = {
      {{"name", "paint"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 1}}, {"metallicFactor", 0}}}}};
  gltf["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}}}}},
      {{"primitives", {{{"attributes", {{"POSITION", 3}}}, {"mode", 5}}}}},  // a strip
      {{"primitives", {{{"attributes", {{"POSITION", 3}}}, {"mode", 6}}}}},  // a fan
      {{"primitives", {{{"attributes", {{"POSITION", 2}}}}}}}};              // quantised
  gltf["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"znear", 0.1}}}},
                     {{"type", "orthographic"},
                      {"orthographic", {{"xmag", 2}, {"ymag", 1.5}, {"znear", 0.1}, {"zfar", 9}}}}};
  gltf["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 30.0}, {"color", {1, 0.5, 0.5}}},
      {{"type", "directional"}, {"intensity", 2.0}},
      {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  const auto light = [](int index) { return json{{"KHR_lights_punctual", {{"light", index}}}}; };
  gltf["nodes"] = {
      {{"name", "root"}, {"translation", {10, 0, 0}}, {"children", {1, 2, 3, 4}}},
      {{"name", "square"}, {"mesh", 0}, {"scale", {2, 3, 4}}},
      {{"name", "strip"}, {"mesh", 1}},
      {{"name", "fan"}, {"mesh", 2}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}},
      {{"name", "small"}, {"mesh", 3}},
      {{"name", "front"}, {"camera", 0}, {"translation", {0, 0, 8}}},
      // A quarter turn about y: its -z axis becomes -x.
      {{"name", "side"},
       {"camera", 1},
       {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
       {"translation", {20, 0, 0}}},
      {{"name", "lamp"}, {"extensions", light(0)}, {"translation", {1, 2, 3}}},
      {{"name", "sun"}, {"extensions", light(1)}},
      {{"name", "spot"}, {"extensions", light(2)}}};
  gltf["scenes"] = {{{"nodes", {0, 5, 6, 7, 8, 9}}}};
  gltf["scene"] = 0;
  return gltf;
}

// Appends floats to the buffer, as an accessor of this shape; its index.
inline int AddFloats(json& gltf, const std::vector<float>& numbers, const std::string& shape,
                     int count) {
  std::string bytes;
  for (const float x : numbers) Put(bytes, x, false);
  const std::size_t buffer = gltf["buffers"].size(), view = gltf["bufferViews"].size();
  gltf["buffers"].push_back(
      {{"byteLength", bytes.size()}, {"uri", "data:;base64," + Base64(bytes)}});
  gltf["bufferViews"].push_back({{"buffer", buffer}, {"byteLength", bytes.size()}});
  gltf["accessors"].push_back(
      {{"bufferView", view}, {"componentType", 5126}, {"count", count}, {"type", shape}});
  return static_cast<int>(gltf["accessors"].size()) - 1;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_MODEL_FILES_H_
