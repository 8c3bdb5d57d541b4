#include "src/formats/gltf_animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "src/formats/gltf_accessors.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

using Values = std::vector<double>;

// The properties that channels move, and the components of each; weights have one a target.
struct Property {
  const char* name;
  std::size_t components;
  std::vector<double> tinygltf::Node::*values;
};
constexpr Property kProperties[] = {{"translation", 3, &tinygltf::Node::translation},
                                    {"rotation", 4, &tinygltf::Node::rotation},
                                    {"scale", 3, &tinygltf::Node::scale},
                                    {"weights", 0, &tinygltf::Node::weights}};

double Dot(const Values& a, const Values& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

Values Normalized(Values v) {
  const double length = std::sqrt(Dot(v, v));
  for (double& number : v) number = length > 0 ? number / length : number;
  return v;
}

// a * x + b * y, by components.
Values Sum(double x, const Values& a, double y, const Values& b) {
  Values sum(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) sum[i] = x * a[i] + y * b[i];
  return sum;
}

// The share `t` of the shorter way from `a` to `b` on the sphere of unit quaternions (Shoemake
// 1985). The arc is halved until a chord is as good, which takes square roots alone: the sines of
// other C libraries have other bits.
Values Slerp(Values a, Values b, double t) {
  a = Normalized(std::move(a));
  b = Normalized(std::move(b));
  if (Dot(a, b) < 0) b = Sum(-1, b, 0, b);
  for (int halving = 0; halving < 24; ++halving) {
    Values middle = Normalized(Sum(1, a, 1, b));
    t *= 2;
    if (t < 1) {
      b = std::move(middle);
    } else {
      a = std::move(middle);
      t -= 1;
    }
  }
  return Normalized(Sum(1 - t, a, t, b));
}

// One sampler's keys.
struct Track {
  std::vector<double> times;
  std::vector<double> outputs;
  std::size_t width = 0;  // components of a value
  bool is_cubic = false, is_step = false, is_rotation = false;

  // Part 0 of a cubic key is the tangent that arrives, 1 the value, 2 the tangent that leaves.
  Values At(std::size_t key, std::size_t part = 1) const {
    const std::size_t from = width * (is_cubic ? 3 * key + part : key);
    const auto first = outputs.begin() + static_cast<std::ptrdiff_t>(from);
    return {first, first + static_cast<std::ptrdiff_t>(width)};
  }
  Values AtTime(double time) const;
};

Values Track::AtTime(double time) const {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.begin()) return At(0);
  const auto key = static_cast<std::size_t>(after - times.begin()) - 1;
  if (after == times.end() || is_step) return At(key);
  const double span = times[key + 1] - times[key];
  const double t = (time - times[key]) / span;
  if (!is_cubic) {
    return is_rotation ? Slerp(At(key), At(key + 1), t) : Sum(1 - t, At(key), t, At(key + 1));
  }
  // Hermite's cubic (appendix C.3).
  const double t2 = t * t, t3 = t2 * t;
  const Values values = Sum(2 * t3 - 3 * t2 + 1, At(key), 3 * t2 - 2 * t3, At(key + 1));
  const Values tangents =
      Sum(span * (t3 - 2 * t2 + t), At(key, 2), span * (t3 - t2), At(key + 1, 0));
  const Values value = Sum(1, values, 1, tangents);
  return is_rotation ? Normalized(value) : value;
}

class Animator {
 public:
  Animator(GltfDocument& document, double time) : document_(document), time_(time) {}

