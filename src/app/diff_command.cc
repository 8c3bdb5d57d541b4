#include "src/app/diff_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "src/app/add_options.h"
#include "src/app/display_picture.h"
#include "src/app/open_scene.h"
#include "src/app/standard_output.h"
#include "src/core/atomic_file.h"
#include "src/formats/format_table.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"
#include "src/lab/flip.h"
#include "src/scene/srgb.h"

namespace sheaf {
namespace {

struct DiffRequest {
  std::string reference, picture, output;
  std::string show = "signed", transfer = "linear";
  std::optional<double> scale;
};

// What the two pictures differ by, channel by channel or as FLIP sees it, and where most.
struct Difference {
  Film values;
  double largest = 0, mean = 0;  // of the absolute value
  int x = 0, y = 0;              // of the largest
};

// FLIP works on light.
Film Decoded(Film film, Transfer transfer) {
  if (transfer == Transfer::kSrgb) {
    for (float& value : film.rgb) {
      value = static_cast<float>(SrgbDecode(static_cast<double>(value)));
    }
  }
  return film;
}

Film FlipFilm(const Film& reference, const Film& picture, Transfer transfer) {
  const std::vector<double> errors =
      FlipErrors(Decoded(reference, transfer), Decoded(picture, transfer));
  Film film(reference.width, reference.height);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::fill_n(&film.rgb[3 * i], 3, static_cast<float>(errors[i]));
  }
  return film;
}

Difference Measure(const Film& reference, const Film& picture, const DiffRequest& request,
                   Transfer transfer) {
  Difference difference{Film(reference.width, reference.height)};
  Film& values = difference.values;
  if (request.show == "flip") {
    values = FlipFilm(reference, picture, transfer);
  } else {
    for (std::size_t i = 0; i < values.rgb.size(); ++i) {
      const float change = picture.rgb[i] - reference.rgb[i];
      values.rgb[i] = request.show == "absolute" ? std::abs(change) : change;
    }
  }
  for (std::size_t i = 0; i < values.rgb.size(); ++i) {
    const double size = std::abs(static_cast<double>(values.rgb[i]));
    difference.mean += size / static_cast<double>(values.rgb.size());
    if (!(size > difference.largest)) continue;
    difference.largest = size;
    const int pixel = static_cast<int>(i / 3);
    difference.x = pixel % values.width;
    difference.y = pixel / values.width;
  }
  return difference;
}

// Times `scale`; for an eye, equal is middle grey where signs count, else black.
void Show(const DiffRequest& request, double scale, Film& values) {
  const bool is_around_grey = request.show == "signed" && !HoldsFloats(request.output);
  for (float& value : values.rgb) {
    value *= static_cast<float>(scale);
    if (is_around_grey) value = 0.5f + 0.5f * value;
  }
}

std::string DiffText(const DiffRequest& request, const Difference& difference, double scale) {
  const std::string path = PrintablePath(request.picture);
  if (!(difference.largest > 0)) return fmt::format("{}: no difference\n", path);
  const char* const what = request.show == "flip" ? "FLIP error" : "difference";
  std::string text = fmt::format("{}: largest {} {:.6g} at ({}, {}), mean {:.6g}", path, what,
                                 difference.largest, difference.x, difference.y, difference.mean);
  if (!HoldsFloats(request.output)) {
    text += request.show == "signed"
                ? fmt::format("; grey is equal, white is {:+.4g} and more, black {:+.4g}",
                              1 / scale, -1 / scale)
                : fmt::format("; black is equal, white is {:.4g} and more", 1 / scale);
  }
  return text + "\n";
}

void AddDiffOptions(CLI::App& app, DiffRequest& request) {
  AddInput(app, "REFERENCE", request.reference, Presence::kNeeded, "The picture as it should be");
  AddInput(app, "PICTURE", request.picture, Presence::kNeeded, "The picture that is looked at");
  AddOutput(app, request.output, "PATH",
            fmt::format("The picture of their difference, {} (needed)", PictureEndings()));
  AddChoice(app, "--show", request.show, {"signed", "absolute", "flip"},
            "PICTURE minus REFERENCE, its absolute value, or what an eye sees that flips between "
            "them");
  const auto parse = [](const std::string& text) {
    const auto scale = ParseNumber(text, 0, std::numeric_limits<float>::max());
    return scale && *scale > 0 ? scale : std::nullopt;
  };
  AddParsed(app, "--scale", request.scale, "X", "a number above 0",
            "Show X times the difference; so that the largest just shows if absent", parse);
  AddChoice(app, "--transfer", request.transfer, {"linear", "srgb"},
            "How 8-bit pictures encode light");
}

Status RunDiff(const DiffRequest& request) {
  if (const Status known = CheckPicturePath(request.output); !known) return known;
  const Status apart = CheckOutputs({{"-o", request.output}}, {request.reference, request.picture});
  if (!apart) return apart;
  if (const Status writable = CheckWritable(request.output); !writable) return writable;
  const Transfer transfer = request.transfer == "srgb" ? Transfer::kSrgb : Transfer::kLinear;
  Result<Film> reference = ReadDisplayValues(request.reference, transfer);
  if (!reference) return reference.error();
  Result<Film> picture = ReadDisplayValues(request.picture, transfer);
  if (!picture) return picture.error();
  const Status same =
      CheckSameSize(request.picture, picture.value(), request.reference, reference.value());
  if (!same) return same;
  if (HoldsFloats(request.reference) != HoldsFloats(request.picture)) {
    ClampToDisplay(reference.value());
    ClampToDisplay(picture.value());
  }
  Difference difference = Measure(reference.value(), picture.value(), request, transfer);
  // FLIP and files of floats have a scale of their own.
  const bool is_known = request.show == "flip" || HoldsFloats(request.output);
  const bool is_finite = std::isfinite(difference.largest) && difference.largest > 0;
  const double fitting = is_known || !is_finite ? 1 : 1 / difference.largest;
  const double scale = request.scale.value_or(fitting);
  Show(request, scale, difference.values);
  PictureSpec spec =
      WholePicture(difference.values.width, difference.values.height, Transfer::kLinear);
  spec.values = Values::kNumbers;
  const Status written = WritePicture(difference.values, spec, request.output);
  if (!written) return written;
  return WriteStandardOutput(DiffText(request, difference, scale));
}

}  // namespace

Command DiffCommand() { return MakeCommand(&AddDiffOptions, &RunDiff); }

}  // namespace sheaf
