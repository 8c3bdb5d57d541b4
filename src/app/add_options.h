// Options of a subcommand whose text becomes a checked value.
#ifndef SHEAF_APP_ADD_OPTIONS_H_
#define SHEAF_APP_ADD_OPTIONS_H_

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/app/choose.h"

namespace sheaf {

// Adds an option whose text `parse` understands; `expected` completes "--name: X is not ...".
template <typename T, typename Parse>
void AddParsed(CLI::App& app, const char* name, T& value, const char* placeholder,
               const std::string& expected, const char* description, Parse parse) {
  app.add_option(
         name,
         [name, &value, expected, parse](const CLI::results_t& words) {
           auto parsed = parse(words.front());
           if (!parsed) {
             throw CLI::ValidationError(name,
                                        fmt::format("\"{}\" is not {}", words.front(), expected));
           }
           value = *std::move(parsed);
           return true;
         },
         description)
      ->option_text(placeholder);
}

// A path, which may not be empty: as an unset variable of a script is.
CLI::Option* AddPath(CLI::App& app, const char* name, std::string& path, const char* placeholder,
                     const char* description);

// -o and --output, which are needed.
void AddOutput(CLI::App& app, std::string& path, const char* placeholder, const char* description);

// A whole number in [min, max]; INT_MAX is no limit.
void AddInteger(CLI::App& app, const char* name, std::optional<int>& value, int min, int max,
                const char* description);

// A part of white or of a weight, in [0, 1].
void AddShare(CLI::App& app, const char* name, std::optional<double>& value,
              const char* placeholder, const char* description);

// --size, of the whole picture.
void AddSize(CLI::App& app, std::optional<PixelSize>& size);

// --bits, of a picture's channel.
void AddBits(CLI::App& app, std::optional<int>& bits);

// --precision, a name that PrecisionOf takes.
CLI::Option* AddPrecision(CLI::App& app, std::string& name);

// --targets, a list that ExpandTargets takes.
void AddTargets(CLI::App& app, std::vector<std::string>& targets, const char* description);

// --threads, a list.
void AddThreads(CLI::App& app, std::vector<int>& threads);

// --json[=FILE]: "-" where it stands alone.
void AddJson(CLI::App& app, std::string& destination, const char* description);

// --camera and --views.
void AddCameraChoice(CLI::App& app, CameraChoice& choice);

}  // namespace sheaf

#endif  // SHEAF_APP_ADD_OPTIONS_H_
