#include "src/app/suspect_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <set>
#include <variant>

#include "src/core/match.h"
#include "src/formats/printable.h"
#include "src/scene/shapes.h"

namespace sheaf {
namespace {

double Largest(const Colour& colour) { return std::max({colour.r, colour.g, colour.b}); }

Colour BaseColour(const Material& material) {
  return Match(
      material.base_colour, [](const Colour& colour) { return colour; },
      [](const Checker& checker) { return glm::max(checker.even, checker.odd); },
      [](const Texture& texture) { return texture.factor; });
}

// Whole numbers of at most 255, one of which is well above 1.
bool LooksLikeBytes(const Colour& colour) {
  const double largest = Largest(colour);
  return largest >= 2 && largest <= 255 && glm::floor(colour) == colour;
}

// "255, 128, 0".
std::string Text(const Colour& colour) {
  return fmt::format("{:g}, {:g}, {:g}", colour.r, colour.g, colour.b);
}

bool IsLit(const Scene& scene, const std::set<std::uint32_t>& used) {
  for (const Light& light : scene.lights) {
    if (light.intensity * Largest(light.colour) > 0) return true;
  }
  // Surroundings are taken to shine: a black picture all around is found by the frame itself.
  const Settings& settings = scene.settings;
  const Colour around = settings.environment ? Colour(1.0) : settings.background;
  const bool is_path = settings.integrator == Integrator::kPath;
  if (is_path && Largest(around) > 0) return true;
  const Colour ambient = is_path ? Colour(0.0) : settings.ambient.value_or(around);
  return std::any_of(used.begin(), used.end(), [&](std::uint32_t index) {
    const Material& material = scene.materials[index];
    return Largest(material.emission) > 0 ||
           material.ambient * Largest(ambient) * Largest(BaseColour(material)) > 0;
  });
}

}  // namespace

std::vector<std::string> SuspectScene(const Scene& scene) {
  std::vector<std::string> lines;
  std::set<std::uint32_t> used;
  ForEachObject(scene, [&](const Object& object) { used.insert(object.material); });
  if (!used.empty() && !IsLit(scene, used)) {
    lines.push_back(
        "nothing lights the scene: it has no light, no ambient light and nothing that "
        "glows, so that its objects are black");
  }
  const auto ask = [&](const char* kind, const std::string& name, const Colour& colour) {
    if (!LooksLikeBytes(colour)) return;
    lines.push_back(fmt::format("{}{}: is the colour {} meant in 0 to 255? 1 is white here", kind,
                                name.empty() ? "" : fmt::format(" \"{}\"", Printable(name)),
                                Text(colour)));
  };
  for (const std::uint32_t index : used) {
    ask("material", scene.materials[index].name, BaseColour(scene.materials[index]));
  }
  ask("the background", "", scene.settings.background);
  // A light's colour may well be above 1; bytes of a colour picker hardly are below 100.
  for (const Light& light : scene.lights) {
    if (Largest(light.colour) >= 100) ask("light", light.name, light.colour);
  }
  return lines;
}

}  // namespace sheaf
