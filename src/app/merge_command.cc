#include "src/app/merge_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/app/output_path.h"
#include "src/core/atomic_file.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

struct MergeRequest {
  std::vector<std::string> parts;
  std::string output;
  std::string format;  // of --format; empty: by the path's ending
};

struct Part {
  const std::string* path;
  ReadPictureResult picture;
};

// PFM parts do not say where they belong. They are stacked in the order given.
Status StackParts(std::vector<Part>& parts) {
  const Part& first = parts.front();
  const int width = first.picture.film.width;
  int height = 0;
  for (Part& part : parts) {
    const Film& film = part.picture.film;
    if (film.width != width) {
      return Usage(fmt::format("{}: {} pixels wide, and {} is {}; such parts are stacked",
                               PrintablePath(*part.path), film.width, PrintablePath(*first.path),
                               width));
    }
    part.picture.window = {0, height, width, height + film.height};
    height += film.height;
  }
  for (Part& part : parts) {
    part.picture.full_width = width;
    part.picture.full_height = height;
  }
  return Done{};
}

Status PlaceParts(std::vector<Part>& parts) {
  const auto is_placed = [](const Part& part) { return part.picture.window.width() > 0; };
  const auto placed = std::find_if(parts.begin(), parts.end(), is_placed);
  if (placed == parts.end()) return StackParts(parts);
  const auto lost = std::find_if_not(parts.begin(), parts.end(), is_placed);
  if (lost == parts.end()) return Done{};
  return Usage(fmt::format("{}: does not say where it belongs, and {} does",
                           PrintablePath(*lost->path), PrintablePath(*placed->path)));
}

const std::string* FindText(const ReadPictureResult& picture, std::string_view key) {
  for (const auto& [name, text] : picture.metadata) {
    if (name == key) return &text;
  }
  return nullptr;
}

// kUsage where the metadata of two parts name different pictures.
Status CheckOrigin(const Part& part, const Part& first) {
  for (const std::string_view key : kMetadataKeys) {
    const std::string* const text = FindText(part.picture, key);
    const std::string* const expected = FindText(first.picture, key);
    if (text == nullptr || expected == nullptr || *text == *expected) continue;
    // Parts may come from machines that keep the scene in different folders.
    using Path = std::filesystem::path;
    if (key == "Scene" && Path(*text).filename() == Path(*expected).filename()) continue;
    return Usage(fmt::format("{}: {} \"{}\", and {} has \"{}\": parts of different pictures",
                             PrintablePath(*part.path), key, Printable(*text),
                             PrintablePath(*first.path), Printable(*expected)));
  }
  return Done{};
}

Status CheckPart(const Part& part, const Part& first) {
  const ReadPictureResult& picture = part.picture;
  const ReadPictureResult& other = first.picture;
  const std::string path = PrintablePath(*part.path), first_path = PrintablePath(*first.path);
  if (const Status same = CheckOrigin(part, first); !same) return same;
  if (picture.full_width != other.full_width || picture.full_height != other.full_height) {
    return Usage(fmt::format("{}: a part of {}x{} pixels, and {} is one of {}x{}", path,
                             picture.full_width, picture.full_height, first_path, other.full_width,
                             other.full_height));
  }
  if (picture.bits != other.bits || picture.is_srgb != other.is_srgb ||
      picture.is_display != other.is_display) {
    return Usage(fmt::format("{}: encoded otherwise than {}", path, first_path));
  }
  if (picture.film.held_layers() != other.film.held_layers()) {
    return Usage(fmt::format("{}: other layers than {} has", path, first_path));
  }
  const PixelRect& window = picture.window;
  if (window.x0 < 0 || window.y0 < 0 || window.x1 > other.full_width ||
      window.y1 > other.full_height || window.width() != picture.film.width ||
      window.height() != picture.film.height) {
    return Usage(fmt::format("{}: does not lie within {}x{} pixels", path, other.full_width,
                             other.full_height));
  }
  return Done{};
}

Status CheckParts(const std::vector<Part>& parts) {
  for (const Part& part : parts) {
    if (const Status sound = CheckPart(part, parts.front()); !sound) return sound;
  }
  const ReadPictureResult& first = parts.front().picture;
  if (first.full_width > kMaxImageSide || first.full_height > kMaxImageSide) {
    return Usage(fmt::format("the whole would have {}x{} pixels; sides may be 1 to {}",
                             first.full_width, first.full_height, kMaxImageSide));
  }
  return Done{};
}

