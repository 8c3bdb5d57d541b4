// Makes the text of a model one that a TextScanner reads.
#ifndef SHEAF_FORMATS_TEXT_LINES_H_
#define SHEAF_FORMATS_TEXT_LINES_H_

#include <string>
#include <string_view>

namespace sheaf {

// UTF-16 with a byte order mark as UTF-8; empty where there is no such mark. Half of a pair becomes
// a replacement character.
std::string DecodeUtf16(std::string_view bytes);

// A line that ends in a backslash goes on in the next. The joined line is followed by as many empty
// ones, so that the others keep their numbers. Comments (#) go on nowhere: paths of Windows are in
// them.
std::string JoinLines(std::string_view text);

// Up to the first # that follows a blank, without the blanks before it. Names may have one inside.
std::string_view WithoutComment(std::string_view line);

// A path as tools of Windows write it, as one that is understood here.
std::string WithSlashes(std::string_view path);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_TEXT_LINES_H_
