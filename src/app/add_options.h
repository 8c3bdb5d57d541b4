// Options of a subcommand whose text becomes a checked value.
#ifndef SHEAF_APP_ADD_OPTIONS_H_
#define SHEAF_APP_ADD_OPTIONS_H_

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "src/app/choose.h"

// Few files include CLI11, which takes seconds to compile.
namespace CLI {
class App;
}

namespace sheaf {

// Adds an option. `set` keeps the value that its text stands for, and returns whether there is one.
// `expected` completes "--name: X is not ...".
void AddText(CLI::App& app, const char* name, const char* placeholder, const std::string& expected,
             const std::string& description, std::function<bool(const std::string&)> set);

// The same, for a function that returns the value, or nothing.
template <typename T, typename Parse>
void AddParsed(CLI::App& app, const char* name, T& value, const char* placeholder,
               const std::string& expected, const std::string& description, Parse parse) {
  AddText(app, name, placeholder, expected, description, [&value, parse](const std::string& text) {
    auto parsed = parse(text);
    if (!parsed) return false;
    value = *std::move(parsed);
    return true;
  });
}

// What stands without an option's name before it, like SCENE.
enum class Presence { kNeeded, kOptional };
void AddInput(CLI::App& app, const char* name, std::string& value, Presence presence,
              const char* description);
void AddInputs(CLI::App& app, const char* name, std::vector<std::string>& values, Presence presence,
               const char* description);

// A word that means something to whoever runs the command.
void AddName(CLI::App& app, const char* name, std::string& value, const char* placeholder,
             const char* description);

// The same, once or more.
void AddWords(CLI::App& app, const char* name, std::vector<std::string>& values,
              const char* placeholder, const char* description);

// One of `choices`.
void AddChoice(CLI::App& app, const char* name, std::string& value,
               const std::vector<std::string>& choices, const char* description);

// True where the flag stands on the command line.
void AddFlag(CLI::App& app, const char* name, bool& value, const char* description);

// A path, which may not be empty: as an unset variable of a script is.
void AddPath(CLI::App& app, const char* name, std::string& path, const char* placeholder,
             const std::string& description);

// -o and --output, which are needed.
void AddOutput(CLI::App& app, std::string& path, const char* placeholder,
               const std::string& description);

// A whole number in [min, max]; INT_MAX is no limit.
void AddInteger(CLI::App& app, const char* name, std::optional<int>& value, int min, int max,
                const std::string& description);

// A part of white or of a weight, in [0, 1].
void AddShare(CLI::App& app, const char* name, std::optional<double>& value,
              const char* placeholder, const char* description);

// --size, of the whole picture.
void AddSize(CLI::App& app, std::optional<PixelSize>& size);

// --format, an ending without its dot, which stands for the one that a pipe's name lacks.
void AddPictureFormat(CLI::App& app, std::string& format);

// --bits, of a picture's channel.
void AddBits(CLI::App& app, std::optional<int>& bits);

// --transfer, of pictures that were read; SpecAsRead takes the word.
void AddTransfer(CLI::App& app, std::string& transfer);

// --precision, a name that PrecisionOf takes; the help shows `placeholder`, or all names if null.
void AddPrecision(CLI::App& app, std::string& name, const char* placeholder = nullptr);

// --targets, a list that ExpandTargets takes.
void AddTargets(CLI::App& app, std::vector<std::string>& targets, const char* description);

// --threads, a number from `min` on or a list. Both allow what they are given (allow_threads.h).
void AddThreads(CLI::App& app, std::optional<int>& threads, int min, const char* description);
void AddThreads(CLI::App& app, std::vector<int>& threads);

// --json[=FILE]: "-" where it stands alone.
void AddJson(CLI::App& app, std::string& destination, const char* description);

// The names that ChooseDenoiseFilter takes.
void AddDenoiseFilter(CLI::App& app, const char* name, std::string& filter,
                      const char* description);

// --camera and --views.
void AddCameraChoice(CLI::App& app, CameraChoice& choice);

// What the help of the subcommand says before its examples.
void AddFooter(CLI::App& app, const std::string& text);

// The options and inputs that the parsed command line has, with their values, but for those that
// are named: a text that differs where the work does.
std::string GivenText(const CLI::App& app, const std::set<std::string>& except);

// The options of the parsed command line, but for those that are named, as words of another one:
// "--name=value".
std::vector<std::string> GivenWords(const CLI::App& app, const std::set<std::string>& except);

// The options and inputs that the parsed command line has, by the names given above.
std::vector<std::string> GivenOptions(const CLI::App& app);

}  // namespace sheaf

#endif  // SHEAF_APP_ADD_OPTIONS_H_
