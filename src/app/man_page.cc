// Man pages, in the macros of man(7).
#include <fmt/format.h>

#include "sheaf/version.h"
#include "src/app/command_line.h"
#include "src/app/manual.h"

namespace sheaf {
namespace {

// What roff would read as its own: backslashes, hyphens that are minus signs, dots and quotes at
// the beginning of a line.
std::string Escaped(const std::string& text) {
  std::string escaped;
  bool begins_line = true;
  for (const char c : text) {
    if (begins_line && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    begins_line = c == '\n';
  }
  return escaped;
}

std::string Head(const std::string& title) {
  return fmt::format(".TH {} 1 \"\" \"Sheaf {}\" \"User Commands\"\n", title, kVersion);
}

std::string Example(const std::string& lines) {
  return ".SH EXAMPLES\n.nf\n" + Escaped(lines) + ".fi\n";
}

std::string ExitStatus() { return ".SH EXIT STATUS\n" + Escaped(kExitCodes) + "\n"; }

// "\fB\-o\fR, \fB\-\-output\fR \fIPATH\fR"
std::string Heading(const OptionEntry& option) {
  std::string names;
  for (const std::string& name : option.names) {
    names += (names.empty() ? "" : ", ") + fmt::format("\\fB{}\\fR", Escaped(name));
  }
  if (option.value.empty()) return names;
  const char* gap = option.value.front() == '[' ? "" : " ";
  return fmt::format("{}{}\\fI{}\\fR", names, gap, Escaped(option.value));
}

std::string Synopsis(const CommandManual& manual) {
  std::string line = fmt::format(".SH SYNOPSIS\n\\fBsheaf {}\\fR [\\fIOPTIONS\\fR]", manual.name);
  for (const OptionEntry& option : manual.options) {
    if (option.is_input) {
      const std::string word = fmt::format("\\fI{}\\fR{}", Escaped(option.names.front()),
                                           option.is_repeated ? "..." : "");
      line += option.is_needed ? " " + word : " [" + word + "]";
    } else if (option.is_needed) {
      line += fmt::format(" \\fB{}\\fR \\fI{}\\fR", Escaped(option.names.front()),
                          Escaped(option.value));
    }
  }
  return line + "\n";
}

}  // namespace

std::string ManPage(const CommandManual& manual) {
  std::string page = Head("SHEAF\\-" + Escaped(manual.name));
  page += fmt::format(".SH NAME\nsheaf\\-{} \\- {}\n", Escaped(manual.name), Escaped(manual.help));
  page += Synopsis(manual);
  page += ".SH OPTIONS\n";
  for (const OptionEntry& option : manual.options) {
    page += fmt::format(".TP\n{}\n{}\n", Heading(option), Escaped(option.help));
  }
  if (!manual.examples.empty()) page += Example(manual.examples);
  return page + ExitStatus() + ".SH SEE ALSO\n.BR sheaf (1)\n";
}

std::string ManPage(const std::vector<CommandManual>& manuals) {
  std::string page = Head("SHEAF");
  page += ".SH NAME\nsheaf \\- SIMD packet ray tracer for CPUs\n";
  page += ".SH SYNOPSIS\n\\fBsheaf\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
  page +=
      ".SH DESCRIPTION\nRenders scenes and models into pictures, and measures how well. Each "
      "command "
      "has a page of its own.\n.SH COMMANDS\n";
  std::string examples, also;
  for (const CommandManual& manual : manuals) {
    page +=
        fmt::format(".TP\n.BR sheaf\\-{} (1)\n{}\n", Escaped(manual.name), Escaped(manual.help));
    examples += manual.examples;
    also += fmt::format("{}.BR sheaf\\-{} (1)", also.empty() ? "" : ",\n", Escaped(manual.name));
  }
  page +=
      ".SH OPTIONS\n.TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR\nPrint help, of a command or of all\n"
      ".TP\n\\fB\\-\\-version\\fR\nPrint the version\n";
  return page + Example(examples) + ExitStatus() + ".SH SEE ALSO\n" + also + "\n";
}

}  // namespace sheaf
