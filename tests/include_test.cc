// Includes point downward: app -> {view -> lab, cluster} -> render -> {scalar, bvh, formats} ->
// stream -> scene -> core -> simd's plain headers, capi -> render, and kernels include only simd/.
// The public face, src/sheaf, lies below all and includes itself alone, as <sheaf/...>. A header
// carries the guard of its path.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "source_tree.h"

namespace sheaf {
namespace {

bool IsHighway(std::string_view include) { return StartsWith(include, "hwy/"); }

struct Include {
  std::string path;
  bool is_quoted;
};

std::vector<Include> IncludesOf(const std::string& text) {
  std::vector<Include> includes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    // Blanks may stand before and after the '#'.
    std::string_view rest = line;
    const auto skip_blanks = [&] {
      rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    };
    skip_blanks();
    if (!StartsWith(rest, "#")) continue;
    rest.remove_prefix(1);
    skip_blanks();
    if (!StartsWith(rest, "include")) continue;
    rest.remove_prefix(7);
    skip_blanks();
    if (rest.empty() || (rest[0] != '"' && rest[0] != '<')) continue;
    const char close = rest[0] == '"' ? '"' : '>';
    includes.push_back({std::string(rest.substr(1, rest.find(close, 1) - 1)), close == '"'});
  }
  return includes;
}

// "src/render", "simd", "tests" or whatever directory a path belongs to.
std::string LayerOf(const std::string& path) {
  const std::size_t first = path.find('/');
  if (first == std::string::npos) return "";
  if (path.substr(0, first) != "src") return path.substr(0, first);
  return path.substr(0, path.find('/', first + 1));
}

// The layers below each one, besides itself. Layers side by side do not see each other.
const std::map<std::string, std::set<std::string>>& Below() {
  static const std::set<std::string> kCore = {"src/core"};
  static const std::set<std::string> kScene = {"src/core", "src/scene"};
  static const std::set<std::string> kStream = {"src/core", "src/scene", "src/stream"};
  // The baseline is a target of the geometry's, too.
  static const std::set<std::string> kBvh = {"src/core", "src/scene", "src/stream", "src/scalar"};
  static const std::set<std::string> kMiddle = {"src/core", "src/scene",  "src/scalar",
                                                "src/bvh",  "src/stream", "src/formats"};
  static const std::set<std::string> kRender = [] {
    std::set<std::string> layers = kMiddle;
    layers.insert("src/render");
    return layers;
  }();
  static const std::set<std::string> kLab = [] {
    std::set<std::string> layers = kRender;
    layers.insert("src/lab");
    return layers;
  }();
  static const std::set<std::string> kView = [] {
    std::set<std::string> layers = kLab;
    layers.insert("src/view");
    layers.insert("src/cluster");
    return layers;
  }();
  static const std::map<std::string, std::set<std::string>> kBelow = {
      {"src/sheaf", {}},        {"src/core", {}},        {"src/scene", kCore},
      {"src/stream", kScene},   {"src/bvh", kBvh},       {"src/scalar", kStream},
      {"src/formats", kScene},  {"src/render", kMiddle}, {"src/lab", kRender},
      {"src/capi", kRender},    {"src/python", {}},      {"src/view", kLab},
      {"src/cluster", kRender}, {"src/app", kView},      {"src/web", kRender}};
  return kBelow;
}

bool MayIncludeSimd(const std::string& layer, const std::string& header) {
  if (EndsWith(header, "-inl.h")) return false;
  static const std::set<std::string> kPlain = {
      "simd/streams.h",    "simd/query.h",     "simd/tree.h",    "simd/shading.h",
      "simd/primitives.h", "simd/instances.h", "simd/hit_list.h"};
  if (layer == "src/sheaf") return false;
  if (kPlain.count(header) || layer == "src/render") return true;
  // The lab measures kernels one by one.
  const bool calls_kernels = layer == "src/bvh" || layer == "src/core" || layer == "src/lab";
  if (calls_kernels) return header == "simd/kernels.h";
  return layer == "src/scalar" &&
         (header == "simd/pow_terms.h" || header == "simd/sample_terms.h" ||
          header == "simd/noisy_planes.h" || header == "simd/sin_cos_terms.h" ||
          header == "simd/checker_terms.h" || header == "simd/roundoffs.h");
}

// Whether Highway is reached from `path` through headers of the tree.
bool ReachesHighway(const Texts& texts, const std::string& path, std::set<std::string>& seen) {
  const auto found = texts.find(path);
  if (found == texts.end() || !seen.insert(path).second) return false;
  for (const Include& include : IncludesOf(found->second)) {
    if (IsHighway(include.path) || ReachesHighway(texts, include.path, seen)) return true;
  }
  return false;
}

void CheckInclude(const Texts& texts, const std::string& path, const Include& include,
                  std::vector<std::string>& violations) {
  const std::string layer = LayerOf(path);
  const auto violate = [&](const std::string& why) {
    violations.push_back(path + " includes " + include.path + ": " + why);
  };
  if (IsHighway(include.path)) {
    if (layer != "simd") violate("Highway stays in simd/");
    return;
  }
  if (!include.is_quoted) {
    if (texts.count(include.path)) violate("headers of the tree are quoted");
    return;
  }
  if (StartsWith(include.path, "sheaf/")) {  // the public face, for all but the kernels
    if (!texts.count("src/" + include.path)) return violate("no such public header");
    if (layer == "simd") violate("kernels include only simd/");
    return;
  }
  if (StartsWith(include.path, "src/sheaf/")) return violate("public headers are sheaf/...");
  if (!texts.count(include.path)) return violate("no such path from the root");
  if (layer == "simd") {
    if (LayerOf(include.path) != "simd") violate("kernels include only simd/");
    return;
  }
  if (LayerOf(include.path) == "simd") {
    if (!MayIncludeSimd(layer, include.path)) violate("not a plain header for " + layer);
    std::set<std::string> seen;
    if (ReachesHighway(texts, include.path, seen)) violate("it reaches Highway");
    return;
  }
  const auto below = Below().find(layer);
  if (below == Below().end()) return violate("unknown layer " + layer);
  const std::string target = LayerOf(include.path);
  if (target != layer && !below->second.count(target)) violate("not downward");
}

std::string GuardOf(std::string path) {
  if (StartsWith(path, "src/")) path.erase(0, 4);
  std::string guard = "SHEAF_";
  for (const char c : path) {
    guard += std::isalnum(static_cast<unsigned char>(c))
                 ? static_cast<char>(std::toupper(static_cast<unsigned char>(c)))
                 : '_';
  }
  return guard + "_";
}

void CheckGuard(const std::string& path, const std::string& text,
                std::vector<std::string>& violations) {
  const std::string guard = GuardOf(path);
  // A header that is compiled anew for every target toggles its guard instead of keeping it.
  const std::string open = EndsWith(path, "-inl.h")
                               ? "#if defined(" + guard + ") == defined(HWY_TARGET_TOGGLE)\n"
                               : "#ifndef " + guard + "\n#define " + guard + "\n";
  const bool has_define = text.find("#define " + guard + "\n") != std::string::npos;
  // Only comments may come before it.
  const std::size_t first = StartsWith(text, "#") ? 0 : text.find("\n#") + 1;
  const bool is_first = first == text.find(open);
  const bool has_end = EndsWith(text, "#endif  // " + guard + "\n");
  if (text.find(open) == std::string::npos || !is_first || !has_define || !has_end) {
    violations.push_back(path + " lacks the guard " + guard);
  }
}

// Violations of src/ and simd/; headers of tests and benches are checked for their guards alone.
std::vector<std::string> Violations(const Texts& texts) {
  std::vector<std::string> violations;
  for (const auto& [path, text] : texts) {
    if (EndsWith(path, ".h")) CheckGuard(path, text, violations);
    const std::string layer = LayerOf(path);
    if (layer != "simd" && !StartsWith(layer, "src/")) continue;
    for (const Include& include : IncludesOf(text)) CheckInclude(texts, path, include, violations);
    if (layer != "src/scalar") continue;
    std::string lower = text;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower.find("hwy") != std::string::npos) violations.push_back(path + " mentions hwy");
  }
  return violations;
}

