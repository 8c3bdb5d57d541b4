// A JSON text as a flat array of nodes that remember their lines, so that an error can name its
// place. nlohmann::json does the parsing but keeps no positions.
#ifndef SHEAF_FORMATS_JSON_TREE_H_
#define SHEAF_FORMATS_JSON_TREE_H_

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sheaf/error.h"

namespace sheaf {

enum class JsonKind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };

// "a number", "an array", ... for messages.
std::string_view DescribeKind(JsonKind kind);

inline constexpr std::uint32_t kNoKey = 0xffffffffu;
inline constexpr int kMaxJsonDepth = 64;  // of nested arrays and objects

struct JsonNode {
  union {
    double number;         // kNumber; kBoolean: 0 or 1
    std::uint32_t string;  // kString: index into JsonTree::strings
    std::uint32_t count;   // kArray, kObject: children
  };
  std::uint32_t line;  // from 1; of the key for members, of the first token otherwise
  std::uint32_t end;   // index one past the node's descendants
  std::uint32_t key;   // index into JsonTree::strings, kNoKey unless a member of an object
  JsonKind kind;
};

// Nodes in the order of the file: the first child of node i is i + 1, the next sibling of a child c
// is nodes[c].end. The root is node 0.
struct JsonTree {
  std::vector<JsonNode> nodes;
  std::vector<std::string> strings;  // keys and values, each distinct string once

  // The JSON pointer of a node, ready to show; "/" for the root. Walks from the root.
  std::string PathOf(std::uint32_t node) const;
};

// Appends one step to a JSON pointer, escaped for the pointer and for display.
void AppendPathStep(std::string_view key, std::string* path);

// Parses UTF-8 JSON with // and /* */ comments, with or without a byte order mark. Refuses
// duplicate keys, numbers that overflow a double, NUL bytes and nesting past kMaxJsonDepth. Errors
// are kScene, `name:line: /path: what`.
Result<JsonTree> ParseJsonTree(std::string_view text, const std::string& name);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_JSON_TREE_H_
