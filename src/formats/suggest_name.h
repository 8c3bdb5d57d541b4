// Finds the name that a misspelt one was meant to be.
#ifndef SHEAF_FORMATS_SUGGEST_NAME_H_
#define SHEAF_FORMATS_SUGGEST_NAME_H_

#include <string>
#include <string_view>
#include <vector>

namespace sheaf {

// The known name nearest to `wrong`, or an empty view where none is near enough. Case is ignored,
// and a part of a known name counts as the name: "color" finds "base_colour".
std::string_view NearestName(std::string_view wrong, const std::vector<std::string_view>& known);

// `; did you mean "name"?` for messages, or an empty string.
std::string DidYouMean(std::string_view wrong, const std::vector<std::string_view>& known);

}  // namespace sheaf

#endif  // SHEAF_FORMATS_SUGGEST_NAME_H_
