// The project's own sources, for tests of how they are written.
#ifndef SHEAF_TESTS_SOURCE_TREE_H_
#define SHEAF_TESTS_SOURCE_TREE_H_

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>

namespace sheaf {

using Texts = std::map<std::string, std::string>;  // text by path from the root, '/' between

inline bool StartsWith(std::string_view text, std::string_view prefix) {
  return text.substr(0, prefix.size()) == prefix;
}
inline bool EndsWith(std::string_view text, std::string_view suffix) {
  return text.size() >= suffix.size() && text.substr(text.size() - suffix.size()) == suffix;
}

inline Texts ReadTree(const std::filesystem::path& root) {
  namespace fs = std::filesystem;
  Texts texts;
  for (const char* directory : {"src", "simd", "tests", "bench"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / directory)) {
      std::string path = fs::relative(entry.path(), root).generic_string();
      if (!entry.is_regular_file() || !(EndsWith(path, ".h") || EndsWith(path, ".cc"))) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      texts[path] = std::string(std::istreambuf_iterator<char>(file), {});
    }
  }
  return texts;
}

}  // namespace sheaf

#endif  // SHEAF_TESTS_SOURCE_TREE_H_
