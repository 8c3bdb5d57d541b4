#include "src/app/add_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <climits>

#include "src/app/allow_threads.h"
#include "src/formats/format_table.h"

namespace sheaf {

void AddText(CLI::App& app, const char* name, const char* placeholder, const std::string& expected,
             const std::string& description, std::function<bool(const std::string&)> set) {
  app.add_option(
         name,
         [name, expected, set = std::move(set)](const CLI::results_t& words) {
           if (set(words.front())) return true;
           throw CLI::ValidationError(name,
                                      fmt::format("\"{}\" is not {}", words.front(), expected));
         },
         description)
      ->option_text(placeholder);
}

void AddInput(CLI::App& app, const char* name, std::string& value, Presence presence,
              const char* description) {
  app.add_option(name, value, description)
      ->required(presence == Presence::kNeeded)
      ->option_text(" ");
}

void AddInputs(CLI::App& app, const char* name, std::vector<std::string>& values, Presence presence,
               const char* description) {
  app.add_option(name, values, description)
      ->required(presence == Presence::kNeeded)
      ->option_text("...");
}

void AddName(CLI::App& app, const char* name, std::string& value, const char* placeholder,
             const char* description) {
  app.add_option(name, value, description)->option_text(placeholder);
}

void AddWords(CLI::App& app, const char* name, std::vector<std::string>& values,
              const char* placeholder, const char* description) {
  app.add_option(name, values, description)->option_text(placeholder)->allow_extra_args(false);
}

void AddChoice(CLI::App& app, const char* name, std::string& value,
               const std::vector<std::string>& choices, const char* description) {
  app.add_option(name, value, description)
      ->option_text(fmt::format("{}", fmt::join(choices, "|")))
      ->check(CLI::IsMember(choices));
}

void AddFlag(CLI::App& app, const char* name, bool& value, const char* description) {
  app.add_flag(name, value, description);
}

void AddPath(CLI::App& app, const char* name, std::string& path, const char* placeholder,
             const std::string& description) {
  const auto complain = [](const std::string& text) {
    return std::string(text.empty() ? "the path is empty" : "");
  };
  app.add_option(name, path, description)->option_text(placeholder)->check(complain);
}

void AddOutput(CLI::App& app, std::string& path, const char* placeholder,
               const std::string& description) {
  AddPath(app, "-o,--output", path, placeholder, description);
  app.get_option("--output")->required();
}

void AddInteger(CLI::App& app, const char* name, std::optional<int>& value, int min, int max,
                const std::string& description) {
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

void AddPictureFormat(CLI::App& app, std::string& format) {
  std::vector<std::string> names;
  for (const FileFormat& known : FileFormats()) {
    if (known.content != FileContent::kPicture) continue;
    for (const std::string& ending : known.endings) names.push_back(ending.substr(1));
  }
  AddChoice(app, "--format", format, names,
            "The picture's format, where its path does not end in it");
}

void AddBits(CLI::App& app, std::optional<int>& bits) {
  AddInteger(app, "--bits", bits, 8, 32, ("Of a channel: " + BitsText()).c_str());
}

void AddTransfer(CLI::App& app, std::string& transfer) {
  AddChoice(app, "--transfer", transfer, {"keep", "linear", "srgb"},
            "How a .png encodes light; keep: as the input does, or linear");
}

void AddPrecision(CLI::App& app, std::string& name, const char* placeholder) {
  std::vector<std::string> names;
  for (const Precision precision : kPrecisions) names.push_back(PrecisionName(precision));
  AddChoice(app, "--precision", name, names, "Arithmetic");
  if (placeholder != nullptr) app.get_option("--precision")->option_text(placeholder);
}

void AddTargets(CLI::App& app, std::vector<std::string>& targets, const char* description) {
  AddParsed(app, "--targets", targets, "all|NAME[,NAME]", "a list of different targets",
            description, &ParseNames);
}

void AddThreads(CLI::App& app, std::optional<int>& threads, int min, const char* description) {
  AddParsed(app, "--threads", threads, "N",
            fmt::format("a whole number {} to {}", min, kMaxThreads), description,
            [min](const std::string& text) {
              const std::optional<int> count = ParseInteger(text, min, kMaxThreads);
              if (count) AllowThreads(*count);
              return count;
            });
}

void AddThreads(CLI::App& app, std::vector<int>& threads) {
  AddParsed(app, "--threads", threads, "N[,N]",
            fmt::format("a list of whole numbers 1 to {}", kMaxThreads),
            "Threads, each with every target; 1 if absent", [](const std::string& text) {
              std::optional<std::vector<int>> counts = ParseThreads(text);
              if (counts) AllowThreads(*std::max_element(counts->begin(), counts->end()));
              return counts;
            });
}

void AddJson(CLI::App& app, std::string& destination, const char* description) {
  // A flag that may hold a value: an option would swallow the word after it.
  app.add_flag("--json{-}", destination, description)
      ->option_text("[=FILE]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw);
}

void AddDenoiseFilter(CLI::App& app, const char* name, std::string& filter,
                      const char* description) {
  app.add_flag(fmt::format("{}{{sheaf}}", name), filter, description)
      ->option_text("[=sheaf|oidn]")
      ->multi_option_policy(CLI::MultiOptionPolicy::Throw)
      ->check(CLI::IsMember({"sheaf", "oidn"}));
}

void AddCameraChoice(CLI::App& app, CameraChoice& choice) {
  AddParsed(app, "--camera", choice.cameras, "NAME[,NAME]", "a list of different camera names",
            "The cameras; the scene's first if absent", &ParseNames);
  app.add_option("--views", choice.view, "A view: a set of cameras that the scene names")
      ->option_text("SET")
      ->excludes("--camera");
}

void AddFooter(CLI::App& app, const std::string& text) {
  app.footer(text + "\n" + app.get_footer());
}

std::string GivenText(const CLI::App& app, const std::set<std::string>& except) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || except.contains(option->get_name())) continue;
    text += option->get_name();
    for (const std::string& word : option->results()) {
      text += fmt::format(" {}:{}", word.size(), word);
    }
    text += '\n';
  }
  return text;
}

std::vector<std::string> GivenWords(const CLI::App& app, const std::set<std::string>& except) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() == 0 || except.contains(option->get_name())) continue;
    for (const std::string& value : option->results()) {
      const bool is_bare = option->get_items_expected_max() == 0 && value == "true";
      words.push_back(is_bare ? option->get_name() : option->get_name() + "=" + value);
    }
  }
  return words;
}

std::vector<std::string> GivenOptions(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->count() > 0) names.push_back(option->get_name());
  }
  return names;
}

}  // namespace sheaf
