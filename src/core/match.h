// Exhaustive visits of a variant: one function for every alternative it may hold.
#ifndef SHEAF_CORE_MATCH_H_
#define SHEAF_CORE_MATCH_H_

#include <type_traits>
#include <utility>
#include <variant>

namespace sheaf {
namespace internal {

template <typename... Functions>
struct OverloadSet : Functions... {
  using Functions::operator()...;
};

struct NoAlternative {};

template <typename Set, typename Variant>
inline constexpr bool kTakesEveryAlternative = false;
template <typename Set, typename... Ts>
inline constexpr bool kTakesEveryAlternative<Set, std::variant<Ts...>> =
    (std::is_invocable_v<Set, Ts&> && ...);

}  // namespace internal

// Calls that one of `functions` which takes the alternative that `variant` holds:
//
//   Match(object.shape, [](const Sphere& sphere) { ... }, [](const Mesh& mesh) { ... });
//
// It does not compile where an alternative has no function of its own, so that the compiler lists
// the places that a new alternative concerns. A function for every type would hide them: it does
// not compile either.
template <typename Variant, typename... Functions>
requires internal::kTakesEveryAlternative<internal::OverloadSet<std::remove_cvref_t<Functions>...>,
                                          std::remove_cvref_t<Variant>>
constexpr decltype(auto) Match(Variant&& variant, Functions&&... functions) {
  using Set = internal::OverloadSet<std::remove_cvref_t<Functions>...>;
  static_assert(!std::is_invocable_v<Set, internal::NoAlternative&>,
                "one function an alternative, none for every type");
  return std::visit(Set{std::forward<Functions>(functions)...}, std::forward<Variant>(variant));
}

}  // namespace sheaf

#endif  // SHEAF_CORE_MATCH_H_
