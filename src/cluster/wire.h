// Values as the bytes of a message: those of this kind of machine, which all ranks are.
#ifndef SHEAF_CLUSTER_WIRE_H_
#define SHEAF_CLUSTER_WIRE_H_

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace sheaf {

class WireWriter {
 public:
  template <typename T>
  void Add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
  }
  void AddText(std::string_view text) {
    Add(static_cast<std::uint64_t>(text.size()));
    bytes_.append(text);
  }
  template <typename Floats>
  void AddFloats(const Floats& floats) {
    AddText({reinterpret_cast<const char*>(floats.data()), floats.size() * sizeof(float)});
  }
  std::string Take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

// What it reads has been written in the same order. Bytes that are missing read as nothing.
class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : bytes_(bytes) {}

  template <typename T>
  T Get() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    if (bytes_.size() >= sizeof(T)) std::memcpy(&value, bytes_.data(), sizeof(T));
    bytes_.remove_prefix(std::min(bytes_.size(), sizeof(T)));
    return value;
  }
  std::string_view GetText() {
    const auto wanted = Get<std::uint64_t>();
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(wanted, bytes_.size()));
    const std::string_view text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return text;
  }
  template <typename Floats>
  void GetFloats(Floats* floats) {
    const std::string_view text = GetText();
    floats->resize(text.size() / sizeof(float));
    if (floats->empty()) return;  // neither has an address then
    std::memcpy(floats->data(), text.data(), floats->size() * sizeof(float));
  }

 private:
  std::string_view bytes_;
};

}  // namespace sheaf

#endif  // SHEAF_CLUSTER_WIRE_H_
