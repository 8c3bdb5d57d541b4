// A checksum that tells torn or foreign bytes apart. Not for secrets.
#ifndef SHEAF_CORE_CHECKSUM_H_
#define SHEAF_CORE_CHECKSUM_H_

#include <cstddef>
#include <cstdint>

namespace sheaf {

// FNV-1a of 64 bits, over what is added in turn.
class Checksum {
 public:
  void Add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace sheaf

#endif  // SHEAF_CORE_CHECKSUM_H_