TEST_CASE("the tree keeps to the direction of includes, to its guards and to plain headers") {
  const Texts texts = ReadTree(SHEAF_SOURCE_DIR);
  REQUIRE(texts.size() > 50);
  REQUIRE(texts.count("src/scalar/trace.h"));
  REQUIRE(texts.count("simd/streams.h"));
  for (const std::string& violation : Violations(texts)) FAIL_CHECK(violation);
  // Every directory under src/ has its place.
  for (const auto& entry : texts) {  // clang 14 captures no structured binding
    const std::string& path = entry.first;
    if (StartsWith(path, "src/")) CHECK_MESSAGE(Below().count(LayerOf(path)) == 1, path);
  }
  // What src/scalar shares with the kernels is free of Highway, and the kernels are not.
  const auto reaches = [&](const char* path) {
    std::set<std::string> seen;
    return ReachesHighway(texts, path, seen);
  };
  for (const char* plain : {"simd/streams.h", "simd/query.h", "simd/primitives.h", "simd/tree.h",
                            "simd/shading.h", "simd/pow_terms.h", "simd/roundoffs.h"}) {
    REQUIRE(texts.count(plain));
    CHECK_FALSE(reaches(plain));
  }
  CHECK(reaches("simd/trace_closest.cc"));
}

TEST_CASE("includes are found however they are spelt") {
  const auto includes = IncludesOf(
      "// #include \"a.h\"\n#include \"b.h\"  // IWYU\n  #  include\t<c/d.h>\n"
      "#define X \"e.h\"\n#include HWY_TARGET_INCLUDE\n");
  REQUIRE(includes.size() == 2);
  CHECK(includes[0].path == "b.h");
  CHECK(includes[0].is_quoted);
  CHECK(includes[1].path == "c/d.h");
  CHECK_FALSE(includes[1].is_quoted);
}

