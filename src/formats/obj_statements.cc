#include "src/formats/obj_statements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <map>
#include <utility>

#include "src/formats/printable.h"
#include "src/formats/scene_mesh.h"
#include "src/formats/text_scanner.h"

namespace sheaf {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class StatementReader {
 public:
  StatementReader(std::string_view text, const std::string& name, SceneFiles& files, Losses& losses,
                  MtlLibraries& libraries)
      : scanner_(text), name_(name), files_(files), losses_(losses), libraries_(libraries) {
    out_.groups.emplace_back();
    UseMaterial("");
  }

  ObjStatements Read() {
    while (scanner_.NextLine()) ReadStatement(scanner_.Word());
    out_.faces.push_back({out_.corners.size(), scanner_.line()});
    if (smoothing_line_ > 0 && out_.normals.empty()) {
      files_.Warn(PlaceOf(name_, smoothing_line_), "smoothing groups are not read: faces are flat");
    }
    return std::move(out_);
  }

 private:
  void ReadStatement(std::string_view word) {
    if (word == "v") {
      AddVertex();
    } else if (word == "vn") {
      ReadNumbers(3, "normal left out");
      out_.normals.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
    } else if (word == "vt") {
      const int count = ReadNumbers(1, "texture coordinate left out");
      out_.uv.emplace_back(numbers_[0], count == 1 ? 0.0f : numbers_[1]);
    } else if (word == "f" || word == "fo") {
      AddFace();
    } else if (word == "usemtl") {
      UseMaterial(scanner_.Remainder());
    } else if (word == "g" || word == "o") {
      BeginGroup(scanner_.Remainder());
    } else if (word == "mtllib") {
      libraries_.Read(scanner_.Remainder(), scanner_.line());
    } else if (word == "s") {
      const std::string_view group = scanner_.Word();
      if (smoothing_line_ == 0 && group != "off" && group != "0") smoothing_line_ = scanner_.line();
    } else if (word == "p" || word == "l") {
      files_.Warn(Place(), "points and lines are passed over");
    } else if (word == "curv" || word == "curv2" || word == "surf") {
      files_.Warn(Place(), "curves and surfaces are passed over");
    }
  }

  std::string Place() const { return PlaceOf(name_, scanner_.line()); }

  // The next word of a statement; empty at its end, and where a comment begins.
  std::string_view Argument() {
    const std::string_view word = scanner_.Word();
    return word.starts_with('#') ? std::string_view() : word;
  }

  // Reads numbers_ and returns how many there are, at most six. None, and NaN, where fewer than
  // `at_least` are sound.
  int ReadNumbers(int at_least, std::string_view kind) {
    std::string why;
    int count = 0;
    for (std::string_view word; count < 6 && !(word = Argument()).empty(); ++count) {
      const auto number = ParseWord<double>(word);
      if (!number || !(std::abs(*number) <= kMaxCoordinate)) {
        const std::string shown = Printable(word, 40);
        why = number ? fmt::format("\"{}\" is not finite, or beyond 1e30", shown)
                     : fmt::format("expected a number, found \"{}\"", shown);
        break;
      }
      numbers_[count] = static_cast<float>(*number);
    }
    if (count >= at_least) {
      if (!why.empty()) files_.Warn(Place(), "rest of the line left out", why);
      return count;
    }
    if (why.empty()) why = fmt::format("{} numbers of {}", count, at_least);
    losses_.LeaveOut(Place(), kind, why);
    std::fill(std::begin(numbers_), std::end(numbers_), kNan);
    return 0;
  }

  void AddVertex() {
    const bool has_colour = ReadNumbers(3, "vertex left out") == 6;
    if (has_colour || !out_.colours.empty()) {
      out_.colours.resize(out_.positions.size(), glm::vec3(1));
      const glm::vec3 colour(numbers_[3], numbers_[4], numbers_[5]);
      out_.colours.push_back(has_colour ? VertexColour(colour) : glm::vec3(1));
    }
    out_.positions.emplace_back(numbers_[0], numbers_[1], numbers_[2]);
  }