  bool Apply(const tinygltf::Animation& animation, const std::string& place) {
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      if (!ApplyChannel(animation, channel, place)) return false;
    }
    return true;
  }

 private:
  bool ApplyChannel(const tinygltf::Animation& animation, const tinygltf::AnimationChannel& channel,
                    const std::string& place) {
    const auto property =
        std::find_if(std::begin(kProperties), std::end(kProperties),
                     [&](const Property& known) { return channel.target_path == known.name; });
    if (property == std::end(kProperties) || channel.target_node < 0) {
      document_.Warn(place, "an animation moves what is not known here",
                     Printable(channel.target_path, 40));
      return true;
    }
    if (!IsIndexOf(channel.target_node, document_.nodes())) {
      return document_.Fail(
          place, fmt::format("node {} of {}", channel.target_node, document_.nodes().size()));
    }
    tinygltf::Node& node = document_.nodes()[static_cast<std::size_t>(channel.target_node)];
    if (!node.matrix.empty()) {
      document_.Warn(place, "an animated node has a matrix, and stands still",
                     fmt::format("node {}", channel.target_node));
      return true;
    }
    if (!moved_.emplace(channel.target_node, property->name).second) {
      document_.Warn(place, "an animation moves what another one moves, which counts",
                     fmt::format("node {}", channel.target_node));
      return true;
    }
    const auto track = ReadTrack(animation, channel.sampler, *property, place);
    if (!track) return false;
    Values value = track->AtTime(time_);
    const bool is_usable = std::all_of(value.begin(), value.end(), [](double number) {
      return std::abs(number) <= kMaxCoordinate;  // false for NaN
    });
    if (!is_usable) return document_.Fail(place, "a number is not finite, or beyond 1e30");
    node.*(property->values) = std::move(value);
    return true;
  }

  std::optional<Track> ReadTrack(const tinygltf::Animation& animation, int sampler,
                                 const Property& property, const std::string& place) {
    const auto failed = [&](std::string_view what) {
      document_.Fail(place, what);
      return std::nullopt;
    };
    if (!IsIndexOf(sampler, animation.samplers)) {
      return failed(fmt::format("sampler {} of {}", sampler, animation.samplers.size()));
    }
    const auto& from = animation.samplers[static_cast<std::size_t>(sampler)];
    auto times = ReadAccessor(document_, from.input, 1, 1);
    const int components = static_cast<int>(std::max<std::size_t>(property.components, 1));
    auto outputs =
        times ? ReadAccessor(document_, from.output, components, components) : std::nullopt;
    if (!outputs) return std::nullopt;
    Track track;
    track.is_step = from.interpolation == "STEP";
    track.is_cubic = from.interpolation == "CUBICSPLINE";
    track.is_rotation = property.values == &tinygltf::Node::rotation;
    track.times = std::move(times->values);
    track.outputs = std::move(outputs->values);
    const std::size_t keys = track.times.size() * (track.is_cubic ? 3 : 1);
    if (keys == 0 || track.outputs.empty()) return failed("a sampler without keys");
    track.width = property.components > 0 ? property.components : track.outputs.size() / keys;
    if (track.width == 0 || track.outputs.size() != keys * track.width) {
      return failed(fmt::format("a sampler of {} keys has {} numbers of {}", track.times.size(),
                                track.outputs.size(), property.name));
    }
    // NaN is in no order.
    for (std::size_t i = 0; i + 1 < track.times.size(); ++i) {
      if (!(track.times[i] < track.times[i + 1])) return failed("its times do not ascend");
    }
    return track;
  }

  GltfDocument& document_;
  const double time_;
  std::set<std::pair<int, std::string>> moved_;
};

// By the largest times of its samplers, which the specification asks for, so that nothing is read
// of a model at rest.
double DurationOf(GltfDocument& document, const tinygltf::Animation& animation) {
  double seconds = 0;
  for (const tinygltf::AnimationSampler& sampler : animation.samplers) {
    const auto& accessors = document.model().accessors;
    if (!IsIndexOf(sampler.input, accessors)) continue;
    const auto& largest = accessors[static_cast<std::size_t>(sampler.input)].maxValues;
    if (!largest.empty() && std::isfinite(largest[0])) seconds = std::max(seconds, largest[0]);
  }
  return seconds;
}

}  // namespace

bool ApplyAnimations(GltfDocument& document, const GltfMoment& moment) {
  const auto& animations = document.model().animations;
  std::optional<Animator> animator;
  if (moment.time) animator.emplace(document, *moment.time);
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const tinygltf::Animation& animation = animations[i];
    document.AddAnimation(animation.name, DurationOf(document, animation));
    if (!moment.animation.empty() && animation.name != moment.animation) continue;
    if (animator && !animator->Apply(animation, fmt::format("/animations/{}", i))) return false;
  }
  return true;
}

}  // namespace sheaf