std::string Header(const std::string& path, const std::string& body) {
  const std::string guard = GuardOf(path);
  return "// Text.\n#ifndef " + guard + "\n#define " + guard + "\n\n" + body + "\n#endif  // " +
         guard + "\n";
}

// A small tree without fault, to which a test adds one.
Texts SoundTree() {
  Texts texts;
  const auto add = [&](const std::string& path, const std::string& body) {
    texts[path] = EndsWith(path, ".h") ? Header(path, body) : body;
  };
  add("simd/streams.h", "#include <cstddef>\n");
  add("simd/roundoffs.h", "");
  add("simd/kernels.h", "#include \"simd/trace_closest.h\"\n");
  add("simd/trace_closest.h", "#include \"simd/streams.h\"\n");
  add("simd/dispatch.h", "#include \"hwy/highway.h\"\n");
  add("simd/trace.cc", "#include \"simd/dispatch.h\"\n#include \"simd/streams.h\"\n");
  add("src/sheaf/error.h", "");
  add("src/sheaf/film.h", "#include \"sheaf/error.h\"\n");
  add("src/core/error.h", "#include \"simd/streams.h\"\n#include \"sheaf/error.h\"\n");
  add("src/scene/scene.h", "#include \"src/core/error.h\"\n");
  add("src/stream/stream.h", "#include \"src/core/error.h\"\n");
  add("src/bvh/geometry.h", "#include \"src/stream/stream.h\"\n#include \"simd/kernels.h\"\n");
  add("src/scalar/ray.h", "#include \"simd/roundoffs.h\"\n#include \"simd/streams.h\"\n");
  add("src/formats/png.h", "#include \"src/scene/scene.h\"\n");
  add("src/render/render.h", "#include \"src/scalar/ray.h\"\n#include \"simd/kernels.h\"\n");
  add("src/app/main.cc", "#include \"src/render/render.h\"\n");
  texts["simd/box-inl.h"] =
      "#if defined(SHEAF_SIMD_BOX_INL_H_) == defined(HWY_TARGET_TOGGLE)\n#ifdef "
      "SHEAF_SIMD_BOX_INL_H_\n#undef SHEAF_SIMD_BOX_INL_H_\n#else\n#define "
      "SHEAF_SIMD_BOX_INL_H_\n#endif\n#include \"hwy/highway.h\"\n#endif  // "
      "SHEAF_SIMD_BOX_INL_H_\n";
  return texts;
}

