#include "src/formats/exr.h"
#include "src/formats/format_table.h"
#include "src/formats/gltf.h"
#include "src/formats/nff.h"
#include "src/formats/obj.h"
#include "src/formats/pfm.h"
#include "src/formats/ply.h"
#include "src/formats/png.h"
#include "src/formats/scene_json.h"

namespace sheaf {
namespace {

std::vector<FormatRow> MakeTable() {
  return {
      {.format = {.name = "scene JSON", .endings = {".json"}, .content = FileContent::kScene},
       .parse = &ParseSceneJson,
       .max_bytes = kMaxTextBytes},

      {.format = {.name = "NFF", .endings = {".nff"}, .content = FileContent::kModel},
       .parse = &ParseNffScene,
       .model_transfer = Transfer::kLinear},  // older than displays with a curve
      {.format = {.name = "OBJ", .endings = {".obj"}, .content = FileContent::kModel},
       .parse = &ParseObj},
      {.format = {.name = "PLY", .endings = {".ply"}, .content = FileContent::kModel},
       .parse = &ParsePlyScene},
      {.format = {.name = "glTF 2.0", .endings = {".gltf", ".glb"}, .content = FileContent::kModel},
       .parse = &ParseGltf},

      {.format =
           {.name = "PNG", .endings = {".png"}, .content = FileContent::kPicture, .bits = {8, 16}},
       .read_picture = &ReadPngFilm,
       .create_encoder = &CreatePngEncoder},
      {.format = {.name = "PFM",
                  .endings = {".pfm"},
                  .content = FileContent::kPicture,
                  .bits = {32},
                  .holds_floats = true},
       .read_picture = &ReadPfmPicture,
       .create_encoder = &CreatePfmEncoder},
      {.format = {.name = "OpenEXR",
                  .endings = {".exr"},
                  .content = FileContent::kPicture,
                  .is_built_in = IsExrBuiltIn(),
                  .bits = {16, 32},
                  .holds_floats = true,
                  .holds_layers = true},
       .read_picture = &ReadExr,
       .create_encoder = &CreateExrEncoder},
  };
}

}  // namespace

const std::vector<FormatRow>& FormatTable() {
  static const std::vector<FormatRow> kTable = MakeTable();
  return kTable;
}

}  // namespace sheaf
