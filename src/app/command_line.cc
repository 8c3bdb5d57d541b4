#include "src/app/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

#include "sheaf/version.h"
#include "src/app/commands.h"
#include "src/app/memory_limit.h"

namespace sheaf {
namespace {

// CLI11 writes "--json{-}" for a flag that takes a value: "-" is the value of the flag alone. The
// help shows the name without it.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_option_name(const CLI::Option* option, bool is_positional) const override {
    const std::string name = CLI::Formatter::make_option_name(option, is_positional);
    return name.substr(0, name.find('{'));
  }
};

std::string Footer(const std::string& examples) {
  return fmt::format("\nExamples:\n{}\n{}", examples, kExitCodes);
}

}  // namespace

CommandLine::CommandLine()
    : app(std::make_unique<CLI::App>("Sheaf, a SIMD packet ray tracer for CPUs", "sheaf")) {
  app->set_version_flag("--version", fmt::format("sheaf {}", kVersion));
  app->formatter(std::make_shared<HelpFormatter>());
  app->require_subcommand(1);
  std::string examples;
  for (const CommandEntry& entry : Commands()) {
    examples += entry.examples;
    CLI::App* const subcommand = app->add_subcommand(entry.name, entry.help);
    subcommand->footer(Footer(entry.examples));
    commands.emplace_back(subcommand, entry.make());
    commands.back().second.add_options(*subcommand);
    AddMemoryLimit(*subcommand);
  }
  app->footer(Footer(examples));
}

CommandLine::~CommandLine() = default;

}  // namespace sheaf