TEST_CASE("each kind of violation is found") {
  CHECK(Violations(SoundTree()).empty());
  // One more include in one file of the sound tree: exactly that is reported.
  const std::pair<const char*, const char*> wrong[] = {
      {"src/core/error.h", "\"src/scene/scene.h\""},       // upward
      {"src/sheaf/film.h", "\"src/core/error.h\""},        // the face looks inside
      {"src/sheaf/film.h", "\"simd/streams.h\""},          // the same
      {"src/core/error.h", "\"src/sheaf/error.h\""},       // not as users spell it
      {"src/core/error.h", "\"sheaf/none.h\""},            // no such header
      {"simd/trace.cc", "\"sheaf/error.h\""},              // a kernel looks up
      {"src/scene/scene.h", "\"src/formats/png.h\""},      // upward
      {"src/scalar/ray.h", "\"src/formats/png.h\""},       // sideways
      {"src/formats/png.h", "\"src/render/render.h\""},    // upward
      {"src/bvh/geometry.h", "\"src/formats/png.h\""},     // sideways
      {"src/stream/stream.h", "\"src/bvh/geometry.h\""},   // sideways
      {"src/bvh/geometry.h", "\"simd/trace_closest.h\""},  // not the tree's
      {"src/render/render.h", "\"src/app/main.cc\""},      // upward
      {"src/formats/png.h", "\"simd/kernels.h\""},         // not plain
      {"src/core/error.h", "\"simd/roundoffs.h\""},        // not core's
      {"src/scalar/ray.h", "\"simd/kernels.h\""},          // not the specification's
      {"src/app/main.cc", "\"simd/roundoffs.h\""},         // not the command's
      {"src/render/render.h", "\"simd/dispatch.h\""},      // reaches Highway
      {"src/render/render.h", "\"simd/box-inl.h\""},       // a kernel's inside
      {"src/render/render.h", "<hwy/highway.h>"},          // Highway itself
      {"simd/trace.cc", "\"src/core/error.h\""},           // a kernel looks up
      {"src/app/main.cc", "\"render.h\""},                 // not from the root
      {"src/app/main.cc", "<src/render/render.h>"},        // not quoted
  };
  for (const auto& entry : wrong) {
    const auto path = entry.first;
    const auto include = entry.second;
    CAPTURE(path);
    CAPTURE(include);
    Texts texts = SoundTree();
    std::string& text = texts[path];
    const std::size_t first = text.find("#include");
    text.insert(first, "#include " + std::string(include) + "\n");
    const auto violations = Violations(texts);
    REQUIRE_FALSE(violations.empty());
    for (const std::string& violation : violations) CHECK(StartsWith(violation, path));
  }
}

TEST_CASE("a wrong guard and a mention of Highway in the specification are found") {
  const auto count = [](const char* path, const std::string& text) {
    Texts texts = SoundTree();
    texts[path] = text;
    return Violations(texts).size();
  };
  const std::string guard = "SHEAF_SCALAR_NEW_H_", path = "src/scalar/new.h";
  CHECK(GuardOf(path) == guard);
  CHECK(GuardOf("simd/pow-inl.h") == "SHEAF_SIMD_POW_INL_H_");
  CHECK(count("src/scalar/new.h", Header(path, "")) == 0);
  CHECK(count("src/scalar/new.h", Header("src/scalar/old.h", "")) == 1);
  CHECK(count("src/scalar/new.h", "#pragma once\n") == 1);
  CHECK(count("src/scalar/new.h", "#include <cmath>\n" + Header(path, "")) == 1);
  CHECK(count("simd/new-inl.h", Header("simd/new-inl.h", "")) == 1);  // must toggle
  CHECK(count("src/scalar/new.h", Header(path, "HWY_INLINE void F();\n")) == 1);
}

}  // namespace
}  // namespace sheaf
