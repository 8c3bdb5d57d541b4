#include "src/app/manual.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <span>

#include "src/app/command_line.h"
#include "src/app/commands.h"
#include "src/app/parse_options.h"

namespace sheaf {
namespace {

std::vector<std::string> SplitAtBars(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '|') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// What is written as it stands, and no word for something else, like NAME.
bool IsLiteral(const std::string& word) {
  return !word.empty() && std::none_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isupper(c) || c == '[' || c == ',';
  });
}

void TellValue(OptionEntry* entry) {
  if (entry->value.find("FILE") != std::string::npos ||
      entry->value.find("PATH") != std::string::npos ||
      entry->value.find("FOLDER") != std::string::npos) {
    entry->kind = ValueKind::kFile;
    return;
  }
  entry->kind = ValueKind::kOther;
  if (entry->value.find('|') == std::string::npos) return;
  for (const std::string& word : SplitAtBars(entry->value)) {
    if (IsLiteral(word)) entry->choices.push_back(word);
  }
  if (!entry->choices.empty()) entry->kind = ValueKind::kChoice;
}

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  return first == std::string::npos ? ""
                                    : text.substr(first, text.find_last_not_of(' ') + 1 - first);
}

OptionEntry EntryOf(const CLI::Option& option) {
  OptionEntry entry;
  entry.help = option.get_description();
  entry.is_needed = option.get_required();
  if (option.get_positional()) {
    entry.names = {option.get_name(true)};
    entry.is_input = true;
    entry.is_repeated = option.get_items_expected_max() > 1;
    entry.kind = ValueKind::kFile;
    return entry;
  }
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) {
    entry.names.push_back("--" + name.substr(0, name.find('{')));
  }
  entry.value = Trimmed(option.get_option_text());
  if (!entry.value.empty()) TellValue(&entry);
  return entry;
}

}  // namespace

std::vector<CommandManual> Manuals() {
  const CommandLine line;
  std::vector<CommandManual> manuals;
  for (const CommandEntry& command : Commands()) {
    CommandManual manual{command.name, command.help, command.examples, {}};
    for (const CLI::Option* option : line.app->get_subcommand(command.name)->get_options()) {
      manual.options.push_back(EntryOf(*option));
    }
    std::stable_partition(manual.options.begin(), manual.options.end(),
                          [](const OptionEntry& option) { return option.is_input; });
    manuals.push_back(std::move(manual));
  }
  return manuals;
}

}  // namespace sheaf
