// The schema of scene JSON agrees with the reader.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "scene_text.h"
#include "src/core/atomic_file.h"
#include "src/formats/png.h"

namespace sheaf::scene_text {
namespace {

using nlohmann::json;

// As much of a JSON Schema validator as the scene's schema needs; an unknown keyword fails the
// test, so that the schema cannot say something that is not checked here.
class SchemaValidator {
 public:
  explicit SchemaValidator(const json& schema) : root_(schema) {}

  bool Validate(const json& value) { return Check(root_, value); }
  const std::set<const json*>& properties_seen() const { return properties_seen_; }

 private:
  static bool HasType(const json& value, const std::string& type) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    REQUIRE(type == "integer");
    return value.is_number() && value.get<double>() == std::floor(value.get<double>());
  }

  int CountValid(const json& schemas, const json& value) {
    int count = 0;
    for (const json& schema : schemas) count += Check(schema, value) ? 1 : 0;
    return count;
  }

  bool CheckMembers(const json& schema, const json& value) {
    static const json kNothing = json::object();
    const json& known = schema.contains("properties") ? schema["properties"] : kNothing;
    const json* others =
        schema.contains("additionalProperties") ? &schema["additionalProperties"] : nullptr;
    bool valid = true;
    for (const auto& [key, member] : value.items()) {
      if (known.contains(key)) {
        properties_seen_.insert(&known[key]);
        valid &= Check(known[key], member);
      } else if (others) {
        valid &= others->is_boolean() ? others->get<bool>() : Check(*others, member);
      }
      if (schema.contains("propertyNames")) valid &= Check(schema["propertyNames"], json(key));
    }
    return valid;
  }

  bool Check(const json& schema, const json& value) {
    bool valid = true;
    for (const auto& [word, argument] : schema.items()) {
      const bool is_number = value.is_number();
      if (word == "$schema" || word == "title" || word == "description" || word == "default" ||
          word == "$defs" || word == "then" || word == "else" || word == "propertyNames") {
        continue;
      } else if (word == "$ref") {
        valid &= Check(root_.at(json::json_pointer(argument.get<std::string>().substr(1))), value);
      } else if (word == "type") {
        valid &= HasType(value, argument);
      } else if (word == "properties" || word == "additionalProperties") {
        if (word == "properties" && schema.contains("additionalProperties")) continue;
        if (value.is_object()) valid &= CheckMembers(schema, value);
      } else if (word == "required") {
        for (const json& key : argument) valid &= value.is_object() && value.contains(key);
      } else if (word == "items") {
        if (!value.is_array()) continue;
        for (const json& element : value) valid &= Check(argument, element);
      } else if (word == "contains") {
        valid &= !value.is_array() ||
                 std::any_of(value.begin(), value.end(),
                             [&](const json& element) { return Check(argument, element); });
      } else if (word == "minItems") {
        valid &= !value.is_array() || value.size() >= argument.get<std::size_t>();
      } else if (word == "maxItems") {
        valid &= !value.is_array() || value.size() <= argument.get<std::size_t>();
      } else if (word == "uniqueItems") {
        valid &=
            !value.is_array() || std::set<json>(value.begin(), value.end()).size() == value.size();
      } else if (word == "minimum") {
        valid &= !is_number || value >= argument;
      } else if (word == "maximum") {
        valid &= !is_number || value <= argument;
      } else if (word == "exclusiveMinimum") {
        valid &= !is_number || value > argument;
      } else if (word == "exclusiveMaximum") {
        valid &= !is_number || value < argument;
      } else if (word == "enum") {
        valid &= std::find(argument.begin(), argument.end(), value) != argument.end();
      } else if (word == "pattern") {
        // The one pattern in use: no control characters, and perhaps none at all.
        const std::string pattern = argument;
        REQUIRE(pattern.substr(0, pattern.size() - 2) == "^[^\\u0000-\\u001f\\u007f]");
        if (!value.is_string()) continue;
        const std::string text = value;
        valid &= !text.empty() || pattern[pattern.size() - 2] == '*';
        for (char c : text) valid &= static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
      } else if (word == "anyOf") {
        valid &= CountValid(argument, value) > 0;
      } else if (word == "oneOf") {
        valid &= CountValid(argument, value) == 1;
      } else if (word == "allOf") {
        valid &= CountValid(argument, value) == static_cast<int>(argument.size());
      } else if (word == "not") {
        valid &= !Check(argument, value);
      } else if (word == "if") {
        valid &= Check(schema[Check(argument, value) ? "then" : "else"], value);
      } else {
        FAIL("the schema uses a keyword that this test does not know: ", word);
      }
    }
    return valid;
  }

