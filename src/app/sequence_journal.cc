#include "src/app/sequence_journal.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "src/app/json_text.h"
#include "src/app/run_identity.h"
#include "src/core/atomic_file.h"
#include "src/formats/read_file.h"

namespace sheaf {
namespace {

using Json = nlohmann::ordered_json;

std::optional<std::uint64_t> ChecksumOf(const std::string& path) {
  const Result<std::uint64_t> checksum = FileChecksum(path);
  return checksum ? std::optional(checksum.value()) : std::nullopt;
}

}  // namespace

Result<SequenceJournal> SequenceJournal::Open(const std::string& path, std::uint64_t identity) {
  SequenceJournal journal(path, identity);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return journal;
  const Result<std::string> text = ReadWholeFile(path);
  if (!text) return text.error();
  const Json json = Json::parse(text.value(), nullptr, false);
  const auto is_number = [](const Json& value) { return value.is_number_unsigned(); };
  if (!json.is_object() || json.value("sheaf_journal", 0) != 1 || !json.contains("identity") ||
      json["identity"] != identity || !json.contains("pictures") || !json["pictures"].is_object()) {
    journal.was_other_ = true;
    return journal;
  }
  for (const auto& [file, checksum] : json["pictures"].items()) {
    if (is_number(checksum)) journal.checksums_[file] = checksum.get<std::uint64_t>();
  }
  return journal;
}

bool SequenceJournal::Has(const std::vector<std::string>& files) const {
  return std::all_of(files.begin(), files.end(), [&](const std::string& file) {
    const auto known = checksums_.find(file);
    return known != checksums_.end() && ChecksumOf(file) == known->second;
  });
}

Status SequenceJournal::Add(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    const Result<std::uint64_t> checksum = FileChecksum(file);
    if (!checksum) return checksum.error();
    checksums_[file] = checksum.value();
  }
  Json json = {{"sheaf_journal", 1}, {"identity", identity_}, {"pictures", Json::object()}};
  for (const auto& [file, checksum] : checksums_) json["pictures"][file] = checksum;
  return WriteFileWhole(path_, JsonText(json));
}

}  // namespace sheaf
