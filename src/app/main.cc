// The command `sheaf`. docs/command.md is its manual.
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/render.h"
#include "src/app/command_line.h"
#include "src/app/exit_code.h"
#include "src/app/memory_limit.h"
#include "src/app/print_message.h"
#include "src/app/standard_output.h"
#include "src/core/out_of_memory.h"
#include "src/formats/printable.h"
#include "src/formats/suggest_name.h"

namespace sheaf {
namespace {

// A caller may start the command with standard output closed. The next file that is opened would
// then get its descriptor, and text for standard output would end in that file. So each closed
// descriptor opens /dev/null. Standard output opens it for reading: writing there still fails.
void FillStandardDescriptors() {
  for (int descriptor = 0; descriptor < 3; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) == -1) {
      open("/dev/null", descriptor == 2 ? O_WRONLY : O_RDONLY);
    }
  }
}

ExitCode ToExitCode(const Result<ExitCode>& result) {
  return result.ok() ? result.value() : Report(result.error());
}

ExitCode Print(const std::string& text) {
  const Status written = WriteStandardOutput(text);
  return written.ok() ? ExitCode::kOk : Report(written.error());
}

// Says which word fits nothing, and what may have been meant. CLI11 would report the argument that
// is missing because of it.
std::string DescribeExtra(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  }
  for (const CLI::App* subcommand : app.get_subcommands({}))
    known.push_back(subcommand->get_name());
  const auto option = std::find(known.begin(), known.end(), "--" + word);
  const std::string hint = option != known.end() ? fmt::format("; did you mean \"{}\"?", *option)
                                                 : DidYouMean(word, {known.begin(), known.end()});
  const bool is_option = word.starts_with("-");
  const bool needs_subcommand = app.get_require_subcommand_min() > 0;
  return fmt::format("{} \"{}\"{}",
                     is_option          ? "unknown option"
                     : needs_subcommand ? "unknown subcommand"
                                        : "unexpected argument",
                     Printable(word), hint);
}

// The first word like "--json=", which CLI11 would take for "--json". A script writes it where a
// variable is not set.
std::optional<std::string> FindEmptyValue(int argc, char** argv) {
  for (int i = 1; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--") && word.find('=') + 1 == word.size()) return word;
  }
  return std::nullopt;
}

bool IsNamed(const CLI::Option& option, std::string_view word) {
  const auto has = [&](const std::vector<std::string>& names, std::string_view dashes) {
    return word.starts_with(dashes) &&
           std::find(names.begin(), names.end(), word.substr(dashes.size())) != names.end();
  };
  return has(option.get_lnames(), "--") || has(option.get_snames(), "-");
}

// The option whose value is missing: it is the last word, or the next one is another option, which
// CLI11 would take for the value.
std::optional<std::string> FindMissingValue(const CLI::App& app, int argc, char** argv) {
  const auto find = [&](std::string_view word) {
    const auto options = app.get_options();
    const auto found = std::find_if(options.begin(), options.end(),
                                    [&](const CLI::Option* o) { return IsNamed(*o, word); });
    return found == options.end() ? nullptr : *found;
  };
  for (int i = 2; i < argc && std::string_view(argv[i]) != "--"; ++i) {
    const CLI::Option* option = find(argv[i]);
    if (option == nullptr || option->get_items_expected_min() == 0) continue;
    ++i;  // its value
    if (i == argc) return fmt::format("{}: no value follows", argv[i - 1]);
    if (find(argv[i]) == nullptr) continue;
    return fmt::format("{}: no value follows, but the option {}", argv[i - 1], argv[i]);
  }
  return std::nullopt;
}

// Answers what CLI11 threw. Help and version come as exceptions too.
ExitCode ReportParse(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::CallForHelp*>(&error) != nullptr) {
    return Print(app.help());
  }
  if (dynamic_cast<const CLI::CallForVersion*>(&error) != nullptr) {
    return Print(fmt::format("{}\n", error.what()));
  }
  const std::vector<CLI::App*> parsed = app.get_subcommands();
  const CLI::App& innermost = parsed.empty() ? app : *parsed.front();
  std::vector<std::string> extra = innermost.remaining();
  // "--" itself is never the wrong word; one after it may be.
  extra.erase(std::remove(extra.begin(), extra.end(), "--"), extra.end());
  const bool about_extra = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr ||
                           dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  const std::string what =
      about_extra && !extra.empty() ? DescribeExtra(innermost, extra.front()) : error.what();
  return Report(
      {ErrorKind::kUsage, fmt::format("{} (see {}{} --help)", what, parsed.empty() ? "" : "sheaf ",
                                      innermost.get_name())});
}

ExitCode Main(int argc, char** argv) {
  FillStandardDescriptors();
  // These signals would kill the command: the reader of its output went away, or a file reached the
  // limit of its size. Ignored, they become failed writes, which are reported.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);

  CommandLine line;
  CLI::App& app = *line.app;
  if (argc < 2) {
    std::fputs(app.help().c_str(), stderr);
    return ExitCode::kUsage;
  }
  if (const auto word = FindEmptyValue(argc, argv)) {
    return Report({ErrorKind::kUsage, fmt::format("{}: nothing follows the =", Printable(*word))});
  }
  for (const auto& [subcommand, command] : line.commands) {
    if (subcommand->get_name() != argv[1]) continue;
    if (const auto missing = FindMissingValue(*subcommand, argc, argv)) {
      return Report({ErrorKind::kUsage,
                     fmt::format("{} (see sheaf {} --help)", *missing, subcommand->get_name())});
    }
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return ReportParse(app, error);
  }
  for (const auto& [subcommand, command] : line.commands) {
    if (!subcommand->parsed()) continue;
    // The window goes on without a picture that is too large.
    if (subcommand->get_name() != "view") EndWhereMemoryEnds();
    return ToExitCode(command.run());
  }
  return ExitCode::kInternal;
}

[[noreturn]] void ExitOutOfMemory() { _exit(static_cast<int>(ReportMemoryEnd())); }

// Where an exception meets a destructor or a library's function that may throw none, or nobody has
// entered main yet.
[[noreturn]] void OnTerminate() {
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      ExitOutOfMemory();
    } catch (const std::exception& error) {
      if (SpeaksOfMemory(error.what())) ExitOutOfMemory();
    } catch (...) {
    }
    std::abort();
  }
  // Without memory for an exception there is none.
  void* const probe = std::malloc(std::size_t{1} << 16);
  if (probe == nullptr) ExitOutOfMemory();
  std::free(probe);
  std::abort();
}

void HandleTermination() { std::set_terminate(&OnTerminate); }

#ifdef __GLIBC__
// Shared libraries allocate before main begins, and before anything else of the command runs.
[[gnu::section(".preinit_array"),
  gnu::used]] void (*const handle_termination)() = &HandleTermination;
#endif

// Sheaf itself throws nothing. The standard library throws where memory or threads run out.
int GuardedMain(int argc, char** argv) {
  HandleTermination();
  try {
    return static_cast<int>(Main(argc, argv));
  } catch (const std::bad_alloc&) {
    return static_cast<int>(ReportMemoryEnd());
  } catch (const std::exception& error) {
    if (SpeaksOfMemory(error.what())) return static_cast<int>(ReportMemoryEnd());
    PrintMessage(fmt::format("sheaf: internal error: {}", error.what()));
  }
  return static_cast<int>(ExitCode::kInternal);
}

}  // namespace
}  // namespace sheaf

int main(int argc, char** argv) { return sheaf::GuardedMain(argc, argv); }