  const json& root_;
  std::set<const json*> properties_seen_;
};

json LoadSchema() { return json::parse(ReadText(kScenes + "sheaf.schema.json")); }

// Uses every key of the format.
json CompleteScene() {
  return json::parse(R"({
    "$schema": "sheaf.schema.json",
    "settings": {"size": [64, 48], "samples": 4, "adaptive": 0.1, "max_depth": 5, "background": [0.1, 0.2, 0.3],
                 "ambient": 0.5, "exposure": 0.5, "srgb": true, "ev": 1.5, "tone": "filmic",
                 "shadows": "opaque", "integrator": "path", "pixel_filter": "gaussian",
                 "environment": {"gradient": {"zenith": 1, "horizon": [1, 1, 0.5], "nadir": 0}}},
    "materials": [
      {"name": "m", "base_colour": {"checker": {"even": 1, "odd": [0, 0, 0], "cells": [2, 3],
                                                    "filter": true}},
       "ambient": 0.1, "kd": 0.5, "ks": 0.5, "shininess": 10, "reflect": 0.5,
       "transmit": [0.1, 0.2, 0.3], "ior": 1.5, "roughness": 0.5, "attenuation": [0.5, 1, 1],
       "attenuation_distance": 2},
      {"name": "plain", "base_colour": [1, 1, 1], "emission": 0.5},
      {"name": "picture", "base_colour": {"texture": {"image": "schema-texture.png",
       "wrap": ["mirror", "clamp"], "filter": "nearest", "srgb": false, "factor": 0.5,
       "transform": {"offset": [0.5, 0], "scale": [2, 2], "rotation": 45}}},
       "emission": 1, "emission_texture": {"image": "schema-texture.png", "set": 1},
       "metallic_roughness": {"texture": {"image": "schema-texture.png"}, "metallic": 0.5,
                              "roughness": 0.25, "specular": 2},
       "occlusion": {"texture": {"image": "schema-texture.png"}, "strength": 0.5},
       "transmission": {"texture": {"image": "schema-texture.png"}, "share": 0.5},
       "normal_map": {"texture": {"image": "schema-texture.png"}, "scale": 2},
       "alpha": {"mode": "blend", "factor": 0.5, "cutoff": 0.25}}],
    "objects": [
      {"name": "mesh", "material": "picture",
       "mesh": {"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "normals": [[0, 0, 1], [0, 0, 1],
                [0, 0, 1]], "uv": [[0, 0], [1, 0], [0, 1]],
                "colours": [[1, 1, 1], [0.5, 0, 0], [0, 0, 1]], "alphas": [1, 0.5, 0],
                "uv2": [[0, 0], [2, 0], [0, 2]], "triangles": [[0, 1, 2]]},
       "transform": [{"translate": [1, 2, 3]}, {"rotate": {"axis": [0, 1, 0], "degrees": 30}},
                     {"scale": [1, 2, 3]},
                     {"matrix": [[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 2, 7]]}]},
      {"include": "schema-part.json", "transform": {"scale": 2}},
      {"name": "a", "sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"},
      {"name": "d", "disk": {"center": [0, 0, 0], "radius": 1, "normal": [0, 1, 0]}, "material": "m"},
      {"name": "b", "quad": {"corners": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]},
       "material": "m"},
      {"triangle": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
                    "uv": [[0, 0], [0.5, 0], [0, 2]]}, "material": "plain"}],
    "groups": [
      {"name": "twig", "objects": [
        {"sphere": {"center": [0, 0, 0], "radius": 1}, "material": "m"}]},
      {"name": "tree", "instances": [
        {"name": "left", "group": "twig", "transform": {"translate": [-1, 0, 0]}}]}],
    "instances": [
      {"name": "oak", "group": "tree", "transform": [{"scale": [1, 2, 1]}]},
      {"group": "twig"}],
    "lights": [
      {"name": "l", "point": {"position": [9, 8, 7], "falloff": "linear"}, "colour": [1, 1, 0.5],
       "E0": 100, "reference": [0, 0, 0], "shadows": false},
      {"point": {"position": [9, 8, 7], "falloff": [1, 2, 3]}, "intensity": 5},
      {"spot": {"position": [9, 8, 7], "direction": [0, -1, 0.5], "inner": 5, "outer": 30,
                "falloff": "constant"}, "intensity": 2},
      {"directional": {"direction": [0, -1, 1]}, "E0": 1},
      {"directional": {"direction": [1, -1, 1], "angle": 0.5}, "intensity": 1},
      {"rectangle": {"center": [0, 5, 0], "u": [1, 0, 0], "v": [0, 0, 2]}, "intensity": 1,
       "samples": 4},
      {"disk": {"center": [0, 5, 0], "radius": 0.5, "direction": [0, -1, 0]}, "intensity": 1},
      {"sphere": {"center": [0, 5, 0], "radius": 0.5}, "intensity": 1}],
    "cameras": [
      {"name": "p", "eye": [0, 0, 9], "look_at": [0, 0, 0], "up": [0, 1, 0.5], "fov_y": 40,
       "lens": {"f_stop": 2.8, "sensor": 0.03, "focus": 8, "blades": 5, "rotation": 10},
       "path": [{"frame": 0}, {"frame": 9.5, "eye": [1, 0, 9], "look_at": [0, 1, 0], "fov_y": 20}]},
      {"name": "o", "eye": [0, 0, 9], "look_at": [0, 0, 0], "orthographic": {"height": 3},
       "lens": {"aperture": 0.2}, "path": [{"frame": 0, "height": 4}]},
      {"name": "n", "eye": [0, 0, 9], "look_at": [0, 0, 0],
       "projection": {"perspective": {"fov_y": 40}}},
      {"name": "h", "eye": [0, 0, 9], "look_at": [0, 0, 0],
       "projection": {"orthographic": {"height": 3}}},
      {"name": "e", "eye": [0, 0, 9], "look_at": [0, 0, 0],
       "projection": {"equirectangular": {}}},
      {"name": "f", "eye": [0, 0, 9], "look_at": [0, 0, 0],
       "projection": {"fisheye": {"fov": 200}}, "path": [{"frame": 3, "fov": 100}]}],
    "views": {"all": ["p", "o"], "one": ["o"]}})");
}

