#include "src/app/add_options.h"

#include <climits>

namespace sheaf {

CLI::Option* AddPath(CLI::App& app, const char* name, std::string& path, const char* placeholder,
                     const char* description) {
  const auto complain = [](const std::string& text) {
    return std::string(text.empty() ? "the path is empty" : "");
  };
  return app.add_option(name, path, description)->option_text(placeholder)->check(complain);
}

void AddOutput(CLI::App& app, std::string& path, const char* placeholder, const char* description) {
  AddPath(app, "-o,--output", path, placeholder, description)->required();
}

void AddInteger(CLI::App& app, const char* name, std::optional<int>& value, int min, int max,
                const char* description) {
  const std::string expected = max == INT_MAX ? fmt::format("a whole number from {}", min)
                                              : fmt::format("a whole number {} to {}", min, max);
  AddParsed(app, name, value, "N", expected, description,
            [min, max](const std::string& text) { return ParseInteger(text, min, max); });
}

void AddShare(CLI::App& app, const char* name, std::optional<double>& value,
              const char* placeholder, const char* description) {
  AddParsed(app, name, value, placeholder, "a number 0 to 1", description,
            [](const std::string& text) { return ParseNumber(text, 0, 1); });
}

void AddSize(CLI::App& app, std::optional<PixelSize>& size) {
  AddParsed(app, "--size", size, "WxH",
            fmt::format("a size like 640x480, sides of 1 to {}", kMaxImageSide),
            "Pixels of the whole picture", &ParseSize);
}

void AddBits(CLI::App& app, std::optional<int>& bits) {
  AddInteger(app, "--bits", bits, 8, 32, "Of a channel: 8 or 16 of .png, 16 or 32 of .exr");
}

CLI::Option* AddPrecision(CLI::App& app, std::string& name) {
  std::vector<std::string> names;
  for (const Precision precision : kPrecisions) names.push_back(PrecisionName(precision));
  return app.add_option("--precision", name, "Arithmetic")
      ->option_text(fmt::format("{}", fmt::join(names, "|")))
      ->check(CLI::IsMember(names));
}

void AddTargets(CLI::App& app, std::vector<std::string>& targets, const char* description) {
  AddParsed(app, "--targets", targets, "all|NAME[,NAME]", "a list of different targets",
            description, &ParseNames);
}

void AddThreads(CLI::App& app, std::vector<int>& threads) {
  AddParsed(app, "--threads", threads, "N[,N]",
            fmt::format("a list of whole numbers 1 to {}", kMaxThreads),
            "Threads, each with every target; 1 if absent", &ParseThreads);
}

void AddJson(CLI::App& app, std::string& destination, const char* description) {
  // A flag that may hold a value: an option would swallow the word after it.
  app.add_flag("--json{-}", destination, description)
      ->option_text("[=FILE]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
}

void AddCameraChoice(CLI::App& app, CameraChoice& choice) {
  AddParsed(app, "--camera", choice.cameras, "NAME[,NAME]", "a list of different camera names",
            "The cameras; the scene's first if absent", &ParseNames);
  app.add_option("--views", choice.view, "A view: a set of cameras that the scene names")
      ->option_text("SET")
      ->excludes("--camera");
}

}  // namespace sheaf
