// What a file's name says of its format.
#ifndef SHEAF_FORMATS_FILE_ENDING_H_
#define SHEAF_FORMATS_FILE_ENDING_H_

#include <string>

namespace sheaf {

// The last dot and what follows it, in lower case; empty without a dot. Not by std::tolower, which
// follows the locale.
inline std::string FileEnding(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string::npos) return {};
  std::string ending = path.substr(dot);
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

}  // namespace sheaf

#endif  // SHEAF_FORMATS_FILE_ENDING_H_
