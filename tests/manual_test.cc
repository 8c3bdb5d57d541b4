// Man pages and completions name every command and every option of the help.
#include <doctest/doctest.h>

#include <cctype>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/run_command.h"

namespace sheaf {
namespace {

// The first words of the lines that follow `title` and are indented.
std::vector<std::string> Listed(const std::string& help, const std::string& title) {
  std::vector<std::string> words;
  std::istringstream lines(help.substr(help.find(title)));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line) && line.starts_with("  ")) {
    if (line[2] != ' ') words.push_back(line.substr(2, line.find(' ', 2) - 2));
  }
  return words;
}

std::vector<std::string> CommandNames(const Workspace& work) {
  return Listed(work.Run({"--help"}).out, "Subcommands:");
}

// "-o", "--output" of "-o,--output" and so on.
std::set<std::string> OptionNames(const std::string& help) {
  std::set<std::string> names;
  for (const std::string& word : Listed(help, "Options:")) {
    std::istringstream parts(word);
    for (std::string name; std::getline(parts, name, ',');) {
      names.insert(name.substr(0, name.find('[')));
    }
  }
  return names;
}

std::string WithoutRoff(std::string page) {
  std::string plain;
  for (std::size_t i = 0; i < page.size(); ++i) {
    if (page[i] != '\\') {
      plain += page[i];
    } else if (page[i + 1] == 'f') {
      i += 2;
    } else if (page[i + 1] == '-') {
      plain += page[++i];
    }
  }
  return plain;
}

bool IsThere(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

TEST_CASE("the help of a command has its own examples alone") {
  const Workspace work;
  const std::vector<std::string> commands = CommandNames(work);
  REQUIRE(commands.size() > 8);
  const std::string all = work.Run({"--help"}).out;
  for (const std::string& command : commands) {
    const std::string help = work.Run({command, "--help"}).out;
    CHECK_MESSAGE(Contains(help, "  sheaf " + command), command);
    CHECK(Contains(all, "  sheaf " + command));
    for (const std::string& other : commands) {
      if (other != command) CHECK_MESSAGE(!Contains(help, "\n  sheaf " + other + " "), command);
    }
  }
}

TEST_CASE("man pages name every command and option") {
  const Workspace work;
  const std::string all = WithoutRoff(work.Run({"man"}).out);
  for (const std::string& command : CommandNames(work)) {
    CAPTURE(command);
    CHECK(Contains(all, ".BR sheaf-" + command + " (1)"));
    const Outcome page = work.Run({"man", command});
    REQUIRE(page.code == 0);
    const std::string text = WithoutRoff(page.out);
    CHECK(Contains(text, "sheaf-" + command + " - "));
    const std::set<std::string> options = OptionNames(work.Run({command, "--help"}).out);
    CHECK(options.count("--help") == 1);
    for (const std::string& option : options) CHECK_MESSAGE(Contains(text, option), option);
  }
  CHECK(work.Run({"man", "nothing"}).code == 2);
}

TEST_CASE("man finds nothing to complain of") {
  const Workspace work;
  if (!IsThere("groff")) {
    MESSAGE("skipped: no groff");
    return;
  }
  std::vector<std::vector<std::string>> pages = {{"man"}};
  for (const std::string& command : CommandNames(work)) pages.push_back({"man", command});
  for (const auto& arguments : pages) {
    WriteText(work / "page.1", work.Run(arguments).out);
    const std::string groff = "groff -man -Tutf8 -P-cbou -ww '" + work / "page.1" + "' > '" +
                              work / "text" + "' 2> '" + work / "complaints" + "'";
    CHECK(std::system(groff.c_str()) == 0);
    CHECK(ReadText(work / "complaints") == "");
    CHECK(Contains(ReadText(work / "text"), "EXIT STATUS"));
  }
}

// What bash offers for the last of these words.
std::set<std::string> Offered(const Workspace& work, const std::string& words) {
  const std::string script = "source '" + work / "bash" + "'; COMP_WORDS=(" + words +
                             "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _sheaf 2>/dev/null; "
                             "printf '%s\\n' \"${COMPREPLY[@]}\" > '" +
                             work / "offered" + "'";
  WriteText(work / "script", script);
  CHECK(std::system(("bash '" + work / "script" + "'").c_str()) == 0);
  std::set<std::string> offered;
  std::istringstream lines(ReadText(work / "offered"));
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) offered.insert(line);
  }
  return offered;
}

TEST_CASE("bash completes every command and option, and values from lists") {
  const Workspace work;
  if (!IsThere("bash")) {
    MESSAGE("skipped: no bash");
    return;
  }
  WriteText(work / "bash", work.Run({"completion", "bash"}).out);
  const std::vector<std::string> commands = CommandNames(work);
  std::set<std::string> expected(commands.begin(), commands.end());
  expected.insert({"--help", "--version"});
  CHECK(Offered(work, "sheaf ''") == expected);
  CHECK(Offered(work, "sheaf co") == std::set<std::string>{"compare", "completion", "convert"});
  for (const std::string& command : commands) {
    CAPTURE(command);
    CHECK(Offered(work, "sheaf " + command + " -") ==
          OptionNames(work.Run({command, "--help"}).out));
  }
  CHECK(Offered(work, "sheaf render --precision ''") ==
        std::set<std::string>{"double", "fast", "strict"});
  CHECK(Offered(work, "sheaf render --target s") == std::set<std::string>{"scalar"});
  CHECK(Offered(work, "sheaf render --spp ''").empty());
}

TEST_CASE("zsh has every command and option") {
  const Workspace work;
  const Outcome outcome = work.Run({"completion", "zsh"});
  REQUIRE(outcome.code == 0);
  for (const std::string& command : CommandNames(work)) {
    CAPTURE(command);
    const std::size_t begin = outcome.out.find("_sheaf_" + command + "() {");
    REQUIRE(begin != std::string::npos);
    const std::string body = outcome.out.substr(begin, outcome.out.find("\n}\n", begin) - begin);
    for (const std::string& option : OptionNames(work.Run({command, "--help"}).out)) {
      CHECK_MESSAGE(Contains(body, option), option);
    }
  }
  if (!IsThere("zsh")) {
    MESSAGE("skipped: no zsh");
    return;
  }
  WriteText(work / "_sheaf", outcome.out);
  CHECK(std::system(("zsh -n '" + work / "_sheaf" + "'").c_str()) == 0);
  CHECK(work.Run({"completion", "fish"}).code == 2);
}

}  // namespace
}  // namespace sheaf
