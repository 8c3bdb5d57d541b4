// Texts of scene JSON around one element, and what the reader says of them.
#ifndef SHEAF_TESTS_SCENE_TEXT_H_
#define SHEAF_TESTS_SCENE_TEXT_H_

#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "sheaf/formats.h"

// A namespace of its own: some of these are named like what they describe.
namespace sheaf::scene_text {

inline const std::string kScenes = std::string(SHEAF_SOURCE_DIR) + "/scenes/";

inline std::string ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  REQUIRE(file.good());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// "ok" or the message.
inline std::string Outcome(std::string_view text) {
  const Result<Scene> scene = ParseSceneJson(text, "f");
  if (scene.ok()) return "ok";
  CHECK(scene.error().kind == ErrorKind::kScene);
  return scene.error().message;
}

inline Scene Parse(std::string_view text) {
  Result<Scene> scene = ParseSceneJson(text, "f");
  if (!scene.ok()) FAIL(scene.error().message);
  return std::move(scene).value();
}

// A scene around one element, on line 1, with what it refers to.
inline std::string WithCamera(const std::string& members) {
  return "{" + members +
         R"(, "cameras": [{"name": "c", "eye": [0, 0, 0], "look_at": [0, 0, -1]}]})";
}
inline std::string Settings(const std::string& text) { return WithCamera("\"settings\": " + text); }
inline std::string Material(const std::string& members) {
  return WithCamera(R"("materials": [{"name": "m", )" + members + "}]");
}
inline std::string Object(const std::string& members) {
  return WithCamera(R"("materials": [{"name": "glass"}], "objects": [{)" + members + "}]");
}
inline std::string Shape(const std::string& members) {
  return Object(R"("material": "glass", )" + members);
}
inline std::string Quad(const std::string& corners) {
  return Shape("\"quad\": {\"corners\": " + corners + "}");
}
inline std::string Light(const std::string& members) {
  return WithCamera("\"lights\": [{" + members + "}]");
}
inline std::string Camera(const std::string& members) {
  return "{\"cameras\": [{" + members + "}]}";
}

}  // namespace sheaf::scene_text

#endif  // SHEAF_TESTS_SCENE_TEXT_H_
