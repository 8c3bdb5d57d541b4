// What C++20 has and the libc++ of Debian's Emscripten does not have yet; included before every
// file.
#ifndef SHEAF_WEB_MISSING_STD_H_
#define SHEAF_WEB_MISSING_STD_H_

#include <bit>
#include <cstddef>
#include <memory>

namespace std {

#ifndef __cpp_lib_bit_cast
template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}
#endif

#ifndef __cpp_lib_smart_ptr_for_overwrite
template <typename Array>
unique_ptr<Array> make_unique_for_overwrite(size_t count) {
  return unique_ptr<Array>(new remove_extent_t<Array>[count]);
}
#endif

}  // namespace std

#endif  // SHEAF_WEB_MISSING_STD_H_