  void AddFace() {
    std::vector<ObjStatements::Corner>& corners = out_.corners;
    const std::size_t first = corners.size();
    for (std::string_view word; !(word = Argument()).empty();) {
      if (!AddCorner(word)) return corners.resize(first);
    }
    if (corners.size() - first < 3) {
      losses_.LeaveOut(Place(), "face left out",
                       fmt::format("a face of {} corners", corners.size() - first));
      return corners.resize(first);
    }
    const auto group = static_cast<std::uint32_t>(out_.groups.size() - 1);
    if (out_.runs.empty() || out_.runs.back().group != group || out_.runs.back().name != used_) {
      out_.runs.push_back({out_.faces.size(), 0, group, used_});
    }
    out_.faces.push_back({first, scanner_.line()});
    out_.runs.back().end_face = out_.faces.size();
  }

  // position, position/uv, position//normal or position/uv/normal; also "1//" and "1/2/".
  bool AddCorner(std::string_view word) {
    const auto next = [&word] {
      const std::size_t end = std::min(word.find('/'), word.size());
      const std::string_view text = word.substr(0, end);
      word.remove_prefix(std::min(end + 1, word.size()));
      return text;
    };
    const std::int32_t position = IndexOf(next(), out_.positions.size(), "face", "vertex");
    if (position == kObjNone) return false;
    const std::string_view uv = next(), normal = word;
    constexpr const char* kUv = "texture coordinate";
    constexpr const char* kNormal = "normal";
    out_.corners.push_back(
        {position, uv.empty() ? kObjNone : IndexOf(uv, out_.uv.size(), kUv, kUv),
         normal.empty() ? kObjNone : IndexOf(normal, out_.normals.size(), kNormal, kNormal)});
    return true;
  }

  // The number from 0 that `word` means, where there are `count` of `what` so far; kObjNone where
  // it means none, and `lost` is left out.
  std::int32_t IndexOf(std::string_view word, std::size_t count, std::string_view lost,
                       std::string_view what) {
    const auto index = ParseWord<std::int32_t>(word);
    if (index && *index > 0) return *index - 1;
    const auto back = index ? static_cast<std::size_t>(-static_cast<std::int64_t>(*index)) : 0;
    if (back > 0 && back <= count) return static_cast<std::int32_t>(count - back);
    losses_.LeaveOut(Place(), fmt::format("{} left out", lost),
                     back > 0 ? fmt::format("{} {} of {}", what, *index, count)
                              : fmt::format("expected the number of a {}, found \"{}\"", what,
                                            Printable(word, 40)));
    return kObjNone;
  }

  void UseMaterial(std::string_view name) {
    auto known = index_.find(name);
    if (known == index_.end()) {
      known = index_.emplace(name, static_cast<std::uint32_t>(out_.names.size())).first;
      out_.names.push_back({std::string(name), scanner_.line()});
    }
    used_ = known->second;
  }

  void BeginGroup(std::string_view name) {
    const bool is_used = !out_.runs.empty() && out_.runs.back().group + 1 == out_.groups.size();
    if (is_used) out_.groups.emplace_back();
    out_.groups.back() = name;
  }

  TextScanner scanner_;
  const std::string& name_;
  SceneFiles& files_;
  Losses& losses_;
  MtlLibraries& libraries_;
  ObjStatements out_;
  float numbers_[6] = {};
  std::map<std::string, std::uint32_t, std::less<>> index_;  // of names of materials
  std::uint32_t used_ = 0;                                   // the name in use
  std::size_t smoothing_line_ = 0;                           // where smoothing begins; 0: nowhere
};

}  // namespace

ObjStatements ReadObjStatements(std::string_view text, const std::string& name, SceneFiles& files,
                                Losses& losses, MtlLibraries& libraries) {
  return StatementReader(text, name, files, losses, libraries).Read();
}

}  // namespace sheaf
