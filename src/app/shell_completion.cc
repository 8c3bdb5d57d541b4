// Completions for bash and zsh.
#include <fmt/format.h>

#include "src/app/manual.h"

namespace sheaf {
namespace {

std::string AllNames(const CommandManual& manual) {
  std::string all;
  for (const OptionEntry& option : manual.options) {
    if (option.is_input) continue;
    for (const std::string& name : option.names) all += (all.empty() ? "" : " ") + name;
  }
  return all;
}

// A value that is joined to its name is not completed as the next word.
bool TakesNextWord(const OptionEntry& option) {
  return !option.is_input && option.kind != ValueKind::kNone && option.value.front() != '[';
}

// The branch of `case` that completes an option's value: a word of a list; a file, which is what
// bash does by itself; or nothing.
std::string BashValue(const OptionEntry& option) {
  std::string action = "return";
  if (option.kind == ValueKind::kChoice) {
    action = fmt::format("COMPREPLY=($(compgen -W '{}' -- \"$word\")); return",
                         fmt::join(option.choices, " "));
  } else if (option.kind == ValueKind::kOther) {
    action = "compopt +o default +o bashdefault; return";
  }
  return fmt::format("        {}) {} ;;\n", fmt::join(option.names, "|"), action);
}

// A word inside '...'.
std::string ZshQuoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      if (c == '[' || c == ']' || c == ':' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted;
}

std::string ZshValue(const OptionEntry& option) {
  switch (option.kind) {
    case ValueKind::kNone:
      return "";
    case ValueKind::kChoice:
      return fmt::format(":{}:({})", ZshQuoted(option.value), fmt::join(option.choices, " "));
    case ValueKind::kFile:
      return fmt::format("{}:file:_files", option.value.front() == '[' ? ":" : "");
    case ValueKind::kOther:
      return fmt::format(":{}:", ZshQuoted(option.value));
  }
  return "";
}

std::string ZshOption(const OptionEntry& option) {
  if (option.is_input) {
    return fmt::format("    '{}:{}:_files'", option.is_repeated ? "*" : "",
                       ZshQuoted(option.names.front()));
  }
  const std::string what = fmt::format("[{}]{}", ZshQuoted(option.help), ZshValue(option));
  // "--json=FILE": the value is joined to the name, and may be absent.
  const char* joined = !option.value.empty() && option.value.front() == '[' ? "=-" : "";
  if (option.names.size() == 1) {
    return fmt::format("    '{}{}{}'", option.names.front(), joined, what);
  }
  return fmt::format("    '({})'{{{}}}'{}'", fmt::join(option.names, " "),
                     fmt::join(option.names, ","), what);
}

}  // namespace

std::string BashCompletion(const std::vector<CommandManual>& manuals) {
  std::string names, cases;
  for (const CommandManual& manual : manuals) {
    names += manual.name + " ";
    cases += fmt::format("    {})\n      case $before in\n", manual.name);
    for (const OptionEntry& option : manual.options) {
      if (TakesNextWord(option)) cases += BashValue(option);
    }
    cases += fmt::format("      esac\n      options='{}'\n      ;;\n", AllNames(manual));
  }
  return fmt::format(R"(# bash completion for sheaf; made by "sheaf completion bash"
_sheaf() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options=
  COMPREPLY=()
  if [[ $COMP_CWORD -eq 1 ]]; then
    COMPREPLY=($(compgen -W '{}--help --version' -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{}  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$options" -- "$word"))
  fi
}}
complete -o bashdefault -o default -F _sheaf sheaf
)",
                     names, cases);
}

std::string ZshCompletion(const std::vector<CommandManual>& manuals) {
  std::string commands, functions;
  for (const CommandManual& manual : manuals) {
    commands += fmt::format("    '{}:{}'\n", manual.name, ZshQuoted(manual.help));
    functions += fmt::format("_sheaf_{}() {{\n  _arguments", manual.name);
    for (const OptionEntry& option : manual.options) functions += " \\\n" + ZshOption(option);
    functions += "\n}\n\n";
  }
  return fmt::format(R"(#compdef sheaf
# zsh completion for sheaf; made by "sheaf completion zsh"

{}_sheaf() {{
  local -a commands
  commands=(
{}  )
  if (( CURRENT == 2 )); then
    _describe command commands
    _arguments '(-h --help)'{{-h,--help}}'[Print help]' '--version[Print the version]'
    return
  fi
  local name=${{words[2]}}
  shift words
  (( CURRENT-- ))
  (( $+functions[_sheaf_$name] )) && _sheaf_$name
}}

_sheaf "$@"
)",
                     functions, commands);
}

}  // namespace sheaf
