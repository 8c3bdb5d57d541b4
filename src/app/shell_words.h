// Words as a POSIX shell takes them.
#ifndef SHEAF_APP_SHELL_WORDS_H_
#define SHEAF_APP_SHELL_WORDS_H_

#include <string>
#include <string_view>

namespace sheaf {

// `text` as one word, in quotes where it needs them.
std::string ShellWord(std::string_view text);

// The same of a part of a word: nothing for an empty one.
std::string ShellPiece(std::string_view text);

}  // namespace sheaf

#endif  // SHEAF_APP_SHELL_WORDS_H_
