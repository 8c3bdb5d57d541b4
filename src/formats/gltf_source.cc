#include "src/formats/gltf_source.h"

#include <fmt/format.h>

#include <cstdint>

#include "src/formats/printable.h"

namespace sheaf {
namespace {

constexpr std::size_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinaryChunk = 0x004e4942;  // "JSON", "BIN\0"

std::uint32_t LittleEndian(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

int HexDigit(char c) {
  return c >= '0' && c <= '9'   ? c - '0'
         : c >= 'a' && c <= 'f' ? c - 'a' + 10
         : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                : -1;
}

// Both alphabets of RFC 4648.
int Base64Digit(char c) {
  return c >= 'A' && c <= 'Z'   ? c - 'A'
         : c >= 'a' && c <= 'z' ? c - 'a' + 26
         : c >= '0' && c <= '9' ? c - '0' + 52
         : c == '+' || c == '-' ? 62
         : c == '/' || c == '_' ? 63
                                : -1;
}

std::optional<std::string> DecodeBase64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const int digit = Base64Digit(c);
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += static_cast<char>(bits >> count & 255);
    }
  }
  return bytes;
}

}  // namespace

Result<GltfSource> SplitGltf(std::string_view bytes) {
  const auto failed = [](std::string what) { return Error{ErrorKind::kScene, std::move(what)}; };
  if (!bytes.starts_with("glTF")) return GltfSource{bytes, {}};
  if (bytes.size() < kHeaderBytes) return failed("the header of the .glb is cut off");
  if (LittleEndian(bytes, 4) == 1) return failed(std::string(kGltf1));
  GltfSource source;
  std::size_t at = kHeaderBytes;
  // Bytes too few for a chunk are padding, or of a writer that cannot count.
  for (int i = 0; i < 2 && bytes.size() - at >= kChunkHeaderBytes; ++i) {
    const std::size_t size = LittleEndian(bytes, at);
    const std::uint32_t type = LittleEndian(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (size > bytes.size() - at) {
      return failed(fmt::format("a chunk of {} bytes where {} are left", size, bytes.size() - at));
    }
    if (type != (i == 0 ? kJsonChunk : kBinaryChunk)) break;
    (i == 0 ? source.json : source.binary.emplace()) = bytes.substr(at, size);
    at += size;
  }
  if (source.json.empty()) return failed("the .glb has no JSON");
  return source;
}

bool IsDataUri(std::string_view uri) { return uri.starts_with("data:"); }

std::optional<std::string> DecodeDataUri(std::string_view uri) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const std::string_view data = uri.substr(comma + 1);
  return uri.substr(0, comma).ends_with(";base64") ? DecodeBase64(data) : DecodeUriPath(data);
}

std::string DecodeUriPath(std::string_view uri) {
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? HexDigit(uri[i + 1]) : -1;
    const int low = high >= 0 ? HexDigit(uri[i + 2]) : -1;
    if (low < 0) {
      path += uri[i];
    } else {
      path += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return path;
}

std::string ShowUri(std::string_view uri) {
  return IsDataUri(uri) ? fmt::format("a data URI of {} characters", uri.size()) : Printable(uri);
}

}  // namespace sheaf
