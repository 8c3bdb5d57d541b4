// No file is longer than 500 lines, no function longer than 80, no parameter list longer than 8.
//
// Functions are found by their braces, without parsing C++: what stands before a brace decides
// whether it opens a scope of declarations, a function, or something else.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "source_tree.h"

namespace sheaf {
namespace {

constexpr int kMostFileLines = 500;
constexpr int kMostFunctionLines = 80;
constexpr int kMostParameters = 8;

struct Exception {
  std::string_view path, function;  // no function: the file
};

const Exception kExceptions[] = {
    // Kernels of one piece: their vectors would have to be handed over one by one to be split.
    {"simd/draw_facets.cc", "DrawFacet"},
    {"simd/generate_primary.cc", "LookThroughLens"},
    {"simd/scatter_diffuse.cc", "DrawByCosine"},
    {"simd/spawn_rays.cc", "SpawnRaysLanes"},
    {"simd/sphere_surface.cc", "FetchHits"},
    {"simd/find_footprints.cc", "ExtentAlong"},
    {"simd/triangle_surface.cc", "TriangleSurfacesLanes"},
    {"simd/frustum-inl.h", "PrepareFrustum"},
};

bool IsBlank(char c) { return std::isspace(static_cast<unsigned char>(c)); }
bool IsWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// One past the end of the comment, literal or preprocessor line that begins at `at`; `at` where
// none does.
std::size_t EndOfBlanked(std::string_view text, std::size_t at) {
  const auto after = [&](std::string_view mark, std::size_t from) {
    const std::size_t found = text.find(mark, from);
    return found == std::string_view::npos ? text.size() : found + mark.size();
  };
  const std::string_view rest = text.substr(at);
  const bool in_word = at > 0 && IsWord(text[at - 1]);
  if (StartsWith(rest, "//")) return std::min(text.find('\n', at), text.size());
  if (StartsWith(rest, "/*")) return after("*/", at + 2);
  if (StartsWith(rest, "R\"") && !in_word) {
    const std::size_t open = text.find('(', at);
    return after(")" + std::string(text.substr(at + 2, open - at - 2)) + "\"", open);
  }
  // 1'000 is a number.
  if (rest[0] == '"' || (rest[0] == '\'' && !in_word)) {
    std::size_t end = at + 1;
    while (end < text.size() && text[end] != rest[0]) end += text[end] == '\\' ? 2 : 1;
    return end + 1;
  }
  const std::size_t line = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;
  if (rest[0] != '#' || !std::all_of(&text[line], &text[at], IsBlank)) return at;
  std::size_t end = at;
  do end = after("\n", end);
  while (end < text.size() && text[end - 2] == '\\');
  return end - 1;
}

std::string WithoutTextAndComments(std::string_view text) {
  std::string code(text);
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = EndOfBlanked(text, at);
    for (std::size_t i = at; i < end && i < code.size(); ++i) {
      if (code[i] != '\n') code[i] = ' ';
    }
    at = std::max(end, at + 1);
  }
  return code;
}

// How many parameters the first list of `head` has.
int CountParameters(std::string_view head) {
  int depth = 0, commas = 0;
  bool is_empty = true;
  for (const char c : head.substr(head.find('('))) {
    if (c == ')' || c == ']' || c == '}' || c == '>') --depth;
    if (depth == 0 && c == ')') break;
    if (depth == 1 && c == ',') ++commas;
    is_empty &= depth == 0 || IsBlank(c);
    if (c == '(' || c == '[' || c == '{' || c == '<') ++depth;
  }
  return is_empty ? 0 : commas + 1;
}

std::string_view NameIn(std::string_view head) {
  std::size_t end = head.find('(');
  while (end > 0 && IsBlank(head[end - 1])) --end;
  std::size_t begin = end;
  while (begin > 0 && IsWord(head[begin - 1])) --begin;
  return head.substr(begin, end - begin);
}

std::string_view WithoutTemplate(std::string_view head) {
  while (StartsWith(head, "template")) {
    int depth = 0;
    std::size_t at = head.find('<');
    do depth += head[at] == '<' ? 1 : head[at] == '>' ? -1 : 0;
    while (++at < head.size() && depth > 0);
    while (at < head.size() && IsBlank(head[at])) ++at;
    head = head.substr(at);
  }
  return head;
}

enum class Brace { kScope, kFunction, kOther };

// What the brace after `head` opens, among declarations.
Brace KindOf(std::string_view head) {
  const std::string_view bare = WithoutTemplate(head);
  for (const char* word : {"namespace", "inline namespace", "extern", "class", "struct", "enum"}) {
    if (StartsWith(bare, word) && !EndsWith(bare, ")")) return Brace::kScope;
  }
  const bool is_function = head.find('(') != std::string_view::npos && !EndsWith(head, "=");
  return is_function ? Brace::kFunction : Brace::kOther;
}

struct Function {
  std::string name;
  int line, length, parameters;
};

std::vector<Function> FunctionsOf(std::string_view text) {
  struct Open {
    Brace kind;
    int line;
    std::string head;
  };
  std::vector<Function> functions;
  std::vector<Open> open;
  std::string head;  // what was read since the last declaration
  int line = 1, head_line = 1, depth = 0;
  for (const char c : WithoutTextAndComments(text)) {
    line += c == '\n';
    depth += (c == '(' || c == '[') - (c == ')' || c == ']');
    if (c == '{') {
      while (!head.empty() && IsBlank(head.back())) head.pop_back();
      const bool declares = depth == 0 && std::all_of(open.begin(), open.end(), [](const Open& o) {
                              return o.kind == Brace::kScope;
                            });
      open.push_back({declares ? KindOf(head) : Brace::kOther, head_line, head});
      head.clear();
    } else if (c == '}' && !open.empty()) {
      const Open& last = open.back();
      if (last.kind == Brace::kFunction) {
        functions.push_back({std::string(NameIn(last.head)), last.line, line - last.line + 1,
                             CountParameters(last.head)});
      }
      open.pop_back();
      head.clear();
    } else if ((c == ';' && depth == 0) ||
               (c == ':' && (head == "public" || head == "private" || head == "protected"))) {
      head.clear();
    } else if (!head.empty() || !IsBlank(c)) {
      if (head.empty()) head_line = line;
      head += c;
    }
  }
  return functions;
}

struct Violation {
  std::string path, function, what;
};

std::vector<Violation> Violations(const Texts& texts) {
  std::vector<Violation> violations;
  for (const auto& [path, text] : texts) {
    const auto lines = std::count(text.begin(), text.end(), '\n');
    if (lines > kMostFileLines) {
      violations.push_back({path, "", std::to_string(lines) + " lines"});
    }
    // A kernel's inner tests take x, y and z as vectors of their own.
    const bool is_inner = StartsWith(path, "simd/") && EndsWith(path, "-inl.h");
    for (const Function& function : FunctionsOf(text)) {
      const std::string where = ", line " + std::to_string(function.line);
      if (function.length > kMostFunctionLines) {
        violations.push_back(
            {path, function.name, std::to_string(function.length) + " lines" + where});
      }
      if (function.parameters > kMostParameters && !is_inner) {
        violations.push_back(
            {path, function.name, std::to_string(function.parameters) + " parameters" + where});
      }
    }
  }
  return violations;
}

TEST_CASE("files, functions and parameter lists are short") {
  const Texts texts = ReadTree(SHEAF_SOURCE_DIR);
  REQUIRE(texts.size() > 50);
  std::size_t functions = 0;
  for (const auto& entry : texts) functions += FunctionsOf(entry.second).size();
  CHECK(functions > 1000);
  std::set<const Exception*> needed;
  for (const Violation& violation : Violations(texts)) {
    const auto* const allowed = std::find_if(
        std::begin(kExceptions), std::end(kExceptions), [&](const Exception& exception) {
          return exception.path == violation.path && exception.function == violation.function;
        });
    if (allowed == std::end(kExceptions)) {
      FAIL_CHECK(violation.path, " ", violation.function, ": ", violation.what);
    }
    needed.insert(allowed);
  }
  for (const Exception& exception : kExceptions) {
    CHECK_MESSAGE(needed.count(&exception) == 1, exception.path, " ", exception.function,
                  " is an exception no more");
  }
}

std::string Lines(int count) {
  std::string lines;
  for (int i = 0; i < count; ++i) lines += "  F();\n";
  return lines;
}

TEST_CASE("what is too long is found, and nothing else") {
  const auto found = [](const std::string& text, const char* path = "src/core/a.cc") {
    std::string all;
    for (const Violation& v : Violations({{path, text}})) all += v.function + ": " + v.what + "\n";
    return all;
  };
  const std::string start = "namespace a {\n\n", end = "\n}  // namespace a\n";
  CHECK(found(std::string(500, '\n')) == "");
  CHECK(found(std::string(501, '\n')) == ": 501 lines\n");
  CHECK(found(start + "void F() {\n" + Lines(78) + "}\n" + end) == "");
  CHECK(found(start + "void F() {\n" + Lines(79) + "}\n" + end) == "F: 81 lines, line 3\n");
  // Braces in text and comments are none.
  CHECK(found("void F() { // }\n  G(\"}\", '}', R\"x(})\")x\");\n" + Lines(79) + "}\n") ==
        "F: 82 lines, line 1\n");
  CHECK(found("#define X { \\\n  {\nint F(int a = 1'000) {\n" + Lines(79) + "}\n") ==
        "F: 81 lines, line 3\n");
  // A member, a constructor with initialisers, a test case, a template.
  CHECK(found("struct S : T<int> {\n public:\n  void F() const {\n" + Lines(79) + "  }\n};\n") ==
        "F: 81 lines, line 3\n");
  CHECK(found("S::S(int a)\n    : a_(a) {\n" + Lines(79) + "}\n") == "S: 82 lines, line 1\n");
  CHECK(found("TEST_CASE(\"a (b)\") {\n" + Lines(79) + "}\n") == "TEST_CASE: 81 lines, line 1\n");
  CHECK(found("template <class T, int (*f)()>\nclass C {\n" + Lines(90) + "};\n") == "");
  // Tables and classes may be long.
  CHECK(found("const int kTable[] = {\n" + Lines(90) + "};\nvoid F() {}\n") == "");
  CHECK(found("enum class E {\n" + Lines(90) + "};\n") == "");
  CHECK(found("void F(int a, B<int, int> b, int (*c)(int, int), int d, int e, int f, int g,\n"
              "       int h) {}\n") == "");
  const std::string nine =
      "void F(int a, int b, int c, int d, int e, int f, int g, int h, int i) {}";
  CHECK(found(nine) == "F: 9 parameters, line 1\n");
  CHECK(found(nine, "simd/a-inl.h") == "");
}

}  // namespace
}  // namespace sheaf