// What only the reader can know.
bool IsBeyondSchema(const std::string& message) {
  for (const char* part : {": no material \"",
                           ": no camera \"",
                           ": no group \"",
                           "its transform flattens it",
                           " exists already, from line ",
                           "gives no direction",
                           "looks at its own eye",
                           "parallel to up",
                           "does not come after",
                           "is not of the camera's projection",
                           "the quad has no area",
                           "not in one plane",
                           "do not form a convex quad",
                           "where E0 is not defined",
                           "the intensity would be",
                           "one of the terms must be",
                           "cannot open",
                           "cannot read",
                           "lies outside",
                           "must end in",
                           "no name of a file",
                           "a scale of 0",
                           "is singular",
                           "inner must be below",
                           "span no rectangle",
                           "needs samples of",
                           "the aperture would be",
                           "have no lens",
                           "have an f-number",
                           "elements for",
                           "expected an integer in [0, ",
                           "neither a PNG nor"}) {
    if (message.find(part) != message.npos) return true;
  }
  return false;
}

// Every document that differs from `document` in one place.
std::vector<json> Mutations(const json& document) {
  const json values = json::parse(
      R"([null, true, -1, 0, 0.5, 3, 180, 65536, 1e7, 1e40, "", "x", "linear", "a\u0001", [], {},
          [1, 2], [1, 2, 3], ["p"], {"checker": {}}, {"height": 1}])");
  std::vector<json> mutations;
  const json flat_keys = document.flatten();
  std::set<std::string> places{""};
  for (const auto& [pointer, leaf] : flat_keys.items()) {
    for (std::string at = pointer; !at.empty(); at.erase(at.rfind('/'))) places.insert(at);
  }
  for (const std::string& text : places) {
    const json::json_pointer place(text);
    for (const json& value : values) {
      json changed = document;
      changed[place] = value;
      mutations.push_back(changed);
    }
    if (document[place].is_object()) {
      json grown = document;
      grown[place]["zzzz"] = 1;
      mutations.push_back(grown);
      for (const char* key : {"reference", "E0", "intensity", "fov_y", "name", "uv", "sphere"}) {
        grown = document;
        grown[place].emplace(key, 1);
        mutations.push_back(grown);
      }
    }
    if (document[place].is_array()) {
      json grown = document;
      grown[place].push_back(document[place][0]);
      mutations.push_back(grown);
    }
    if (text.empty()) continue;
    const json& parent = document[place.parent_pointer()];
    json shrunk = document;
    if (parent.is_object()) {
      shrunk[place.parent_pointer()].erase(place.back());
      mutations.push_back(shrunk);
      shrunk[place.parent_pointer()][place.back() + "_"] = document[place];
      mutations.push_back(shrunk);
    } else {
      shrunk[place.parent_pointer()].erase(std::stoul(place.back()));
      mutations.push_back(shrunk);
    }
  }
  return mutations;
}

