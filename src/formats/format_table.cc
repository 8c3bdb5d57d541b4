#include "src/formats/format_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace sheaf {
namespace {

// The last dot and what follows it, in lower case; empty without a dot. Not by std::tolower, which
// follows the locale.
std::string EndingOf(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return {};
  std::string ending(path.substr(dot));
  for (char& c : ending) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return ending;
}

// "a, b or c".
std::string Alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " or " : ", ";
    text += words[i];
  }
  return text;
}

}  // namespace

const FormatRow* FindFormat(std::string_view path) {
  const std::string ending = EndingOf(path);
  for (const FormatRow& row : FormatTable()) {
    const auto& endings = row.format.endings;
    if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return &row;
  }
  return nullptr;
}

std::string EndingsText(const std::function<bool(const FileFormat&)>& belongs) {
  std::vector<std::string> endings;
  for (const FileFormat& format : FileFormats()) {
    if (!belongs(format)) continue;
    endings.insert(endings.end(), format.endings.begin(), format.endings.end());
  }
  return Alternatives(endings);
}

std::string SceneEndings() {
  return EndingsText(
      [](const FileFormat& format) { return format.content != FileContent::kPicture; });
}

std::string PictureEndings() {
  return EndingsText(
      [](const FileFormat& format) { return format.content == FileContent::kPicture; });
}

std::string BitsText() {
  std::vector<std::string> formats;
  for (const FileFormat& format : FileFormats()) {
    std::vector<std::string> bits;
    for (const int count : format.bits) bits.push_back(std::to_string(count));
    if (!bits.empty()) formats.push_back(format.endings.front() + " " + Alternatives(bits));
  }
  return fmt::format("{}", fmt::join(formats, ", "));
}

const std::vector<FileFormat>& FileFormats() {
  static const std::vector<FileFormat> kFormats = [] {
    std::vector<FileFormat> formats;
    for (const FormatRow& row : FormatTable()) formats.push_back(row.format);
    return formats;
  }();
  return kFormats;
}

const FileFormat* FormatOf(std::string_view path) {
  const FormatRow* row = FindFormat(path);
  return row == nullptr ? nullptr
                        : &FileFormats()[static_cast<std::size_t>(row - FormatTable().data())];
}

}  // namespace sheaf
