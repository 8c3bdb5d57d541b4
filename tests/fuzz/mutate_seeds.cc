// Runs a fuzz target without a fuzzing engine, which needs clang: each seed as it is, then seeds
// with random changes. It does not see what code they reach, as libFuzzer does; but every compiler
// builds it, and it repeats itself to the bit.
//   fuzz_TARGET SECONDS SEED_FOLDER [DICTIONARY]
//   fuzz_TARGET FILE                      that input alone
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// The sanitizers' own, where they are linked.
extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace {

namespace fs = std::filesystem;
using Random = std::mt19937_64;

constexpr unsigned kSecondsAnInput = 20;
constexpr std::size_t kMostBytes = 1 << 16;

std::string input;
std::string found_path;

// Called as the process dies.
void KeepInput() {
  std::ofstream(found_path, std::ios::binary) << input;
  std::fprintf(stderr, "found: %s\n", found_path.c_str());
}

void Die(int signal) {
  KeepInput();
  _exit(128 + signal);
}

void RunInput() {
  alarm(kSecondsAnInput);
  // A block of its own, empty or not: what reads past the end is told.
  const std::unique_ptr<std::uint8_t[]> bytes(new std::uint8_t[input.size()]);
  std::copy(input.begin(), input.end(), bytes.get());
  LLVMFuzzerTestOneInput(bytes.get(), input.size());
}

std::string ReadBytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "%s: cannot be read\n", path.c_str());
    std::exit(2);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

// Sorted: the same run from the same files.
std::vector<std::string> ReadSeeds(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> seeds;
  for (const fs::path& path : paths) seeds.push_back(ReadBytes(path));
  return seeds;
}

// Of libFuzzer's form: NAME="..." with \xNN, \\ and \" in it.
std::vector<std::string> ReadWords(const fs::path& path) {
  std::vector<std::string> words;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find('"'), last = line.rfind('"');
    if (line.starts_with('#') || first == last) continue;
    std::string word;
    for (std::size_t i = first + 1; i < last; ++i) {
      if (line[i] != '\\') {
        word += line[i];
      } else if (line[i + 1] == 'x') {
        word += static_cast<char>(std::stoi(line.substr(i + 2, 2), nullptr, 16));
        i += 3;
      } else {
        word += line[++i];
      }
    }
    words.push_back(word);
  }
  return words;
}

class Mutator {
 public:
  Mutator(std::vector<std::string> seeds, std::vector<std::string> words)
      : seeds_(std::move(seeds)), words_(std::move(words)) {}

  // A seed with one change to eight.
  std::string Next() {
    std::string bytes = Any(seeds_);
    for (std::size_t changes = 1 + Below(8); changes > 0; --changes) Change(&bytes);
    bytes.resize(std::min(bytes.size(), kMostBytes));
    return bytes;
  }

 private:
  std::size_t Below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
  const std::string& Any(const std::vector<std::string>& from) { return from[Below(from.size())]; }

  void Change(std::string* bytes) {
    const std::size_t at = Below(bytes->size() + 1);
    const std::size_t length = Below(std::min<std::size_t>(bytes->size() - at, 64) + 1);
    switch (Below(words_.empty() ? 7 : 9)) {
      case 0:  // a bit
        if (at < bytes->size()) (*bytes)[at] ^= static_cast<char>(1 << Below(8));
        return;
      case 1:  // a byte, often an end of its range
        if (at < bytes->size()) (*bytes)[at] = "\x00\xff\x7f\x80\x01 -9"[Below(8)];
        return;
      case 2:  // a number of four bytes that counts or offsets do not expect
        bytes->replace(at, std::min<std::size_t>(4, bytes->size() - at), AnyCount());
        return;
      case 3:
        bytes->erase(at, length);
        return;
      case 4:
        bytes->insert(at, bytes->substr(at, length));
        return;
      case 5: {  // a piece of another seed
        const std::string& other = Any(seeds_);
        const std::size_t from = Below(other.size() + 1);
        bytes->replace(at, length, other, from, Below(64));
        return;
      }
      case 6:
        if (Below(8) == 0) bytes->resize(at);
        return;
      case 7:
        bytes->insert(at, Any(words_));
        return;
      default: {
        const std::string& word = Any(words_);
        bytes->replace(at, std::min(word.size(), bytes->size() - at), word);
      }
    }
  }

  std::string AnyCount() {
    const std::uint32_t counts[] = {0, 1, 0x7fffffff, 0x80000000, 0xffffffff, 0x10000, 0xfffffff0};
    const std::uint32_t count = counts[Below(std::size(counts))];
    std::string bytes(4, '\0');
    for (int i = 0; i < 4; ++i) bytes[i] = static_cast<char>(count >> 8 * i);
    if (Below(2) == 0) std::reverse(bytes.begin(), bytes.end());
    return bytes;
  }

  const std::vector<std::string> seeds_, words_;
  Random random_{1};
};

}  // namespace

int main(int argc, char** argv) {
  found_path = std::string(argv[0]) + "-found";
  if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(KeepInput);
  for (const int signal : {SIGABRT, SIGALRM}) std::signal(signal, Die);
  if (argc == 2) {
    input = ReadBytes(argv[1]);
    RunInput();
    return 0;
  }
  if (argc < 3) {
    std::fprintf(stderr, "%s SECONDS SEED_FOLDER [DICTIONARY]\n", argv[0]);
    return 2;
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[1]));
  const std::vector<std::string> seeds = ReadSeeds(argv[2]);
  for (const std::string& seed : seeds) {
    input = seed;
    RunInput();
  }
  Mutator mutator(seeds, argc > 3 ? ReadWords(argv[3]) : std::vector<std::string>());
  std::size_t count = seeds.size();
  for (; std::chrono::steady_clock::now() < end; ++count) {
    input = mutator.Next();
    RunInput();
  }
  std::printf("%zu inputs\n", count);
}
