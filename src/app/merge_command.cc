#include "src/app/merge_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <utility>

#include "src/app/choose.h"
#include "src/app/open_scene.h"
#include "src/core/atomic_file.h"
#include "src/formats/picture.h"

namespace sheaf {
namespace {

struct Part {
  const std::string* path;
  ReadPictureResult picture;
};

// Gives parts that know no place the next rows: they lie one beneath the other.
Status PlaceParts(std::vector<Part>& parts) {
  const bool are_placed = std::all_of(
      parts.begin(), parts.end(), [](const Part& part) { return part.picture.window.width() > 0; });
  if (!are_placed) {
    int height = 0;
    for (Part& part : parts) {
      const Film& film = part.picture.film;
      part.picture.window = {0, height, film.width, height + film.height};
      height += film.height;
    }
    for (Part& part : parts) {
      part.picture.full_width = parts.front().picture.film.width;
      part.picture.full_height = height;
    }
  }
  const ReadPictureResult& first = parts.front().picture;
  for (const Part& part : parts) {
    const ReadPictureResult& picture = part.picture;
    if (picture.full_width != first.full_width || picture.full_height != first.full_height) {
      return Usage(fmt::format("{}: a part of {}x{} pixels, and {} is one of {}x{}", *part.path,
                               picture.full_width, picture.full_height, *parts.front().path,
                               first.full_width, first.full_height));
    }
    if (picture.bits != first.bits || picture.is_srgb != first.is_srgb ||
        picture.is_display != first.is_display) {
      return Usage(fmt::format("{}: encoded otherwise than {}", *part.path, *parts.front().path));
    }
    if (picture.film.held_layers() != first.film.held_layers()) {
      return Usage(fmt::format("{}: other layers than {} has", *part.path, *parts.front().path));
    }
    const PixelRect& window = picture.window;
    if (window.x0 < 0 || window.y0 < 0 || window.x1 > first.full_width ||
        window.y1 > first.full_height || window.width() != picture.film.width ||
        window.height() != picture.film.height) {
      return Usage(fmt::format("{}: does not lie within {}x{} pixels", *part.path, first.full_width,
                               first.full_height));
    }
  }
  if (first.full_width > kMaxImageSide || first.full_height > kMaxImageSide) {
    return Usage(fmt::format("the whole would have {}x{} pixels; sides may be 1 to {}",
                             first.full_width, first.full_height, kMaxImageSide));
  }
  return Done{};
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

}  // namespace

CLI::App* AddMergeCommand(CLI::App& app, MergeRequest& request) {
  CLI::App* merge =
      app.add_subcommand("merge", "Join what --tile I/N or --crop rendered into the whole picture");
  merge->add_option("PART", request.parts, "Pictures that hold every pixel once")
      ->required()
      ->option_text("...");
  merge->add_option("-o", request.output, "The whole, of the same format as the parts")
      ->required()
      ->option_text("PATH");
  return merge;
}

Status RunMerge(const MergeRequest& request) {
  if (const Status known = CheckPicturePath(request.output); !known) return known;
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
  const ReadPictureResult& first = parts.front().picture;
  if (first.is_display == HoldsFloats(request.output)) {
    return Usage(fmt::format("-o {}: the parts hold {}; sheaf convert changes that", request.output,
                             first.is_display ? "bytes" : "floats"));
  }
  const Layers layers = first.film.held_layers();
  Film whole(first.full_width, first.full_height, layers);
  if (const Status filled = FillWhole(parts, whole); !filled) return filled;
  PictureSpec spec =
      WholePicture(whole.width, whole.height, first.is_srgb ? Transfer::kSrgb : Transfer::kLinear);
  spec.values = first.is_display ? Values::kEncoded : Values::kLight;
  if (HoldsLayers(request.output)) spec.layers = layers;
  if (CheckPictureBits(request.output, first.bits)) spec.bits = first.bits;
  return WritePicture(whole, spec, request.output);
}

}  // namespace sheaf