void CollectProperties(const json& schema, std::set<const json*>* properties) {
  if (!schema.is_structured()) return;
  if (schema.is_object() && schema.contains("properties")) {
    for (const json& property : schema["properties"]) properties->insert(&property);
  }
  for (const json& part : schema) CollectProperties(part, properties);
}

TEST_CASE("the schema accepts the shipped scene") {
  const json schema = LoadSchema();
  SchemaValidator validator(schema);
  const json scene = json::parse(ReadText(kScenes + "crystal-ball.json"), nullptr, true, true);
  CHECK(validator.Validate(scene));
}

TEST_CASE("schema and reader know the same keys, types and ranges") {
  const json schema = LoadSchema();
  SchemaValidator validator(schema);
  const json complete = CompleteScene();
  // The files that it names.
  REQUIRE(WritePng({1, 1, {255, 0, 0}}, Transfer::kLinear, "schema-texture.png").ok());
  REQUIRE(WriteFileWhole("schema-part.json",
                         R"({"cameras": [{"name": "p", "eye": [0, 0, 9], "look_at": [0, 0, 0]}]})")
              .ok());
  REQUIRE(Outcome(complete.dump(1)) == "ok");
  REQUIRE(validator.Validate(complete));
  json mapped = complete;
  mapped["settings"]["environment"] = {
      {"map", {{"image", "schema-texture.png"}, {"strength", 2}, {"rotation", 90}}}};
  REQUIRE(Outcome(mapped.dump(1)) == "ok");
  REQUIRE(validator.Validate(mapped));

  json measured = complete;
  measured["settings"].erase("adaptive");
  measured["settings"]["error"] = 0.02;
  measured["settings"]["samples"] = 64;
  REQUIRE(Outcome(measured.dump(1)) == "ok");
  REQUIRE(validator.Validate(measured));

  // No key of the schema is missing from the complete scenes, which the reader accepts.
  std::set<const json*> properties;
  CollectProperties(schema, &properties);
  CHECK(properties.size() > 50);
  CHECK(validator.properties_seen() == properties);

  // An include may have all the cameras.
  for (const char* text : {R"({"objects": [{"include": "schema-part.json"}]})",
                           R"({"objects": [{"include": "schema-part.json"}], "cameras": []})"}) {
    CHECK(Outcome(text) == "ok");
    CHECK(validator.Validate(json::parse(text)));
  }
  for (const char* text : {"{}", R"({"cameras": []})", R"({"objects": []})"}) {
    CHECK(Outcome(text) != "ok");
    CHECK(!validator.Validate(json::parse(text)));
  }

  int accepted = 0, refused = 0, beyond = 0;
  for (const json& mutation : Mutations(complete)) {
    const std::string text = mutation.dump(1);
    const std::string outcome = Outcome(text);
    const bool valid = validator.Validate(mutation);
    if (outcome == "ok") {
      ++accepted;
    } else if (valid && IsBeyondSchema(outcome)) {
      ++beyond;
      continue;
    } else {
      ++refused;
    }
    if (valid != (outcome == "ok")) {
      CAPTURE(text);
      CAPTURE(valid);
      CHECK(outcome == "");
    }
  }
  // All three happen often, so the comparison means something.
  CHECK(accepted > 200);
  CHECK(refused > 1000);
  CHECK(beyond > 50);
}

}  // namespace
}  // namespace sheaf::scene_text
