// Reads scenes, models and pictures from files, and writes pictures.
//
// A file's format follows from the ending of its name, in any case; FileFormats lists them, and
// docs/formats.md says what each of them holds. Every function here may run on several threads at
// once, as long as no two of them write one file. Failures are returned as an Error, whose message
// names the file and, where it is malformed, the place in it. Only std::bad_alloc is thrown, where
// memory ends.
#ifndef SHEAF_SHEAF_FORMATS_H_
#define SHEAF_SHEAF_FORMATS_H_

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "sheaf/error.h"
#include "sheaf/film.h"
#include "sheaf/scene.h"
#include "sheaf/version.h"

namespace sheaf {

// ---- The formats ----

// What files of a format are.
enum class FileContent {
  kScene,    // a whole scene, cameras and lights included
  kModel,    // objects, with or without cameras, lights and materials
  kPicture,  // pixels
};

// What the library knows of a format.
struct FileFormat {
  std::string name;                  // for people, e.g. "glTF 2.0"
  std::vector<std::string> endings;  // of file names: lower case, with the dot
  FileContent content = FileContent::kModel;
  bool is_built_in = true;  // whether this build reads and writes it
  // Of pictures:
  std::vector<int> bits = {};  // a channel that a file may have, ascending
  bool holds_floats = false;   // linear light as it is; else values of 0 to 1, for a display
  bool holds_layers = false;   // the layers of a film, beside its colours
};

// All formats, in the order in which messages name them. Lives as long as the process.
SHEAF_API const std::vector<FileFormat>& FileFormats();

// The format that the ending of `path` names; null for an unknown one.
SHEAF_API const FileFormat* FormatOf(std::string_view path);

// ---- Scenes ----

// Whether a scene may name files outside the folder that it lies in.
enum class Outside { kRefused, kAllowed };

inline constexpr int kMaxConeSides = 1024;

struct ReadOptions {
  Outside outside = Outside::kRefused;
  int cone_sides = 32;  // of the triangles that stand for NFF's cones, [3, kMaxConeSides]
  // Width over height, > 0, of the pictures that a model without a camera is framed for. By default
  // that of Settings.
  std::optional<double> aspect = std::nullopt;
  // The moment of a model's animations, in seconds; before the beginning and after the end they
  // stand still. Where absent the model is at rest.
  std::optional<double> time = std::nullopt;
  // The one animation that counts, by its name; empty: all, at once.
  std::string animation = {};
  // Of a model without a camera, instead of one that frames it.
  std::optional<Camera> camera = std::nullopt;
};

// Whether lights were put into a scene that had none: key, fill and rim.
enum class KeyLight { kAbsent, kAdded };

struct ReadSceneResult {
  Scene scene;
  KeyLight key_light = KeyLight::kAbsent;  // kAdded: the scene's first three lights
  // What was left out or replaced: a line for each kind, with its first place and its number.
  std::vector<std::string> warnings;
  std::vector<std::string> files;  // that the scene was read from, itself first
  double duration = 0.0;           // seconds of its longest animation; 0: the time moves nothing
};

// Reads a scene that can be rendered. A model without a camera gets one that frames it; one without
// a light gets a key, a fill and a rim light, white ambient light and a soft gradient around it. A
// file of unknown ending is read as scene JSON if it begins like one. kInputOutput where a file
// cannot be read, kScene where one is malformed, with a message like
// `file:line: /json/path: what; did you mean "..."?`.
SHEAF_API Result<ReadSceneResult> ReadScene(const std::string& path,
                                            const ReadOptions& options = {});

// Reads scene JSON from memory. `name` stands for the file in messages, and what the scene names
// lies relative to it. kScene where the text is malformed.
SHEAF_API Result<Scene> ParseSceneJson(std::string_view text, const std::string& name);

// ---- Pictures ----

using PictureMetadata = std::vector<std::pair<std::string, std::string>>;  // key and value, UTF-8

// What a picture says of its origin: text chunks of a .png, attributes of an .exr. Readers keep
// these keys alone.
inline constexpr const char* kMetadataKeys[] = {"Scene", "Camera", "Settings"};

// What the numbers of a film are: linear light; light as a .png holds it, encoded already; or
// numbers that are no light, or nobody knows, of which a .png says no transfer.
enum class Values { kLight, kEncoded, kNumbers };

// What a picture file shall be.
struct PictureSpec {
  PixelRect window;  // the part that the file holds of a picture of full_width x full_height
  int full_width = 0, full_height = 0;  // pixels, [1, kMaxImageSide]
  // Of a picture of bytes that is made of light: exposure in stops and tone, as in Settings.
  double ev = 0;
  Tone tone = Tone::kLinear;
  Transfer transfer = Transfer::kLinear;  // of a .png, which says so
  Values values = Values::kLight;
  // The format, as an ending without its dot, e.g. "png"; empty: what the path's ending says.
  std::string format;
  int bits = 0;              // a channel, one of FileFormat::bits; 0: 8 of a .png, 32 of others
  Layers layers;             // to write, where the format holds layers; the film has them
  PictureMetadata metadata;  // written where the format holds any

