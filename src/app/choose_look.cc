#include "src/app/choose_look.h"

#include <fmt/format.h>

#include "src/app/add_options.h"
#include "src/app/choose.h"
#include "src/app/parse_options.h"
#include "src/formats/picture.h"
#include "src/formats/printable.h"

namespace sheaf {
namespace {

// A quarter of a usual picture each way: its median hardly moves with more.
constexpr int kMeterSide = 256;  // pixels

std::optional<Exposure> ParseExposure(const std::string& text) {
  if (text == "auto") return Exposure{};
  const auto ev = ParseNumber(text, -kMaxEv, kMaxEv);
  return ev ? std::optional(Exposure{*ev}) : std::nullopt;
}

Exposure ExposureOf(const LookOptions& given, const Settings& settings) {
  return given.exposure.value_or(Exposure{settings.ev});
}

}  // namespace

void AddLookOptions(CLI::App& app, LookOptions& look) {
  AddParsed(app, "--exposure", look.exposure, "EV|auto", "a number in [-64, 64] or auto",
            "Stops that light is brightened by; auto: the median becomes grey", &ParseExposure);
  AddChoice(app, "--tone", look.tone, {"linear", "filmic"}, "Curve; filmic rolls off highlights");
}

const char* GivenLookOption(const LookOptions& look) {
  if (look.exposure) return "--exposure";
  return look.tone.empty() ? nullptr : "--tone";
}

Status CheckLook(const LookOptions& look, const std::string& named) {
  const char* option = GivenLookOption(look);
  if (option == nullptr || !HoldsFloats(named)) return Done{};
  return Usage(fmt::format("{}: for pictures of bytes, and {} holds light as it is", option,
                           PrintablePath(named)));
}

Tone ToneOf(const LookOptions& given, Tone otherwise) {
  if (given.tone.empty()) return otherwise;
  return given.tone == "filmic" ? Tone::kFilmic : Tone::kLinear;
}

bool IsMetered(const LookOptions& given, const Settings& settings) {
  return !ExposureOf(given, settings).ev;
}

Result<Look> ChooseLook(const LookOptions& given, const Renderer& renderer, const Camera& camera,
                        const RenderOptions& options) {
  Look look;
  const Settings& settings = renderer.scene().settings;
  look.tone = ToneOf(given, settings.tone);
  const Exposure exposure = ExposureOf(given, settings);
  if (exposure.ev) {
    look.ev = *exposure.ev;
    return look;
  }
  const Result<Film> small = renderer.Render(camera, SmallPicture(options, kMeterSide));
  if (!small) return small.error();
  look.ev = MeterExposure(small.value());
  return look;
}

}  // namespace sheaf