// For each key the text of the first part that has one.
PictureMetadata MetadataOf(const std::vector<Part>& parts) {
  PictureMetadata metadata;
  for (const char* key : kMetadataKeys) {
    for (const Part& part : parts) {
      const std::string* const text = FindText(part.picture, key);
      if (text == nullptr) continue;
      metadata.emplace_back(key, *text);
      break;
    }
  }
  return metadata;
}

// Copies every part to its place; each pixel has to come from one of them.
Status FillWhole(const std::vector<Part>& parts, Film& whole) {
  std::vector<bool> is_there(whole.pixel_count(), false);
  for (const Part& part : parts) {
    const Film& film = part.picture.film;
    const PixelRect& window = part.picture.window;
    for (int y = 0; y < film.height; ++y) {
      for (int x = 0; x < film.width; ++x) {
        const std::size_t at = whole.index(window.x0 + x, window.y0 + y);
        if (is_there[at]) {
          return Usage(fmt::format("{}: pixel ({}, {}) is in another part too", *part.path,
                                   window.x0 + x, window.y0 + y));
        }
        is_there[at] = true;
      }
      std::copy_n(film.pixel(0, y), 3 * film.width, whole.pixel(window.x0, window.y0 + y));
      for (int i = 0; i < kLayerCount; ++i) {
        const Layer layer = static_cast<Layer>(i);
        if (!film.has(layer)) continue;
        std::copy_n(film.at(layer, 0, y), kLayerChannels[i] * film.width,
                    whole.at(layer, window.x0, window.y0 + y));
      }
    }
  }
  const auto missing = std::find(is_there.begin(), is_there.end(), false);
  if (missing == is_there.end()) return Done{};
  const auto at = static_cast<int>(missing - is_there.begin());
  return Usage(fmt::format("pixel ({}, {}) is in no part", at % whole.width, at / whole.width));
}

// A .png that says nothing of its transfer makes one that says nothing.
Values ValuesOf(const ReadPictureResult& picture) {
  if (!picture.is_display) return Values::kLight;
  return picture.is_srgb || picture.is_linear ? Values::kEncoded : Values::kNumbers;
}

void AddMergeOptions(CLI::App& app, MergeRequest& request) {
  AddInputs(app, "PART", request.parts, Presence::kNeeded, "Pictures that hold every pixel once");
  AddOutput(app, request.output, "PATH", "The whole, of the same format as the parts (needed)");
  AddPictureFormat(app, request.format);
}

Status RunMerge(const MergeRequest& given) {
  MergeRequest request = given;
  if (request.output == "-") request.output = kStandardOutputPath;
  const Status known = CheckPictureOutput(request.output, request.format);
  if (!known) return known;
  const std::string named = FormatPath(request.output, request.format);
  if (const Status writable = CheckWritable(request.output); !writable) return writable;
  const Status apart = CheckOutputs({{"-o", request.output}}, request.parts);
  if (!apart) return apart;
  std::vector<Part> parts;
  for (const std::string& path : request.parts) {
    Result<ReadPictureResult> picture = ReadPicture(path);
    if (!picture) return picture.error();
    parts.push_back({&path, std::move(picture).value()});
  }
  if (const Status placed = PlaceParts(parts); !placed) return placed;
  if (const Status sound = CheckParts(parts); !sound) return sound;
  const ReadPictureResult& first = parts.front().picture;
  if (first.is_display == HoldsFloats(named)) {
    return Usage(fmt::format("-o {}: the parts hold {}; sheaf convert changes that", request.output,
                             first.is_display ? "bytes" : "floats"));
  }
  const Layers layers = first.film.held_layers();
  Film whole(first.full_width, first.full_height, layers);
  if (const Status filled = FillWhole(parts, whole); !filled) return filled;
  PictureSpec spec =
      WholePicture(whole.width, whole.height, first.is_srgb ? Transfer::kSrgb : Transfer::kLinear);
  spec.values = ValuesOf(first);
  spec.metadata = MetadataOf(parts);
  spec.format = request.format;
  if (HoldsLayers(named)) spec.layers = layers;
  if (CheckPictureBits(named, first.bits)) spec.bits = first.bits;
  return WritePicture(whole, spec, request.output);
}

}  // namespace

Command MergeCommand() { return MakeCommand(&AddMergeOptions, &RunMerge); }

}  // namespace sheaf