  bool is_whole() const {
    return window.x0 == 0 && window.y0 == 0 && window.x1 == full_width && window.y1 == full_height;
  }
};

// The spec of a whole picture of these sides, with the rest as it is by default.
SHEAF_API PictureSpec WholePicture(int width, int height, Transfer transfer);

// Whether `path` names a format of pictures. kUsage otherwise, with a list of the endings.
SHEAF_API Status CheckPicturePath(const std::string& path);

// Whether a picture of this path can have so many bits a channel. kUsage otherwise.
SHEAF_API Status CheckPictureBits(const std::string& path, int bits);

// Writes the whole film. The file appears complete or not at all, and one that was there stays
// until then. kUsage where the path or the spec does not fit a format, kInputOutput where the file
// cannot be written.
SHEAF_API Status WritePicture(const Film& film, Transfer transfer, const std::string& path);
SHEAF_API Status WritePicture(const Film& film, const PictureSpec& spec, const std::string& path);

class PictureEncoder;

// Writes a picture whose rows come in turn, as WritePicture does. It keeps a few rows at most; all
// of them where a .pfm or .exr goes into a pipe. One thread at a time calls it.
class PictureWriter {
 public:
  SHEAF_API static Result<PictureWriter> Create(const std::string& path, const PictureSpec& spec);
  SHEAF_API static Result<PictureWriter> Create(const std::string& path, int width, int height,
                                                Transfer transfer);
  SHEAF_API PictureWriter(PictureWriter&&) noexcept;
  SHEAF_API PictureWriter& operator=(PictureWriter&&) noexcept;
  // Without a Finish() the file does not appear.
  SHEAF_API ~PictureWriter();

  // The next rows from the top, as wide as the window, with the layers of the spec. After an error
  // the only call left is the destructor.
  SHEAF_API Status WriteRows(const Film& rows);
  // Once, after all rows.
  SHEAF_API Status Finish();

 private:
  PictureWriter(std::unique_ptr<PictureEncoder> encoder, double ev, Tone tone);

  std::unique_ptr<PictureEncoder> encoder_;
  double ev_;
  Tone tone_;
};

struct ReadPictureResult {
  Film film;
  bool is_display = false;  // whether the values are encoded for a display: those of a .png
  int bits = 32;            // a channel
  bool is_srgb = false;     // whether a .png says that its encoding is sRGB
  bool is_linear = false;   // whether a .png says that its values are linear light
  // Which part of a picture it is; an empty window where the format cannot say it (.pfm).
  PixelRect window;
  int full_width = 0, full_height = 0;
  PictureMetadata metadata;
};

// Reads a .png (values of 0 to 1, as they lie in the file), a .pfm or an .exr, with the layers that
// it has. kUsage for another ending, kInputOutput for whatever is no such picture.
SHEAF_API Result<ReadPictureResult> ReadPicture(const std::string& path);

}  // namespace sheaf

#endif  // SHEAF_SHEAF_FORMATS_H_
